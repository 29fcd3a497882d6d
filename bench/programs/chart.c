/* The same as chart.st, as one writes a sequence with two branches in C: a step of each. */
#include <stdbool.h>
#include <stdint.h>

typedef enum {
  IDLE,
  CHECK,
  FILL_A,
  FILL_B,
  WEIGH,
  PREPARE,
  BRANCHES,
  HOLD,
  TEST,
  REWORK,
  DRAIN,
  RINSE,
  FINISH
} Step;
typedef enum { HEAT_1, HEAT_2, HEAT_3, HEAT_DONE } Heat;
typedef enum { STIR_1, STIR_2, STIR_3, STIR_DONE } Stir;

typedef struct {
  bool start, full, ready, good;
  bool valve, pump, heater, lamp;
  int16_t speed;
  uint32_t batches, repeats;
  bool begun;
  Step step;
  Heat heat;
  Stir stir;
  int64_t entered, heat_entered, stir_entered;
} Batch;

static Batch line[10];
static uint32_t seed = 1, scans, checksum;

static const int64_t kMs = 1000000;

static void go(Batch* b, Step next, int64_t now) {
  b->step = next;
  b->entered = now;
}

static void go_heat(Batch* b, Heat next, int64_t now) {
  b->heat = next;
  b->heat_entered = now;
}

static void go_stir(Batch* b, Stir next, int64_t now) {
  if (b->stir == STIR_1 || b->stir == STIR_3) {
    b->speed = 0;
  }
  b->stir = next;
  b->stir_entered = now;
}

static void branches(Batch* b, int64_t now) {
  if (b->heat == HEAT_DONE && b->stir == STIR_DONE) {
    go(b, HOLD, now);
    return;
  }
  switch (b->heat) {
    case HEAT_1:
      if (b->full) go_heat(b, HEAT_2, now);
      break;
    case HEAT_2:
      if (now - b->heat_entered >= 50 * kMs) go_heat(b, HEAT_3, now);
      break;
    case HEAT_3:
      if (b->ready) go_heat(b, HEAT_DONE, now);
      break;
    case HEAT_DONE:
      break;
  }
  switch (b->stir) {
    case STIR_1:
      if (now - b->stir_entered >= 40 * kMs) go_stir(b, STIR_2, now);
      break;
    case STIR_2:
      if (b->good) go_stir(b, STIR_3, now);
      break;
    case STIR_3:
      if (now - b->stir_entered >= 30 * kMs) go_stir(b, STIR_DONE, now);
      break;
    case STIR_DONE:
      break;
  }
}

static void transitions(Batch* b, int64_t now) {
  const int64_t elapsed = now - b->entered;
  switch (b->step) {
    case IDLE:
      if (b->start) go(b, CHECK, now);
      break;
    case CHECK:
      if (b->ready) go(b, FILL_A, now);
      break;
    case FILL_A:
      if (elapsed >= 30 * kMs) go(b, FILL_B, now);
      break;
    case FILL_B:
      if (b->full) go(b, WEIGH, now);
      break;
    case WEIGH:
      if (b->ready) go(b, PREPARE, now);
      break;
    case PREPARE:
      if (elapsed >= 20 * kMs) {
        go(b, BRANCHES, now);
        b->heat = HEAT_1;
        b->stir = STIR_1;
        b->heat_entered = b->stir_entered = now;
      }
      break;
    case BRANCHES:
      branches(b, now);
      break;
    case HOLD:
      if (elapsed >= 20 * kMs) go(b, TEST, now);
      break;
    case TEST:
      if (b->good) {
        go(b, DRAIN, now);
      } else {
        go(b, REWORK, now);
        b->repeats++;
      }
      break;
    case REWORK:
      if (b->ready) go(b, PREPARE, now);
      break;
    case DRAIN:
      if (!b->full) go(b, RINSE, now);
      break;
    case RINSE:
      if (elapsed >= 30 * kMs) {
        go(b, FINISH, now);
        b->batches++;
      }
      break;
    case FINISH:
      go(b, IDLE, now);
      break;
  }
}

static void batch(Batch* b, int64_t now) {
  if (b->begun) {
    transitions(b, now);
  } else {
    b->begun = true;
    go(b, IDLE, now);
  }
  const Step s = b->step;
  b->valve = s == FILL_A || s == FILL_B || s == RINSE;
  b->pump = s == FILL_B || s == DRAIN || s == RINSE;
  b->heater = s == BRANCHES && b->heat != HEAT_DONE;
  b->lamp = s == PREPARE || s == HOLD;
  if (s == BRANCHES && (b->stir == STIR_1 || b->stir == STIR_3)) {
    b->speed += 10;
  }
}

void chart_scan(int64_t now_ns) {
  for (int i = 0; i <= 9; ++i) {
    seed = seed * 1664525u + 1013904223u;
    line[i].start = (seed & 0xC0000000u) != 0;
    line[i].full = (seed & 0x30000000u) != 0;
    line[i].ready = (seed & 0x0C000000u) != 0;
    line[i].good = (seed & 0x03000000u) != 0;
    batch(&line[i], now_ns);
    checksum += line[i].valve + line[i].pump * 3u + line[i].heater * 5u + line[i].lamp * 7u;
  }
  if (++scans % 64 == 0) {
    for (int i = 0; i <= 9; ++i) {
      checksum = checksum * 31u + line[i].batches + line[i].repeats + (uint32_t)line[i].speed;
    }
  }
}

uint32_t chart_checksum(void) { return checksum; }
