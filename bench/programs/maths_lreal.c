/* The same as maths_lreal.st. */
#include <math.h>
#include <stdint.h>

static double angle = (double)0.1;
static uint32_t checksum;

void maths_lreal_scan(int64_t now_ns) {
  (void)now_ns;
  double sum = 0;
  for (int i = 1; i <= 20; ++i) {
    angle += (double)0.21875;
    if (angle > (double)6.25) angle -= (double)6.25;
    const double x = sin(angle) * cos(angle + 0.5) + (double)1.5;
    const double y = exp(x) * (double)0.125 + log(x + (double)i);
    sum += sqrt(y) + atan(x - y) + pow(x + 0.25, (double)1.75) + pow(y, 3);
  }
  checksum = checksum * 31u + (uint32_t)rint(sum * (double)1000.0);
}

uint32_t maths_lreal_checksum(void) { return checksum; }
