/* The same as timers.st, with the function blocks of stdlib/st. */
#include <stdbool.h>
#include <stdint.h>

#ifndef EVERY
#define EVERY 1
#endif

typedef struct {
  bool in;
  int64_t pt;
  bool q;
  int64_t et;
  bool running;
  int64_t started;
} Ton;

typedef struct {
  bool cu, r;
  int16_t pv;
  bool q;
  int16_t cv;
  bool last_up;
} Ctu;

typedef struct {
  bool clk, q, m;
} RTrig;

static Ton timer[100];
static Ctu counter[100];
static RTrig edge[100];
static uint32_t inputs[100];
static uint32_t seed = 1, scans, checksum, fired, edges;

static void ton(Ton* t, int64_t now) {
  if (!t->in) {
    t->running = false;
    t->q = false;
    t->et = 0;
  } else if (!t->q) {
    if (!t->running) {
      t->running = true;
      t->started = now;
    }
    t->et = now - t->started;
    if (t->et >= t->pt) {
      t->q = true;
      t->et = t->pt > 0 ? t->pt : 0;
    }
  }
}

static void ctu(Ctu* c) {
  if (c->r) {
    c->cv = 0;
  } else if (c->cu && !c->last_up && c->cv < 32767) {
    c->cv++;
  }
  c->last_up = c->cu;
  c->q = c->cv >= c->pv;
}

static void r_trig(RTrig* e) {
  e->q = e->clk & !e->m;
  e->m = e->clk;
}

void timers_scan(int64_t now_ns) {
  if (scans % EVERY == 0) {
    for (int i = 0; i <= 99; ++i) {
      seed = seed * 1664525u + 1013904223u;
      inputs[i] = seed;
    }
  }
  for (int i = 0; i <= 99; ++i) {
    const bool input = (inputs[i] & 0xE0000000u) != 0;
    const bool clear = (inputs[i] & 0x1FF00000u) == 0;
    timer[i].in = input;
    timer[i].pt = 100000000;
    ton(&timer[i], now_ns);
    fired += timer[i].q;
    counter[i].cu = input;
    counter[i].r = clear;
    counter[i].pv = 50;
    ctu(&counter[i]);
    edge[i].clk = counter[i].q;
    r_trig(&edge[i]);
    edges += edge[i].q;
  }
  if (++scans % 1024 == 0) {
    checksum = checksum * 31u + fired;
    checksum = checksum * 31u + edges;
    for (int i = 0; i <= 99; ++i) {
      checksum = checksum * 31u + (uint32_t)counter[i].cv;
    }
  }
}

uint32_t timers_checksum(void) { return checksum; }
