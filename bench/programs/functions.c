/* The same as functions.st. */
#include <stdint.h>

static int32_t raw[101];
static uint32_t seed = 1, checksum;

static int32_t scaled(int32_t value, int32_t gain, int32_t offset) {
  return value * gain / 64 + offset;
}

static int32_t limited(int32_t low, int32_t value, int32_t high) {
  if (value < low) {
    return low;
  }
  return value > high ? high : value;
}

void functions_scan(int64_t now_ns) {
  int32_t total = 0;
  (void)now_ns;
  seed = seed * 1664525u + 1013904223u;
  raw[seed / 16777216u % 100u + 1] = (int32_t)(seed / 65536u % 4096u);
  const int32_t gain = (int32_t)(seed / 16u % 64u) + 16;
  for (int i = 1; i <= 100; ++i) {
    total += limited(0, scaled(raw[i], gain, -100), 2000);
  }
  checksum = checksum * 31u + (uint32_t)total;
}

uint32_t functions_checksum(void) { return checksum; }
