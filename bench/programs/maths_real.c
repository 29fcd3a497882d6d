/* The same as maths_real.st. */
#include <math.h>
#include <stdint.h>

static float angle = (float)0.1;
static uint32_t checksum;

void maths_real_scan(int64_t now_ns) {
  (void)now_ns;
  float sum = 0;
  for (int i = 1; i <= 20; ++i) {
    angle += (float)0.21875;
    if (angle > (float)6.25) angle -= (float)6.25;
    const float x = sinf(angle) * cosf(angle + 0.5f) + (float)1.5;
    const float y = expf(x) * (float)0.125 + logf(x + (float)i);
    sum += sqrtf(y) + atanf(x - y) + powf(x + 0.25f, (float)1.75) + powf(y, 3);
  }
  checksum = checksum * 31u + (uint32_t)rintf(sum * (float)0.5);
}

uint32_t maths_real_checksum(void) { return checksum; }
