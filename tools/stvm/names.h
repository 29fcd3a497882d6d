// Names of variables on a command line. A name with `*` or `?` is a pattern and stands for every
// variable that it matches, in the order in which they are declared ('Main.pumps[*].run').
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/trace.h"

namespace stvm {

using Names = std::vector<std::string>;

bool is_pattern(std::string_view name);

// The names with what each pattern matches in its place. kNoSuchVariable when one matches
// nothing. A controller resolves the other names itself.
base::Result<Names> matching(ControllerClient& client, const Names& names);
// The same among the names of forces only.
base::Result<Names> matching_forces(ControllerClient& client, const Names& names);
// Every name comes out as a path (ir/bytecode/variable_names.h).
base::Result<Names> matching(const ir::Image& image, const Names& names);

// kNoSuchTask, with the name that was meant, perhaps.
base::Error no_such_task(const ir::Image& image, std::string_view name);

// A value for each variable that its name stands for.
using Assignments = std::vector<Assignment>;
base::Result<Assignments> matching(ControllerClient& client, const Assignments& rows);
base::Result<Assignments> matching(const ir::Image& image, const Assignments& rows);

}  // namespace stvm
