/* The same as cases.st. */
#include <stdbool.h>
#include <stdint.h>

#ifndef EVERY
#define EVERY 1
#endif

typedef struct {
  bool start, ready, fault, reset;
  bool motor, valve, alarm;
  uint32_t parts;
  int16_t state, wait;
} Machine;

static Machine station[50];
static uint8_t inputs[50];
static uint32_t seed = 1, scans, checksum;

static void machine(Machine* m) {
  switch (m->state) {
    case 0: /* idle */
      m->motor = false;
      m->valve = false;
      if (m->start) m->state = 1;
      break;
    case 1: /* run up */
      m->motor = true;
      if (++m->wait >= 5) {
        m->wait = 0;
        m->state = 2;
      }
      break;
    case 2: /* wait for a part */
      if (m->ready) {
        m->state = 3;
      } else if (!m->start) {
        m->state = 6;
      }
      break;
    case 3: /* clamp */
      m->valve = true;
      m->state = 4;
      break;
    case 4: /* work */
      ++m->wait;
      if (m->fault) {
        m->state = 7;
      } else if (m->wait >= 10) {
        m->state = 5;
      }
      break;
    case 5: /* release */
      m->valve = false;
      m->wait = 0;
      m->parts++;
      m->state = 2;
      break;
    case 6: /* run down */
      m->motor = false;
      m->state = 0;
      break;
    case 7: /* fault */
      m->alarm = true;
      m->motor = false;
      if (m->reset) {
        m->alarm = false;
        m->wait = 0;
        m->state = 0;
      }
      break;
    default:
      m->state = 0;
  }
}

void cases_scan(int64_t now_ns) {
  (void)now_ns;
  if (scans % EVERY == 0) {
    for (int i = 0; i <= 49; ++i) {
      seed = seed * 1664525u + 1013904223u;
      inputs[i] = (uint8_t)(seed / 16777216u);
    }
  }
  for (int i = 0; i <= 49; ++i) {
    const uint8_t bits = inputs[i];
    station[i].start = (bits & 0x03) != 0;
    station[i].ready = (bits & 0x0C) != 0;
    station[i].fault = (bits & 0xF0) == 0;
    station[i].reset = (bits & 0x30) == 0;
    machine(&station[i]);
  }
  if (++scans % 1024 == 0) {
    for (int i = 0; i <= 49; ++i) {
      checksum = checksum * 31u + station[i].parts;
      checksum = checksum * 31u + station[i].motor + station[i].alarm;
    }
  }
}

uint32_t cases_checksum(void) { return checksum; }
