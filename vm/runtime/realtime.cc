#include "vm/runtime/realtime.h"

#include <sched.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "vm/runtime/thread_filter.h"

namespace vm {
namespace {

base::Error refused(const std::string& what, const std::string& way_out) {
  return {base::Refusal::kNotPermitted, what + ": " + std::strerror(errno) + "; " + way_out};
}

base::Status stay_on(uint32_t cpu) {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu >= CPU_SETSIZE) {
    return base::Error{base::Refusal::kUsage, "there is no processor " + std::to_string(cpu)};
  }
  CPU_SET(cpu, &set);
  if (sched_setaffinity(0, sizeof set, &set) == 0) return base::Ok{};
  if (errno != EINVAL) return refused("processor " + std::to_string(cpu), "name another one");
  return base::Error{base::Refusal::kUsage,
                     "processor " + std::to_string(cpu) + " is not there, or not for this process"};
}

// One write to each page; the byte keeps its value.
void touch(uint8_t* begin, uint64_t size) {
  const auto page = static_cast<uint64_t>(sysconf(_SC_PAGESIZE));
  for (uint64_t at = 0; at < size; at += page) {
    volatile uint8_t* byte = begin + at;
    *byte = *byte;
  }
}

}  // namespace

static base::Status make_timely(const RealTimeOptions& options) {
  if (options.cpu) {
    if (base::Status s = stay_on(*options.cpu); !s.ok()) return s;
  }
  // Pages count when they are touched: the 4 GiB that are reserved would not fit.
  if (options.lock_memory && mlockall(MCL_CURRENT | MCL_FUTURE | MCL_ONFAULT) != 0) {
    return refused("memory cannot be locked", "raise `ulimit -l`, or LimitMEMLOCK in the unit");
  }
  if (options.fifo_priority == 0) return base::Ok{};
  sched_param parameter{};
  parameter.sched_priority = static_cast<int>(options.fifo_priority);
  if (sched_setscheduler(0, SCHED_FIFO, &parameter) == 0) return base::Ok{};
  return refused("SCHED_FIFO with priority " + std::to_string(options.fifo_priority),
                 "raise `ulimit -r`, or LimitRTPRIO in the unit; `stvm doctor` shows the limits");
}

base::Status make_real_time(const RealTimeOptions& options) {
  base::Status timely = make_timely(options);
  return timely.ok() && options.confined ? confine_thread(ThreadKind::kControl) : timely;
}

void run_in_background() {
  // Whatever the thread that began it has. What cannot be had is no harm: it is a normal thread
  // then.
  sched_param none{};
  sched_setscheduler(0, SCHED_BATCH, &none);
  setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), 10);
}

void prefault(Controller& controller) {
  const ir::Image& image = controller.image();
  uint8_t* memory = controller.memory().data();
  touch(memory, image.data_capacity);
  touch(memory + ir::kStackBegin, image.stack_bytes);
}

}  // namespace vm
