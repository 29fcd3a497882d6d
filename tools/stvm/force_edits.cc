#include "tools/stvm/force_edits.h"

#include <algorithm>

#include "ir/types/address_text.h"
#include "vm/runtime/renamed_paths.h"

namespace stvm {
namespace {

// The address of the variable as a whole; "no address" also for a part of one.
std::string address_of(const ir::Image& image, const vm::Force& force) {
  for (const ir::IoBinding& binding : image.io) {
    if (binding.data == force.symbol.data && binding.type == force.symbol.type) {
      return ir::address_text(binding.address);
    }
  }
  return "no address";
}

class Edit {
 public:
  void compare(const std::string& before, const std::string& after) {
    if (before != after) add(before + " -> " + after);
  }
  void add(const std::string& what) { what_ += (what_.empty() ? "" : "; ") + what; }
  const std::string& what() const { return what_; }

 private:
  std::string what_;
};

const vm::Force* find(const std::vector<vm::Force>& forces, const std::string& path) {
  const auto is_it = [&](const vm::Force& force) { return force.path == path; };
  const auto found = std::find_if(forces.begin(), forces.end(), is_it);
  return found == forces.end() ? nullptr : &*found;
}

std::string moved(const ir::Image& old_image, const vm::Force& before, const ir::Image& new_image,
                  const vm::Force& after) {
  Edit edit;
  edit.compare(before.path, after.path);
  edit.compare(address_of(old_image, before), address_of(new_image, after));
  edit.compare(old_image.types.text(before.symbol.type), new_image.types.text(after.symbol.type));
  edit.compare(vm::value_text(old_image, before), vm::value_text(new_image, after));
  if (before.reason.empty() != after.reason.empty()) {
    edit.add("held " + vm::hold_text(after.reason));
  }
  return edit.what();
}

}  // namespace

tools::SystemEdits force_edits(const ir::Image& old_image, const std::vector<vm::Force>& now,
                               const ir::Image& new_image, const vm::ForcedSet& next) {
  tools::SystemEdits edits;
  const vm::RenamedPaths paths(old_image, new_image);
  std::vector<std::string> met;
  for (const vm::Force& force : now) {
    met.push_back(paths.find(force));
    const vm::Force* const after = find(next.forces, met.back());
    std::string what = after == nullptr ? "ends" : moved(old_image, force, new_image, *after);
    if (!what.empty()) edits.push_back({"force", force.path, std::move(what)});
  }
  for (const vm::Force& force : next.forces) {
    if (std::find(met.begin(), met.end(), force.path) != met.end()) continue;
    edits.push_back({"force", force.path, "comes back: " + vm::value_text(new_image, force)});
  }
  return edits;
}

}  // namespace stvm
