/* The same as one_case.st. The lamps are outputs: others see them. */
#include <stdbool.h>
#include <stdint.h>

static int16_t state, wait;
bool one_case_red, one_case_yellow, one_case_green;
static uint32_t checksum;

void one_case_scan(int64_t now_ns) {
  (void)now_ns;
  wait++;
  switch (state) {
    case 0:
      one_case_red = true;
      one_case_yellow = false;
      if (wait >= 20) {
        wait = 0;
        state = 1;
      }
      break;
    case 1:
      one_case_yellow = true;
      if (wait >= 3) {
        wait = 0;
        state = 2;
      }
      break;
    case 2:
      one_case_red = false;
      one_case_yellow = false;
      one_case_green = true;
      if (wait >= 25) {
        wait = 0;
        state = 3;
      }
      break;
    case 3:
      one_case_green = false;
      one_case_yellow = true;
      if (wait >= 3) {
        wait = 0;
        state = 0;
        checksum++;
      }
      break;
  }
}

uint32_t one_case_checksum(void) { return checksum; }
