// Running the other side of a comparison, and figures of repeated measurements.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

// One run of a command; what it says on standard error is lost when `quiet`.
struct Child {
  bool ok = false;  // started, and ended with 0
  std::string output;
  double wall_ms = 0;
  double cpu_ms = 0;  // its own and the system's for it
  // At most resident at a time. At least what this process itself had when it began the child.
  uint64_t peak_kib = 0;
};
Child run_child(const std::vector<std::string>& command, bool quiet = false);

// What a command printed; empty when it could not be started or failed.
std::string output_of(const std::vector<std::string>& command);

// Of this process; other work on the machine does not count.
double cpu_seconds();

double median(std::vector<double> values);
double fastest(const std::vector<double>& values);

// Pins this process and its children to the last core that it may use; the core,
// or -1 when the system refuses.
int pin_to_one_core();

// The number behind "KEY": in JSON text; negative when it is not there.
double json_number(const std::string& json, const std::string& key);

}  // namespace bench
