/* The same as pid.st. */
#include <math.h>
#include <stdint.h>

typedef struct {
  float setpoint, actual, output, gain, integral, last, error;
} PidLoop;

static PidLoop loop[50];
static float process[50];
static float setpoint;
static uint32_t seed = 1, scans, checksum;

static void pid_loop(PidLoop* p) {
  p->error = p->setpoint - p->actual;
  p->integral = p->integral + p->error * 0.05f;
  p->output = p->gain * p->error + p->integral - (p->actual - p->last) * 0.3f;
  p->last = p->actual;
  if (p->output > 100.0f) {
    p->integral = p->integral - (p->output - 100.0f);
    p->output = 100.0f;
  } else if (p->output < 0.0f) {
    p->integral = p->integral - p->output;
    p->output = 0.0f;
  }
}

void pid_scan(int64_t now_ns) {
  (void)now_ns;
  if (scans == 0) {
    for (int i = 0; i <= 49; ++i) {
      loop[i].gain = 2.0f;
    }
  }
  if (scans % 200 == 0) {
    seed = seed * 1664525u + 1013904223u;
    setpoint = (float)(seed / 16777216u) * 0.25f;
  }
  for (int i = 0; i <= 49; ++i) {
    loop[i].setpoint = setpoint;
    loop[i].actual = process[i];
    pid_loop(&loop[i]);
    process[i] = process[i] + (loop[i].output - process[i]) * 0.02f;
  }
  if (++scans % 1024 == 0) {
    for (int i = 0; i <= 49; ++i) {
      checksum = checksum * 31u + (uint32_t)lrintf(process[i] * 1000.0f);
    }
  }
}

uint32_t pid_checksum(void) { return checksum; }
