#include "linker/instances.h"

#include <algorithm>
#include <unordered_map>

#include "base/limits.h"

namespace linker {
namespace {

using ir::Kind;
using ir::TypeId;

class Walker {
 public:
  Walker(const ir::Program& program, const ir::Layouts& layouts, uint32_t most)
      : program_(program),
        types_(program.types),
        layouts_(layouts),
        initial_(program.types, program.constants, layouts),
        holds_(types_.size(), Holds::kUnknown),
        most_(most) {}

  base::Result<std::vector<InstanceNode>> run() {
    nodes_.emplace_back();
    nodes_[kGlobalsNode].type = program_.globals;
    for (const ir::ProgramInstance& instance : program_.instances) {
      InstanceNode node;
      node.type = instance.type;
      node.program = true;
      node.init = instance.init;
      node.name = instance.name;
      nodes_.push_back(std::move(node));
    }
    const auto programs = static_cast<uint32_t>(nodes_.size());
    for (uint32_t node = 1; node < programs && !error_; ++node) walk_area(node, 0);
    if (!error_) walk_area(kGlobalsNode, 0);
    if (error_) return *error_;
    return std::move(nodes_);
  }

 private:
  enum class Holds : uint8_t { kUnknown, kNo, kYes };

  // Does a value of the type hold instance slots?
  bool holds_instances(TypeId id, uint32_t depth) {
    if (types_.is_instance(id)) return true;
    if (holds_[id.index] != Holds::kUnknown) return holds_[id.index] == Holds::kYes;
    holds_[id.index] = Holds::kNo;
    bool found = false;
    if (depth < base::kMaxNesting && types_[id].kind == Kind::kArray) {
      found = holds_instances(types_[id].base, depth + 1);
    }
    if (depth < base::kMaxNesting && ir::is_structure(types_[id].kind)) {
      for (const ir::Member& member : types_[id].members) {
        found = found || holds_instances(member.type, depth + 1);
      }
    }
    if (found) holds_[id.index] = Holds::kYes;
    return found;
  }

  struct Spot {
    uint32_t node;
    uint32_t depth;
    uint64_t offset;
    bool retained;
    std::string name;
  };

  void fail(base::Refusal refusal, std::string text) {
    if (!error_) error_ = base::Error{refusal, std::move(text)};
  }

  void walk_area(uint32_t node, uint32_t depth) {
    const TypeId type = nodes_[node].type;
    const ir::ConstId init = nodes_[node].init;
    const bool retained = nodes_[node].retained;
    walk_members(type, init, {node, depth, 0, retained, ""});
  }

  void walk_members(TypeId type, ir::ConstId value, const Spot& spot) {
    const std::vector<ir::Member>& members = types_[type].members;
    for (size_t i = 0; i < members.size() && !error_; ++i) {
      const ir::Member& member = members[i];
      if (member.section == ir::Section::kInOut || !holds_instances(member.type, 0)) continue;
      if (types_[member.type].kind == Kind::kProgram) continue;  // the program instance itself
      Spot part = spot;
      part.offset += layouts_[type].member_offsets[i];
      part.retained = spot.retained || member.retain;
      part.name += (spot.name.empty() ? "" : ".") + member.name;
      walk_value(member.type, initial_.member_value(type, value, i), part);
    }
  }

  void walk_value(TypeId type, ir::ConstId value, const Spot& spot) {
    if (error_ || !holds_instances(type, 0)) return;
    if (types_.is_instance(type)) return add_instance(type, value, spot);
    if (ir::is_structure(types_[type].kind)) return walk_members(type, value, spot);
    walk_array(type, value, spot);
  }

  void walk_array(TypeId type, ir::ConstId value, const Spot& spot) {
    const std::vector<ir::Dimension>& dims = types_[type].dims;
    const TypeId element = types_[type].base;
    uint64_t count = 1;
    std::vector<int64_t> index;
    for (const ir::Dimension& dim : dims) {
      count *= dim.count();
      index.push_back(dim.low);
    }
    for (uint64_t flat = 0; flat < count && !error_; ++flat) {
      Spot part = spot;
      part.offset += flat * layouts_[element].size;
      part.name += "[";
      for (size_t d = 0; d < dims.size(); ++d) {
        part.name += (d == 0 ? "" : ",") + std::to_string(index[d]);
      }
      part.name += "]";
      walk_value(element, initial_.element_value(type, value, flat), part);
      for (size_t d = dims.size(); d-- > 0;) {
        if (index[d]++ < dims[d].high) break;
        index[d] = dims[d].low;
      }
    }
  }

  void add_instance(TypeId type, ir::ConstId value, const Spot& spot) {
    if (spot.depth >= base::kMaxCallDepth) {
      return fail(base::Refusal::kRecursion,
                  "`" + types_.text(type) + "` contains an instance of itself: " + spot.name);
    }
    if (nodes_.size() >= most_) {
      return fail(base::Refusal::kTooMany, "more than " + std::to_string(most_) + " instances; `" +
                                               spot.name + "` is one too many");
    }
    InstanceNode node;
    node.type = type;
    node.parent = spot.node;
    node.slot_offset = static_cast<uint32_t>(spot.offset);
    node.retained = spot.retained;
    node.init = value;
    node.name = spot.name;
    nodes_.push_back(std::move(node));
    walk_area(static_cast<uint32_t>(nodes_.size() - 1), spot.depth + 1);
  }

  const ir::Program& program_;
  const ir::TypeTable& types_;
  const ir::Layouts& layouts_;
  InitialValues initial_;
  std::vector<Holds> holds_;
  std::vector<InstanceNode> nodes_;
  const uint32_t most_;
  std::optional<base::Error> error_;
};

// Path step below a parent's ID; programs and instances among the globals both
// have parent 0.
std::string key_of(uint32_t parent, bool program, const std::string& name) {
  return std::to_string(parent) + (program ? "p" : "i") + ir::fold_name(name);
}

// Live instances of the running version by path step.
std::unordered_map<std::string, uint32_t> index_base(const ir::Image& base) {
  std::unordered_map<std::string, uint32_t> ids;
  for (uint32_t id = 1; id < base.instances.size(); ++id) {
    const ir::Instance& row = base.instances[id];
    if (!row.live) continue;
    ids.emplace(key_of(row.parent, base.types[row.type].kind == Kind::kProgram, row.name), id);
  }
  return ids;
}

void keep_ids(const ir::Program& program, std::vector<InstanceNode>& nodes, const ir::Image& base) {
  const std::unordered_map<std::string, uint32_t> ids = index_base(base);
  for (size_t i = 1; i < nodes.size(); ++i) {
    InstanceNode& node = nodes[i];
    const uint32_t parent = nodes[node.parent].id;
    if (node.parent != kGlobalsNode && parent == 0) continue;  // in a new instance
    const auto found = ids.find(key_of(parent, node.program, node.name));
    if (found == ids.end()) continue;
    const TypeId old_type = base.instances[found->second].type;
    if (ir::same_name(base.types[old_type].name, program.types[node.type].name)) {
      node.id = found->second;
    }
  }
}

ir::Instance row_of(const InstanceNode& node, const std::vector<InstanceNode>& nodes) {
  ir::Instance row;
  row.type = node.type;
  row.parent = nodes[node.parent].id;
  row.live = true;
  row.name = node.name;
  return row;
}

}  // namespace

base::Result<std::vector<InstanceNode>> walk_instances(const ir::Program& program,
                                                       const ir::Layouts& layouts, uint32_t most) {
  return Walker(program, layouts, most).run();
}

base::Result<std::vector<ir::Instance>> number_instances(const ir::Program& program,
                                                         std::vector<InstanceNode>& nodes,
                                                         const ir::Image* base, uint32_t most) {
  std::vector<ir::Instance> rows(1);
  std::vector<uint32_t> unused;
  if (base != nullptr) {
    keep_ids(program, nodes, *base);
    rows.resize(std::max<size_t>(base->instances.size(), 1));
    for (uint32_t id = 1; id < rows.size(); ++id) {
      rows[id].type = program.globals;  // of a free ID: means nothing
      rows[id].generation = base->instances[id].generation;
      if (!base->instances[id].live) unused.push_back(id);
    }
  }
  rows.reserve(std::max(rows.size(), nodes.size()));
  size_t next_unused = 0;
  for (size_t i = 1; i < nodes.size(); ++i) {
    InstanceNode& node = nodes[i];
    uint32_t generation = 0;
    if (node.id != 0) {
      generation = rows[node.id].generation;
    } else if (next_unused < unused.size()) {
      node.id = unused[next_unused++];
      generation = rows[node.id].generation + 1;
    } else {
      node.id = static_cast<uint32_t>(rows.size());
      rows.emplace_back();
    }
    rows[node.id] = row_of(node, nodes);
    rows[node.id].generation = generation;
  }
  if (rows.size() > most) {
    return base::Error{
        base::Refusal::kTooMany,
        std::to_string(rows.size()) + " instance IDs; the limit is " + std::to_string(most)};
  }
  rows[kGlobalsNode].type = program.globals;
  rows[kGlobalsNode].live = true;
  return rows;
}

}  // namespace linker
