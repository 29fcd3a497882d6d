#include "bench/measure.h"

#include <fcntl.h>
#include <sched.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <ctime>

extern char** environ;

namespace bench {
namespace {

std::string read_all(int file) {
  std::string text;
  std::array<char, 4096> buffer;
  for (ssize_t got; (got = read(file, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<size_t>(got));
  }
  return text;
}

double milliseconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_usec) / 1e3;
}

}  // namespace

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) / 1e9;
}

Child run_child(const std::vector<std::string>& command, bool quiet) {
  Child made;
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) {
    return made;
  }
  std::vector<char*> arguments;
  for (const std::string& word : command) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  if (quiet) {
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  }
  const auto begin = std::chrono::steady_clock::now();
  pid_t child = 0;
  const int failed =
      posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (failed == 0) made.output = read_all(ends[0]);
  close(ends[0]);
  int status = 0;
  rusage usage{};
  made.ok = failed == 0 && wait4(child, &status, 0, &usage) == child && status == 0;
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - begin;
  made.wall_ms = wall.count();
  made.cpu_ms = milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
  made.peak_kib = static_cast<uint64_t>(usage.ru_maxrss);
  return made;
}

std::string output_of(const std::vector<std::string>& command) {
  Child child = run_child(command);
  return child.ok ? std::move(child.output) : "";
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values.empty() ? 0 : values[values.size() / 2];
}

double fastest(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::min_element(values.begin(), values.end());
}

int pin_to_one_core() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0) {
    return -1;
  }
  int core = CPU_SETSIZE - 1;
  while (core >= 0 && !CPU_ISSET(core, &allowed)) {
    --core;
  }
  if (core >= 0) {
    CPU_ZERO(&allowed);
    CPU_SET(core, &allowed);
    core = sched_setaffinity(0, sizeof allowed, &allowed) == 0 ? core : -1;
  }
  return core;
}

double json_number(const std::string& json, const std::string& key) {
  const size_t at = json.find("\"" + key + "\"");
  const size_t colon = at == std::string::npos ? at : json.find(':', at);
  return colon == std::string::npos ? -1 : std::strtod(json.c_str() + colon + 1, nullptr);
}

}  // namespace bench
