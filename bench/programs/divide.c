/* The same as divide.st. */
#include <stdint.h>

static int64_t clock_ns = 1700000000123456789;
static uint64_t count = 1;
static uint32_t checksum;

void divide_scan(int64_t now_ns) {
  (void)now_ns;
  for (int i = 1; i <= 20; ++i) {
    count = count * 6364136223846793005u + 1442695040888963407u;
    clock_ns += (int64_t)(count / 1099511627776u);
    const int64_t seconds = clock_ns / 1000000000;
    const int64_t days = seconds / 86400;
    const int64_t hours = seconds % 86400 / 3600;
    const int64_t minutes = seconds % 3600 / 60;
    const int64_t scaled = (seconds - clock_ns) / 4096 % 999;
    uint64_t digits = 0;
    uint64_t rest = count % 1000003u;
    while (rest > 0) {
      digits = digits * 11u + rest % 10u;
      rest = rest / 10u;
    }
    checksum = checksum * 31u + (uint32_t)(days % 7 + hours + minutes) +
               (uint32_t)(digits % 65521u) + (uint32_t)(scaled + 999);
  }
}

uint32_t divide_checksum(void) { return checksum; }
