/* The same as for_100.st. */
#include <stdint.h>

static uint32_t checksum = 1;

void for_100_scan(int64_t now_ns) {
  (void)now_ns;
  for (int i = 1; i <= 100; ++i) {
    checksum = checksum * 3u + (uint32_t)i;
  }
}

uint32_t for_100_checksum(void) { return checksum; }
