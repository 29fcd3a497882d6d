// Loaded into a tool by LD_PRELOAD: a file system on which nothing can be locked.
#include <sys/file.h>

#include <cerrno>

extern "C" int flock(int, int) noexcept {
  errno = ENOLCK;
  return -1;
}
