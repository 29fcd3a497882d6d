/* The same as motors.st. */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#ifndef EVERY
#define EVERY 1
#endif

typedef struct {
  bool request, tripped, reset;
  float set_speed;
  bool run, fault;
  float speed;
  uint32_t starts;
  bool was_running;
  uint32_t hours;
} Motor;

static Motor drive[200];
static uint32_t inputs[200];
static uint32_t seed = 1, scans, checksum;

static void motor(Motor* m) {
  m->fault = (m->fault | m->tripped) & !(m->reset & !m->tripped);
  m->run = m->request & !m->fault;
  if (m->run && !m->was_running) {
    m->starts++;
  }
  m->was_running = m->run;
  if (m->run) {
    m->hours++;
    if (m->speed < m->set_speed) {
      m->speed += 2.5f;
    }
  } else {
    m->speed *= 0.5f;
  }
}

void motors_scan(int64_t now_ns) {
  (void)now_ns;
  if (scans % EVERY == 0) {
    for (int i = 0; i <= 199; ++i) {
      seed = seed * 1664525u + 1013904223u;
      inputs[i] = seed;
    }
  }
  for (int i = 0; i <= 199; ++i) {
    drive[i].request = (inputs[i] & 0xC0000000u) != 0;
    drive[i].tripped = (inputs[i] & 0x3F000000u) == 0;
    drive[i].reset = (inputs[i] & 0x00C00000u) == 0;
    drive[i].set_speed = 100.0f;
    motor(&drive[i]);
  }
  if (++scans % 1024 == 0) {
    for (int i = 0; i <= 199; ++i) {
      checksum = checksum * 31u + drive[i].starts;
      checksum = checksum * 31u + drive[i].fault;
      checksum = checksum * 31u + (uint32_t)lrintf(drive[i].speed * 1000.0f);
    }
  }
}

uint32_t motors_checksum(void) { return checksum; }
