// Running the other side of a comparison, and figures of repeated measurements.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

// What a command printed; empty when it could not be started or failed.
std::string output_of(const std::vector<std::string>& command);

double median(std::vector<double> values);

// Pins this process and its children to the last core that it may use; the core,
// or -1 when the system refuses.
int pin_to_one_core();

// The number behind "KEY": in JSON text; negative when it is not there.
double json_number(const std::string& json, const std::string& key);

}  // namespace bench
