/* The same as structs.st. */
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

typedef struct {
  int32_t low, high;
} Window;

typedef struct {
  int32_t position, target;
  int16_t speed;
  bool moving;
  Window allowed;
  uint32_t moves;
} Axis;

static Axis axes[51], kept[51];
static uint32_t seed = 1, scans, checksum;

void structs_scan(int64_t now_ns) {
  (void)now_ns;
  memcpy(kept, axes, sizeof kept);
  for (int i = 1; i <= 50; ++i) {
    Axis current = axes[i];
    if (!current.moving) {
      seed = seed * 1664525u + 1013904223u;
      current.target = (int32_t)(seed / 65536u);
      current.allowed.low = current.target - 300;
      current.allowed.high = current.target + 300;
      current.speed = 200;
      current.moving = true;
      current.moves++;
    }
    axes[i] = current;
    if (axes[i].position < axes[i].target) {
      axes[i].position += axes[i].speed;
    } else {
      axes[i].position -= axes[i].speed;
    }
    if (axes[i].position >= axes[i].allowed.low && axes[i].position <= axes[i].allowed.high) {
      axes[i].moving = false;
    }
  }
  if (++scans % 1024 == 0) {
    for (int i = 1; i <= 50; ++i) {
      checksum = checksum * 31u + (uint32_t)(axes[i].position - kept[i].position) + axes[i].moves;
    }
  }
}

uint32_t structs_checksum(void) { return checksum; }
