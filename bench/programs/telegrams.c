/* The same as telegrams.st. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char telegram[81], rest[81], field[21];
static int32_t total;
static uint32_t seed = 1, alarms, checksum;

void telegrams_scan(int64_t now_ns) {
  (void)now_ns;
  seed = seed * 1664525u + 1013904223u;
  snprintf(telegram, sizeof telegram, "\x02W%u;N", (unsigned)(seed / 65536u));
  size_t length = strlen(telegram);
  snprintf(telegram + length, sizeof telegram - length, "%u;T17;kg;", (unsigned)(seed % 1000u));
  if (seed / 65536u % 5u == 0) strcat(telegram, "ALARM;");
  strcat(telegram, "\x03");
  length = strlen(telegram);
  memcpy(rest, telegram + 1, length - 2);
  rest[length - 2] = '\0';
  int fields = 0;
  char* at = strchr(rest, ';');
  while (at != NULL) {
    memcpy(field, rest, (size_t)(at - rest));
    field[at - rest] = '\0';
    memmove(rest, at + 1, strlen(at + 1) + 1);
    fields++;
    if (field[0] == 'W') {
      total += (int32_t)strtol(field + 1, NULL, 10);
    }
    if (strcmp(field, "ALARM") == 0) alarms++;
    at = strchr(rest, ';');
  }
  if (strstr(telegram, "kg") != NULL) {
    checksum = checksum * 31u + (uint32_t)total + (uint32_t)fields + alarms;
  }
}

uint32_t telegrams_checksum(void) { return checksum; }
