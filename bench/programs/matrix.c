/* The same as matrix.st. */
#include <math.h>
#include <stdint.h>

static double a[16][16], b[16][16], c[16][16];
static uint32_t seed = 1, scans, checksum;

void matrix_scan(int64_t now_ns) {
  (void)now_ns;
  seed = seed * 1664525u + 1013904223u;
  const unsigned row = seed / 268435456u, column = seed / 16777216u % 16u;
  a[row][column] = (double)(seed / 65536u % 256u) * 0.1;
  b[column][row] = (double)(seed / 256u % 256u) * 0.1;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      double sum = 0.0;
      for (int k = 0; k < 16; ++k) {
        sum += a[i][k] * b[k][j];
      }
      c[i][j] = sum;
    }
  }
  if (++scans % 1024 == 0) {
    for (int i = 0; i < 16; ++i) {
      for (int j = 0; j < 16; ++j) {
        checksum = checksum * 31u + (uint32_t)lrint(c[i][j] * 100.0);
      }
    }
  }
}

uint32_t matrix_checksum(void) { return checksum; }
