/* The same as strings.st. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static char line[81], part[21];
static uint32_t seed = 1, checksum, found;

void strings_scan(int64_t now_ns) {
  (void)now_ns;
  seed = seed * 1664525u + 1013904223u;
  const int value = (int)(seed / 131072u % 4096u);
  const char* unit = value % 2 == 0 ? "bar" : "degC";
  snprintf(line, sizeof line, "sensor %d: value=%d unit=%s", value % 16, value, unit);
  const char* from = strstr(line, "value=") + 6;
  const char* to = strstr(line, " unit=");
  memcpy(part, from, (size_t)(to - from));
  part[to - from] = '\0';
  checksum = checksum * 31u + (uint32_t)strtol(part, NULL, 10);
  const size_t length = strlen(line);
  if (strcmp(line + length - 3, "bar") == 0) {
    found++;
  }
  checksum += (uint32_t)length + found;
}

uint32_t strings_checksum(void) { return checksum; }
