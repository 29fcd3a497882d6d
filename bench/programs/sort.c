/* The same as sort.st. */
#include <stdint.h>

static int16_t values[101];
static uint32_t seed = 1, scans, checksum;

void sort_scan(int64_t now_ns) {
  (void)now_ns;
  for (int16_t i = 1; i <= 100; ++i) {
    seed = seed * 1664525u + 1013904223u;
    values[i] = (int16_t)(seed / 131072u);
  }
  for (int16_t i = 2; i <= 100; ++i) {
    const int16_t current = values[i];
    int16_t j = i - 1;
    while (j >= 1) {
      if (values[j] <= current) {
        break;
      }
      values[j + 1] = values[j];
      --j;
    }
    values[j + 1] = current;
  }
  if (++scans % 1024 == 0) {
    for (int i = 1; i <= 100; ++i) {
      checksum = checksum * 31u + (uint32_t)values[i];
    }
  }
}

uint32_t sort_checksum(void) { return checksum; }
