/* The same as records.st. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct {
  float low, high;
} Limits;
typedef struct {
  int16_t raw;
  float value;
  float filter[4];
  Limits warning, alarm;
  bool bad;
  uint32_t hits;
} Channel;

static Channel channels[61], worst;
static uint32_t seed = 1, checksum;

void records_scan(int64_t now_ns) {
  (void)now_ns;
  for (int i = 1; i <= 60; ++i) {
    Channel* const c = &channels[i];
    seed = seed * 1664525u + 1013904223u;
    c->raw = (int16_t)(seed / 262144u % 8192u);
    c->warning.high = 50.0f;
    c->alarm.high = 62.5f;
    for (int k = 3; k >= 1; --k) c->filter[k] = c->filter[k - 1];
    c->filter[0] = (float)c->raw * 0.0125f;
    c->value = (c->filter[0] + c->filter[1] + c->filter[2] + c->filter[3]) * 0.25f;
    c->bad = c->value > c->alarm.high || c->value < c->alarm.low;
    if (c->bad || c->value > c->warning.high) c->hits++;
    if (i == 1 || c->hits > worst.hits) worst = *c;
  }
  checksum = checksum * 31u + worst.hits + (uint32_t)rintf(worst.value);
}

uint32_t records_checksum(void) { return checksum; }
