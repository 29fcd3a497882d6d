#include "tools/stvm/names.h"

#include "base/joined.h"
#include "base/nearest_name.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/variable_names.h"
#include "tools/common/pattern.h"

namespace stvm {
namespace {

// Where names are looked up: at a controller, in its forces, or in an image.
struct Place {
  ControllerClient* client = nullptr;
  bool forces = false;
  const ir::NameIndex* names = nullptr;
};

base::Status add_matching(const Place& place, const std::string& pattern, Names& out) {
  const size_t before = out.size();
  if (place.names != nullptr) {
    ir::for_each_leaf(place.names->image(), [&](const std::string& path, const ir::Symbol&) {
      if (tools::matches(pattern, path)) out.push_back(path);
    });
  } else if (place.forces) {
    base::Result<vm::ForceRows> forces = place.client->forces();
    if (!forces.ok()) return forces.error();
    for (const vm::ForceRow& row : forces->rows) {
      if (tools::matches(pattern, row.path)) out.push_back(row.path);
    }
  } else {
    base::Result<vm::Values> values = place.client->list(pattern);
    if (!values.ok()) return values.error();
    for (const vm::ValueRow& row : values->rows) out.push_back(row.path);
  }
  if (out.size() != before) return base::Ok{};
  return base::Error{
      base::Refusal::kNoSuchVariable,
      base::joined({"no ", place.forces ? "forced " : "", "variable matches `", pattern, "`"})};
}

base::Status add(const Place& place, const std::string& name, Names& out) {
  if (is_pattern(name)) return add_matching(place, name, out);
  if (place.names == nullptr) {
    out.push_back(name);
    return base::Ok{};
  }
  base::Result<ir::NamedSymbol> named = ir::named_symbol(*place.names, name);
  if (!named.ok()) return named.error();
  out.push_back(std::move(named->path));
  return base::Ok{};
}

base::Result<Names> expanded(const Place& place, const Names& names) {
  Names out;
  for (const std::string& name : names) {
    if (base::Status added = add(place, name, out); !added.ok()) return added.error();
  }
  return out;
}

base::Result<Assignments> expanded(const Place& place, const Assignments& rows) {
  Assignments out;
  for (const Assignment& row : rows) {
    Names names;
    if (base::Status added = add(place, row.name, names); !added.ok()) return added.error();
    for (std::string& name : names) out.push_back({std::move(name), row.value});
  }
  return out;
}

}  // namespace

bool is_pattern(std::string_view name) {
  return name.find_first_of("*?") != std::string_view::npos;
}

base::Result<Names> matching(ControllerClient& client, const Names& names) {
  return expanded({.client = &client}, names);
}

base::Result<Names> matching_forces(ControllerClient& client, const Names& names) {
  return expanded({.client = &client, .forces = true}, names);
}

base::Result<Names> matching(const ir::Image& image, const Names& names) {
  const ir::NameIndex index(image);
  return expanded({.names = &index}, names);
}

base::Error no_such_task(const ir::Image& image, std::string_view name) {
  base::NearestName nearest(name);
  for (const ir::ImageTask& task : image.tasks) nearest.offer(task.name);
  const std::string& best = nearest.best();
  const char* const meant = best.empty() ? "" : "; did you mean `";
  return {base::Refusal::kNoSuchTask,
          base::joined({"there is no task `", name, "`", meant, best, best.empty() ? "" : "`?"})};
}

base::Result<Assignments> matching(ControllerClient& client, const Assignments& rows) {
  return expanded({.client = &client}, rows);
}

base::Result<Assignments> matching(const ir::Image& image, const Assignments& rows) {
  const ir::NameIndex index(image);
  return expanded({.names = &index}, rows);
}

}  // namespace stvm
