/* The same as buffer.st. */
#include <stdint.h>
#include <string.h>

static uint8_t data[256], copy[256];
static uint32_t seed = 1, checksum;

void buffer_scan(int64_t now_ns) {
  (void)now_ns;
  seed = seed * 1664525u + 1013904223u;
  data[seed / 16777216u] = (uint8_t)(seed / 65536u % 256u);
  const uint8_t* p = data;
  const uint8_t* const stop = data + sizeof data;
  uint32_t sum = 0;
  while (p < stop) {
    sum = sum * 3u + *p;
    p++;
  }
  const uint8_t* w = data;
  uint32_t words = 0;
  for (int i = 1; i <= 128; ++i) {
    uint16_t word;
    memcpy(&word, w, sizeof word);
    words += word * (uint32_t)i;
    w += 2;
  }
  p = data;
  uint8_t* q = copy;
  for (int i = 1; i <= 256; ++i) {
    *q = *p ^ 0x55;
    p++;
    q++;
  }
  p = copy;
  uint32_t zeros = 0;
  for (int i = 0; i <= 255; ++i) {
    if (p[i] == 0x55) zeros++;
  }
  checksum = checksum * 31u + sum + words + zeros;
}

uint32_t buffer_checksum(void) { return checksum; }
