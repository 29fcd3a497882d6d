// The `stc` beside this program: stvm contains no compiler.
#pragma once

#include <string>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/verify.h"
#include "tools/common/options.h"

namespace stvm {

// Sources as a command line names them.
struct Sources {
  std::vector<std::string> paths;
  std::vector<std::string> options;  // of the compiler, "--dialect=iec"
};
Sources sources_of(const tools::Options& options);
// `stc COMMAND OPTIONS... SOURCES...`
std::vector<std::string> stc_arguments(std::vector<std::string> command, const Sources& sources);

// Before image files are loaded by a process that ends with them: heap.h. A controller that serves
// would keep memory that it needed once.
void expect_programs(const Sources& sources);
// An image file, or sources that are compiled first. Verified, so it can run.
base::Result<ir::VerifiedImage> load_program(const Sources& sources);
// Image files, or sources that are compiled first: an image for each RESOURCE, by name.
base::Result<std::vector<ir::VerifiedImage>> load_programs(const Sources& sources);

// Linked against the program that runs, for a change of it; `move_all`: with every instance at
// another place.
base::Result<base::Bytes> relink(const Sources& sources, base::ByteSpan running, bool move_all);

// kUsage when there are options for the compiler, and nothing is compiled.
base::Status check_compile_options(const Sources& sources);

// The file begins as an image does.
bool is_image(const std::string& path);

}  // namespace stvm
