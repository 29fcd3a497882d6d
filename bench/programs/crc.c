/* The same as crc.st. */
#include <stdint.h>

static uint8_t data[1024];
static uint32_t seed = 1, checksum;

void crc_scan(int64_t now_ns) {
  uint16_t sum = 0xFFFF;
  (void)now_ns;
  seed = seed * 1664525u + 1013904223u;
  data[seed / 4194304u] = (uint8_t)(seed / 65536u);
  for (int i = 0; i <= 1023; ++i) {
    sum = (uint16_t)(sum ^ (data[i] << 8));
    for (int b = 1; b <= 8; ++b) {
      if ((sum & 0x8000) != 0) {
        sum = (uint16_t)((sum << 1) ^ 0x1021);
      } else {
        sum = (uint16_t)(sum << 1);
      }
    }
  }
  checksum = checksum * 31u + sum;
}

uint32_t crc_checksum(void) { return checksum; }
