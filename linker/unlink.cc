#include "linker/unlink.h"

#include <string>
#include <unordered_map>
#include <unordered_set>

#include "ir/bytecode/identities.h"
#include "ir/bytecode/located_paths.h"
#include "linker/initial_differences.h"
#include "linker/place_finder.h"
#include "linker/unlink_code.h"

namespace linker {
namespace {

class Unlinker {
 public:
  explicit Unlinker(const ir::Image& image) : image_(image), program_(out_.program) {}

  base::Result<Unlinked> run() {
    program_.name = image_.name;
    program_.types = *image_.types;
    program_.constants = *image_.constants;
    program_.globals = image_.globals;
    program_.access = image_.access;
    program_.shared = image_.shared;
    program_.schedule = image_.schedule;
    out_.devices = image_.devices;
    out_.safe = image_.safe;
    if (base::Status named = check_names(); !named.ok()) return named.error();
    pous();
    if (base::Status done = objects(); !done.ok()) return done.error();
    tasks();
    instances();
    block_tasks();
    program_.located = ir::located_paths(image_);
    return std::move(out_);
  }

 private:
  static bool is_used(const ir::LinkedPou& pou) { return !pou.name.empty(); }

  // What refers to POUs and types by number is led by their names from here on.
  base::Status check_names() const {
    std::unordered_set<std::string> names;
    for (const ir::LinkedPou& pou : image_.pous) {
      if (!is_used(pou) || names.insert(ir::fold_name(pou.name)).second) continue;
      return unnamed("two POUs are called `" + pou.name + "`");
    }
    std::unordered_set<std::string> types;
    for (uint32_t i = ir::kElementaryCount; i < image_.types.size(); ++i) {
      const ir::Type& type = image_.types[ir::TypeId(i)];
      if (type.name.empty() || type.kind == ir::Kind::kGlobals) continue;
      if (types.insert(ir::fold_name(type.name)).second) continue;
      return unnamed("two types are called `" + type.name + "`");
    }
    bool named = true;
    const auto check = [&](uint32_t pou) { named = named && is_used(image_.pous[pou]); };
    for (const ir::LinkedChart& row : image_.charts) check(row.pou);
    for (const ir::LinkedMigration& row : image_.migrations) check(row.pou);
    for (const ir::LinkedOverride& row : image_.overrides) {
      check(row.prototype);
      check(row.target);
    }
    for (const ir::Instance& row : image_.instances) {
      if (row.live && &row != image_.instances.data()) check(row.pou);
    }
    if (named) return base::Ok{};
    return unnamed("a POU that is used has no name");
  }
  static base::Error unnamed(const std::string& text) {
    return {base::Refusal::kUndefinedSymbol, "the image cannot be taken apart: " + text};
  }

  void pous() {
    numbers_.resize(image_.pous.size());
    for (uint32_t i = 0; i < image_.pous.size(); ++i) {
      const ir::LinkedPou& linked = image_.pous[i];
      if (!is_used(linked)) continue;
      numbers_[i] = ir::PouId(static_cast<uint32_t>(program_.pous.size()));
      ir::Pou pou;
      pou.name = linked.name;
      pou.kind = linked.kind;
      pou.self = linked.self;
      pou.recursion_depth = linked.recursion_depth;
      pou.file = linked.file;
      if (!image_.contents.empty()) pou.content.identity = image_.contents[i].identity;
      for (const ir::FrameSlot& slot : linked.slots) {
        if (slot.kind != ir::SlotKind::kParam) break;
        pou.locals.push_back({slot.name, slot.region.type, slot.local});
      }
      program_.pous.push_back(std::move(pou));
    }
    for (const ir::LinkedChart& chart : image_.charts) {
      program_.pous[numbers_[chart.pou].index].chart = chart.moves;
    }
    for (const ir::LinkedOverride& row : image_.overrides) {
      program_.overrides.push_back({row.type, numbers_[row.prototype], numbers_[row.target]});
    }
    for (const ir::LinkedMigration& row : image_.migrations) {
      program_.migrations.push_back(
          {numbers_[row.pou], row.type, row.from, row.inverse, row.values});
    }
  }

  base::Status objects() {
    const PlaceFinder finder(image_);
    for (uint32_t i = 0; i < image_.pous.size(); ++i) {
      if (!is_used(image_.pous[i])) continue;
      base::Result<ir::Object> object = unlink_code(image_, finder, i);
      if (!object.ok()) return object.error();
      out_.objects.push_back(std::move(object).value());
    }
    return base::Ok{};
  }

  void tasks() {
    for (const ir::ImageTask& linked : image_.tasks) {
      ir::Task task;
      task.name = linked.name;
      task.period_ns = linked.period_ns;
      task.watchdog_ns = linked.watchdog_ns;
      task.priority = linked.priority;
      task.once = linked.once;
      task.event = ir::event_global(image_, linked);
      task.policy = linked.policy;
      program_.tasks.push_back(std::move(task));
    }
  }

  void instances() {
    for (const uint32_t id : image_.program_ids()) {
      const ir::Instance& row = image_.instances[id];
      ir::ProgramInstance instance;
      instance.name = row.name;
      instance.type = row.type;
      instance.task = task_of(id);
      instance.init = initial_difference(image_, program_.constants, id);
      instance.old_name = row.old_name;
      programs_.emplace(id, static_cast<uint32_t>(program_.instances.size()));
      program_.instances.push_back(std::move(instance));
    }
  }

  uint32_t task_of(uint32_t id) const {
    for (uint32_t task = 0; task < image_.tasks.size(); ++task) {
      for (const uint32_t program : image_.tasks[task].programs) {
        if (program == id) return task;
      }
    }
    return ir::kNoTask;
  }

  void block_tasks() {
    for (uint32_t task = 0; task < image_.tasks.size(); ++task) {
      for (const uint32_t id : image_.tasks[task].programs) {
        if (programs_.contains(id)) continue;
        const ir::Instance& block = image_.instances[id];
        const uint32_t program = programs_.at(block.parent);
        const int32_t member =
            image_.types.find_member(program_.instances[program].type, block.name);
        program_.block_tasks.push_back({program, static_cast<uint32_t>(member), task});
      }
    }
  }

  const ir::Image& image_;
  Unlinked out_;
  ir::Program& program_;
  std::vector<ir::PouId> numbers_;                   // by POU number of the image
  std::unordered_map<uint32_t, uint32_t> programs_;  // instance ID -> Program::instances
};

}  // namespace

base::Result<Unlinked> unlink(const ir::Image& image) { return Unlinker(image).run(); }

}  // namespace linker
