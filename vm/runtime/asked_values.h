// The variables that a request for values names. Tools that watch a program ask for the same ones
// again and again: those of the last requests are kept, so that names are looked up once for each
// version of the program.
#pragma once

#include <string>
#include <vector>

#include "ir/bytecode/value_ranges.h"
#include "ir/bytecode/variable_names.h"
#include "ir/bytecode/verify.h"

namespace vm {

class AskedValues {
 public:
  struct Variable {
    ir::NamedSymbol named;
    std::string type;  // as people read it
  };
  struct Request {
    std::vector<Variable> variables;    // by name
    std::vector<ir::DataRange> ranges;  // where their values are
  };

  // Valid until the next call. kNoSuchVariable; kTooMany: they have more than kMaxReadBytes.
  base::Result<const Request*> find(const ir::VerifiedImage& version,
                                    const std::vector<std::string>& names);

 private:
  struct Kept {
    base::Digest version{};
    std::vector<std::string> names;
    Request request;
  };
  static constexpr size_t kMostKept = 4;  // several tools may watch
  Kept kept_[kMostKept];                  // a request's size is bounded by that of a message
  size_t oldest_ = 0;
};

}  // namespace vm
