/* The same as interfaces.st. */
#include <stdbool.h>
#include <stdint.h>

typedef struct Drive Drive;
typedef struct {
  int32_t (*step)(Drive*, int32_t demand);
  int32_t (*load)(Drive*);
} Methods;
struct Drive {
  const Methods* methods;
  int32_t a, b;
};

static int32_t belt_step(Drive* d, int32_t demand) {
  if (demand > d->b) {
    d->b += 1;
  } else {
    d->b -= 1;
  }
  d->a += d->b;
  return d->a;
}
static int32_t belt_load(Drive* d) { return d->b * 3; }
static int32_t lift_step(Drive* d, int32_t demand) {
  d->b = demand > d->a;
  if (d->b) {
    d->a += 2;
  } else {
    d->a -= 2;
  }
  return d->a;
}
static int32_t lift_load(Drive* d) { return d->a / 4 + 7; }
static int32_t pump_step(Drive* d, int32_t demand) {
  d->a += (demand - d->a) / 8;
  d->b += 1;
  return d->a;
}
static int32_t pump_load(Drive* d) { return d->b; }
static int32_t slow_load(Drive* d) { return d->b - d->a / 16; }

static const Methods belt = {belt_step, belt_load};
static const Methods lift = {lift_step, lift_load};
static const Methods pump = {pump_step, pump_load};
static const Methods slow = {belt_step, slow_load};

static Drive belts[15], lifts[15], pumps[15], slows[15];
static Drive* drives[60];
static uint32_t seed = 1, scans, checksum;

void interfaces_scan(int64_t now_ns) {
  (void)now_ns;
  if (scans == 0) {
    for (int i = 0; i < 15; ++i) {
      drives[4 * i] = &belts[i];
      drives[4 * i + 1] = &lifts[i];
      drives[4 * i + 2] = &pumps[i];
      drives[4 * i + 3] = &slows[i];
      belts[i].methods = &belt;
      lifts[i].methods = &lift;
      pumps[i].methods = &pump;
      slows[i].methods = &slow;
    }
  }
  int32_t sum = 0;
  seed = seed * 1664525u + 1013904223u;
  const int32_t demand = (int32_t)(seed / 1048576u);
  for (int i = 0; i < 60; ++i) {
    sum += drives[i]->methods->step(drives[i], demand);
    sum += drives[i]->methods->load(drives[i]);
  }
  checksum = checksum * 31u + (uint32_t)sum;
  scans++;
}

uint32_t interfaces_checksum(void) { return checksum; }
