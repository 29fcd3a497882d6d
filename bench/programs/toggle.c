/* The same as toggle.st. */
#include <stdbool.h>
#include <stdint.h>

static bool lamp;
static uint32_t checksum;

void toggle_scan(int64_t now_ns) {
  (void)now_ns;
  lamp = !lamp;
  if (lamp) {
    checksum++;
  }
}

uint32_t toggle_checksum(void) { return checksum; }
