/* The same as mixed.st. */
#include <math.h>
#include <stdint.h>
#include <stdlib.h>

static int32_t number = 1, total;
static float smooth;
static double energy;
static uint16_t pattern;
static uint32_t checksum;

void mixed_scan(int64_t now_ns) {
  (void)now_ns;
  energy = 0.0;
  for (int32_t i = 1; i <= 200; ++i) {
    number = (number * 7 + i) % 10007;
    smooth = smooth * 0.75f + (float)number * 0.25f;
    if (number > 5000) {
      energy += (double)smooth * 0.001;
    } else {
      energy -= 0.5;
    }
    pattern = (uint16_t)((pattern << 1) ^ number);
    total += (int32_t)smooth / 3 + (number > i * 20 ? number : i * 20) - abs(number - 5000);
  }
  checksum = checksum * 31u + (uint32_t)total + pattern;
  checksum += (uint32_t)lrint(fabs(energy) * 100.0);
}

uint32_t mixed_checksum(void) { return checksum; }
