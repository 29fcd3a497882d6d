// Tasks, programs with connections, VAR_ACCESS and VAR_CONFIG.
#include "tests/differential/builder.h"

namespace differential {

// What goes in and out before and after each scan, and a block with a task of its own.
void Builder::connect(Task& task, const Interface& face) {
  auto global = [&](TypeRef type) {
    std::vector<std::string> names;
    for (const Variable& one : global_variables_) {
      if (one.type == type) names.push_back(one.name);
    }
    return names.empty() ? std::string() : names[below(count(names))];
  };
  for (const Variable& input : face.inputs) {
    std::string from = global(input.type);
    if (from.empty() && is_elementary(input.type)) from = text(literal(input.type, true));
    if (!from.empty() && one_in(2)) task.connections.push_back(input.name + " := " + from);
  }
  for (const Variable& output : face.outputs) {
    std::string to = global(output.type);
    if (!to.empty()) task.connections.push_back(output.name + " => " + to);
  }
  if (!face.in_outs.empty() && one_in(2)) {
    Task own{"Own" + std::to_string(program_.tasks.size()), 10 + 10 * below(3), below(5), {}};
    task.connections.push_back(face.in_outs[below(count(face.in_outs))].name + " WITH " + own.name);
    program_.tasks.push_back(std::move(own));
  }
}

// How its inputs and outputs are buffered and exchanged (B4, B5, B12): a scan sees the same.
void Builder::exchange(Task& task) {
  static constexpr const char* kBuffers[] = {"copied",            "locked", "swapped",
                                             "swapped_with_flag", "three",  "first_unseen"};
  const bool own = one_in(6);
  for (const char* which : {"input_buffer", "output_buffer"}) {
    if (!one_in(4)) continue;
    const char* const kind = kBuffers[below(own ? 5 : 6)];  // with that, none would be unseen
    task.attributes.push_back(std::string("'") + which + "' := '" + kind + "'");
  }
  if (own) task.attributes.push_back("'exchange' := 'own'");
}

void Builder::tasks(uint32_t count) {
  if (!configured_) return;
  for (uint32_t i = 0; i < count; ++i) {
    static constexpr uint32_t kPeriods[] = {10, 20, 30, 50};
    Task task{"Task" + std::to_string(i), i == 0 ? 10 : kPeriods[below(4)], below(3),
              "Main" + std::to_string(i)};
    if (i > 0 && one_in(3)) task.event = "event";
    exchange(task);
    connect(task, programs_[i]);
    program_.tasks.push_back(std::move(task));
  }
}

// Names for the outside, and values and addresses that belong to one instance.
void Builder::configure(Pou& pou) {
  const std::string path = "Run" + pou.name + ".";
  auto entry = [&](const Variable& one, const std::string& word) {
    return path + one.name + word + " : " + name_of(one.type);
  };
  auto consider = [&](const Variable& one) {
    const bool scalar = is_elementary(one.type) || is_text(one.type);
    if (!scalar || is_counter_name(one.name) || !one.address.empty()) return;
    if (one_in(8)) {
      program_.accesses.push_back(fresh("name") + " : " + entry(one, "") +
                                  (one_in(2) ? " READ_ONLY;" : " READ_WRITE;"));
    }
    if (one_in(8)) {
      program_.configured.push_back("Cpu." + entry(one, "") +
                                    " := " + text(literal(one.type, true)) + ";");
    }
  };
  for (const VarBlock& block : pou.blocks) {
    if (block.section != Section::kLocal && block.section != Section::kRetain) continue;
    for (const Variable& one : block.variables) consider(one);
  }
  if (!one_in(2)) return;
  static constexpr ir::Kind kKinds[] = {ir::Kind::kBool, ir::Kind::kByte, ir::Kind::kWord,
                                        ir::Kind::kDint};
  static constexpr const char* kSizes[] = {"X", "B", "W", "D"};
  const uint32_t which = below(4);
  Variable point{fresh("point"), elementary(kKinds[which])};
  point.address = std::string("%M") + kSizes[which] + "*";
  section(pou, Section::kLocal).variables.push_back(point);
  see(point, true);
  static constexpr uint32_t kInEight[] = {8, 8, 4, 2};  // none overlaps another one
  std::string number = std::to_string(next_point_++ * kInEight[which]);
  if (which == 0) number += "." + std::to_string(below(8));
  program_.configured.push_back("Cpu." + path + point.name + " AT %M" + kSizes[which] + number +
                                " : " + name_of(point.type) +
                                (one_in(2) ? " := " + text(literal(point.type, true)) : "") + ";");
}

}  // namespace differential
