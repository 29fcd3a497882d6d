#include "tests/sim/laws.h"

#include <algorithm>

#include "ir/bytecode/symbols.h"

namespace sim {
namespace {

// Is one of the things that the path goes through a union?
bool in_union(const ir::Image& image, const std::string& path, std::map<std::string, bool>& known) {
  for (size_t end = path.find_first_of(".["); end != std::string::npos;
       end = path.find_first_of(".[", end + 1)) {
    auto [row, fresh] = known.try_emplace(path.substr(0, end), false);
    if (fresh) {
      base::Result<ir::Symbol> whole = ir::find_symbol(image, row->first);
      row->second = whole.ok() && image.types.overlaps(whole->type);
    }
    if (row->second) return true;
  }
  return false;
}

// A variable of an image: all but what it holds.
struct Leaf {
  std::string path;
  ir::Symbol symbol;
  Value value;  // its text is empty
};

// By path; made once for each of the last images.
const std::vector<Leaf>& leaves_of(const ir::VerifiedImage& verified) {
  static std::map<base::Digest, std::vector<Leaf>> known;
  constexpr size_t kMost = 16;
  if (const auto found = known.find(verified.digest()); found != known.end()) return found->second;
  if (known.size() == kMost) known.clear();
  std::vector<Leaf>& leaves = known[verified.digest()];
  const ir::Image& image = verified.image();
  std::map<std::string, bool> unions;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    Value value{image.types.text(symbol.type), "", false, symbol.retain};
    value.comparable = !symbol.constant && !image.types.is_reference(symbol.type) &&
                       !in_union(image, path, unions);
    leaves.push_back({path, symbol, std::move(value)});
  });
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf& a, const Leaf& b) { return a.path < b.path; });
  return leaves;
}

Values values_of(const ir::VerifiedImage& image, std::span<const uint8_t> memory) {
  Values out;
  for (const Leaf& leaf : leaves_of(image)) {
    Value value = leaf.value;
    value.text = ir::format_value(image.image(), leaf.symbol, memory);
    out.emplace_hint(out.end(), leaf.path, std::move(value));
  }
  return out;
}

// A literal that the enumeration does not have any more, or a number that is none, has no place.
bool is_no_literal(const ir::Image& image, const std::string& path, const std::string& text) {
  base::Result<ir::Symbol> now = ir::find_symbol(image, path);
  if (!now.ok() || image.types[now->type].kind != ir::Kind::kEnum) return false;
  for (const ir::EnumLiteral& literal : image.types[now->type].literals) {
    if (ir::same_name(literal.name, text)) return false;
  }
  return true;
}

}  // namespace

Snapshot::Snapshot(vm::Controller& controller) : image_(controller.verified()) {
  const uint8_t* begin = controller.memory().data();
  data_.assign(begin, begin + controller.image().data_capacity);
  for (const vm::Force& force : controller.forces()) forced_.push_back(force.path);
}

const Values& Snapshot::values() const {
  if (values_) return *values_;
  values_ = values_of(image_, data_);
  for (const std::string& path : forced_) {
    if (const auto found = values_->find(path); found != values_->end()) {
      found->second.comparable = false;
    }
  }
  return *values_;
}

void check_untouched(const Snapshot& before, const Snapshot& now, const std::string& what) {
  require(before.image().digest() == now.image().digest(), what + " replaced the program");
  // Bytes of nobody may differ: what a change prepares lies there.
  if (before.same_bytes(now)) return;
  for (const auto& [path, value] : before.values()) {
    const Value& other = now.values().at(path);
    require(value.text == other.text,
            what + " changed " + path + " from " + value.text + " to " + other.text);
  }
}

void check_kept(const Snapshot& before, const Snapshot& now) {
  for (const auto& [path, value] : now.values()) {
    const auto old = before.values().find(path);
    if (old == before.values().end() || old->second.type != value.type) continue;
    if (!value.comparable || !old->second.comparable || old->second.text == value.text) continue;
    require(is_no_literal(now.image().image(), path, old->second.text),
            "a switch changed " + path + " from " + old->second.text + " to " + value.text);
  }
}

Values retained_values(vm::Controller& controller) {
  Values all = values_of(controller.verified(), controller.memory().view());
  std::erase_if(all, [](const auto& row) { return !row.second.retain || !row.second.comparable; });
  return all;
}

bool agree(const Values& a, const Values& b) {
  return std::all_of(a.begin(), a.end(), [&](const auto& row) {
    const auto other = b.find(row.first);
    return other == b.end() || other->second.type != row.second.type ||
           other->second.text == row.second.text;
  });
}

void check_restored(const Snapshot& at_switch, const Snapshot& before_undo, const Snapshot& now) {
  for (const auto& [path, value] : now.values()) {
    if (before_undo.values().contains(path) || !value.comparable) continue;
    const Value& was = at_switch.values().at(path);
    require(was.text == value.text,
            "undo brought " + path + " back as " + value.text + ", it was " + was.text);
  }
}

}  // namespace sim
