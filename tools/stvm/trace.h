// Values of chosen variables after every scan: `--print` shows the last ones, `--trace` writes all.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "base/result.h"
#include "vm/runtime/controller.h"

namespace stvm {

// "A,B" and repeated options -> names. Commas inside brackets belong to the name ("m[1,2]").
std::vector<std::string> split_names(const std::vector<std::string>& lists);

// "NAME=VALUE".
struct Assignment {
  std::string name;
  std::string value;
};
base::Result<std::vector<Assignment>> parse_assignments(const std::vector<std::string>& texts);

// A CSV file: a line of names, then one for each scan. Every variable when no names are given.
class Trace {
 public:
  static base::Result<Trace> open(const std::string& path, const ir::Image& image,
                                  std::vector<std::string> names);
  Trace(Trace&& other) noexcept
      : file_(std::exchange(other.file_, nullptr)), names_(std::move(other.names_)) {}
  Trace& operator=(Trace&&) = delete;
  ~Trace();

  base::Status write(const vm::Controller& controller);
  // kFileUnwritable when anything did not reach the file.
  base::Status close();

 private:
  Trace(std::FILE* file, std::vector<std::string> names) : file_(file), names_(std::move(names)) {}

  std::FILE* file_;
  std::vector<std::string> names_;
};

}  // namespace stvm
