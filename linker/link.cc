#include "linker/link.h"

#include <algorithm>
#include <unordered_set>

#include "base/limits.h"
#include "base/parallel.h"
#include "ir/bytecode/renames.h"
#include "ir/bytecode/symbols.h"
#include "linker/areas.h"
#include "linker/call_graph.h"
#include "linker/data.h"
#include "linker/given_addresses.h"
#include "linker/held.h"
#include "linker/instances.h"
#include "linker/relink.h"
#include "linker/relocate.h"
#include "linker/tables.h"
#include "linker/type_numbers.h"

namespace linker {
namespace {

constexpr size_t kBatch = 16;  // POUs that a thread takes at a time

constexpr int64_t kEventWatchdogNs = 100'000'000;     // of a task without a period
constexpr int64_t kStartWatchdogNs = 10'000'000'000;  // of a task that runs once

class Linker {
 public:
  Linker(const ir::Program& program, const std::vector<ir::Object>& objects, const Options& options)
      : program_(program),
        objects_(objects),
        options_(options),
        context_{program, image_, pool_, {}, {}, {}, {}} {
    options_.base = base_of(options);
    if (options_.base == nullptr) return;
    renamed_base_ = ir::under_new_names(*options_.base, program);
    if (renamed_base_) options_.base = &*renamed_base_;
  }

  base::Result<LinkState> run() {
    base::Status (Linker::*const steps[])() = {
        &Linker::lay_out_types,  &Linker::number_pous,     &Linker::place_instances,
        &Linker::fill_pool,      &Linker::link_code,       &Linker::link_tasks,
        &Linker::link_overrides, &Linker::link_migrations, &Linker::link_charts,
        &Linker::link_contents,  &Linker::measure_stack,
    };
    copy_declarations();
    for (const auto step : steps) {
      if (base::Status status = (this->*step)(); !status.ok()) return status.error();
    }
    fill_data_tables(image_, nodes_);
    if (base::Status status = bind_located(); !status.ok()) return status.error();
    type_numbers_->apply(image_);
    return LinkState{std::move(image_),
                     std::move(pool_),
                     std::move(context_.objects),
                     std::move(context_.pou_numbers),
                     std::move(context_.parameter_offsets),
                     std::move(context_.table_numbers),
                     std::move(names_),
                     std::move(held_),
                     type_numbers_->are_own() && !renamed_base_};
  }

 private:
  void copy_declarations() {
    image_.name = program_.name;
    image_.types = program_.types;
    image_.constants = program_.constants;
    image_.globals = program_.globals;
  }

  base::Status lay_out_types() {
    base::Result<ir::Layouts> layouts = lay_out(program_.types, options_.slack, options_.base);
    if (!layouts.ok()) return layouts.error();
    image_.layouts = std::move(layouts).value();
    return base::Ok{};
  }

  // A POU keeps its number while it lives; new ones take those of dead ones first.
  base::Status number_pous() {
    std::unordered_map<std::string, uint32_t> old_numbers;
    size_t count = 0;
    if (options_.base != nullptr) {
      count = options_.base->pous.size();
      for (uint32_t i = 0; i < count; ++i) {
        old_numbers.emplace(ir::fold_name(options_.base->pous[i].name), i);
      }
    }
    context_.objects.assign(count, nullptr);
    std::vector<const ir::Object*> added;
    for (const ir::Object& object : objects_) {
      const auto old = old_numbers.find(ir::fold_name(object.name));
      if (old == old_numbers.end()) {
        added.push_back(&object);
      } else {
        context_.objects[old->second] = &object;
      }
    }
    size_t next = 0;
    for (const ir::Object* object : added) {
      while (next < context_.objects.size() && context_.objects[next] != nullptr) ++next;
      if (next == context_.objects.size()) context_.objects.push_back(nullptr);
      context_.objects[next] = object;
    }
    while (!context_.objects.empty() && context_.objects.back() == nullptr) {
      context_.objects.pop_back();
    }
    return name_pous();
  }

  base::Status name_pous() {
    if (context_.objects.size() > base::kMaxPous) {
      return base::Error{base::Refusal::kTooMany, std::to_string(context_.objects.size()) +
                                                      " POUs; the limit is " +
                                                      std::to_string(base::kMaxPous)};
    }
    for (uint32_t i = 0; i < context_.objects.size(); ++i) {
      const ir::Object* object = context_.objects[i];
      if (object == nullptr) continue;
      context_.pou_numbers.emplace(ir::fold_name(object->name), i);
      if (ir::is_body(object->kind)) pou_of_type_.emplace(object->self.index, i);
    }
    for (const ir::Object& object : objects_) {
      for (const std::string& callee : object.callees) {
        if (context_.pou_numbers.contains(ir::fold_name(callee))) continue;
        return base::Error{base::Refusal::kUndefinedSymbol,
                           "`" + object.name + "` calls `" + callee + "`, which is not defined."};
      }
    }
    return base::Ok{};
  }

  base::Status place_instances() {
    base::Result<std::vector<InstanceNode>> nodes =
        walk_instances(program_, image_.layouts, options_.max_instances);
    if (!nodes.ok()) return nodes.error();
    nodes_ = std::move(nodes).value();
    base::Result<std::vector<ir::Instance>> rows =
        number_instances(program_, nodes_, options_.base, options_.max_instances);
    if (!rows.ok()) return rows.error();
    image_.instances = std::move(rows).value();
    for (size_t i = 0; i < program_.instances.size(); ++i) {
      image_.instances[nodes_[i + 1].id].old_name = program_.instances[i].old_name;
    }
    for (size_t i = 1; i < nodes_.size(); ++i) {
      const auto pou = pou_of_type_.find(nodes_[i].type.index);
      if (pou == pou_of_type_.end()) {
        return base::Error{base::Refusal::kUndefinedSymbol,
                           "`" + program_.types[nodes_[i].type].name +
                               "` has instances but no body: its object is missing."};
      }
      image_.instances[nodes_[i].id].pou = pou->second;
    }
    base::Result<AreaPlan> areas =
        place_areas(image_, options_.slack, options_.base, options_.move_all);
    if (!areas.ok()) return areas.error();
    image_.free = std::move(areas->free);
    image_.data_capacity = areas->data_capacity;
    return base::Ok{};
  }

  base::Status fill_pool() {
    const InitialValues initial(image_.types, image_.constants, image_.layouts);
    pool_ = make_pool(context_.objects, initial, image_.layouts,
                      options_.base == nullptr ? nullptr : &options_.base->pool);
    image_.pool = pool_.bytes();
    if (image_.pool.size() > ir::kConstPoolLimit) {
      return base::Error{base::Refusal::kTooLarge,
                         "the constants need " + std::to_string(image_.pool.size()) +
                             " bytes; the limit is " + std::to_string(ir::kConstPoolLimit)};
    }
    return base::Ok{};
  }

  base::Status link_code() {
    type_numbers_.emplace(program_.types, options_.base);
    fill_tables(context_, options_.base, *type_numbers_);
    if (base::Status status = lay_out_parameters(); !status.ok()) return status;
    names_ = ir::pou_names(program_);
    std::vector<base::Result<LinkedCode>> codes(context_.objects.size(), LinkedCode{});
    base::for_each_index(codes.size(), options_.jobs, kBatch, [&](size_t i) {
      const ir::Object* object = context_.objects[i];
      codes[i] = object == nullptr ? unused_pou() : relocate(context_, *object);
      if (object == nullptr || !codes[i].ok()) return;
      codes[i]->pou.identity = known_identity(*object, program_, names_);
    });
    for (base::Result<LinkedCode>& linked : codes) {
      if (!linked.ok()) return linked.error();
      add_pou(std::move(linked).value());
      if (image_.code.size() <= options_.max_code_units) continue;
      return base::Error{base::Refusal::kTooMany, "more than " +
                                                      std::to_string(options_.max_code_units) +
                                                      " instructions; `" + image_.pous.back().name +
                                                      "` is one POU too many"};
    }
    return base::Ok{};
  }

  base::Status lay_out_parameters() {
    const size_t count = context_.objects.size();
    context_.parameter_offsets.resize(count);
    std::vector<std::optional<base::Error>> errors(count);
    base::for_each_index(count, options_.jobs, kBatch, [&](size_t i) {
      if (context_.objects[i] == nullptr) return;
      base::Result<FrameLayout> frame = lay_out_frame(*context_.objects[i], image_.layouts, {});
      if (frame.ok()) {
        context_.parameter_offsets[i] = std::move(frame->offsets);
      } else {
        errors[i] = frame.error();
      }
    });
    for (std::optional<base::Error>& error : errors) {
      if (error) return std::move(*error);
    }
    return base::Ok{};
  }

  // Keeps the numbers after a removed POU: a function that nobody calls.
  static LinkedCode unused_pou() {
    LinkedCode unused;
    unused.code.push_back(ir::Unit::make(ir::Opcode::RET));
    unused.pou.unit_count = 1;
    return unused;
  }

  void add_pou(LinkedCode linked) {
    linked.pou.first_unit = static_cast<uint32_t>(image_.code.size());
    image_.code.insert(image_.code.end(), linked.code.begin(), linked.code.end());
    image_.pous.push_back(std::move(linked.pou));
  }

  base::Status link_tasks() {
    for (const ir::Task& task : program_.tasks) {
      const int64_t watchdog = task.watchdog_ns != 0             ? task.watchdog_ns
                               : task.period_ns > INT64_MAX / 10 ? INT64_MAX
                                                                 : task.period_ns * 10;
      image_.tasks.push_back({task.name,
                              task.period_ns,
                              watchdog != 0                           ? watchdog
                              : task.once || task.policy.freewheeling ? kStartWatchdogNs
                                                                      : kEventWatchdogNs,
                              task.priority,
                              event_of(task),
                              {},
                              task.once,
                              task.policy});
    }
    for (size_t i = 0; i < program_.instances.size(); ++i) {
      const ir::ProgramInstance& instance = program_.instances[i];
      if (instance.task == ir::kNoTask) continue;
      if (instance.task >= image_.tasks.size()) {
        return base::Error{base::Refusal::kUndefinedSymbol,
                           "program `" + instance.name + "` has no task"};
      }
      image_.tasks[instance.task].programs.push_back(nodes_[i + 1].id);
    }
    for (const ir::BlockTask& block : program_.block_tasks) {
      image_.tasks[block.task].programs.push_back(block_id(block));
    }
    return base::Ok{};
  }

  base::Status link_overrides() {
    for (const ir::Override& row : program_.overrides) {
      const auto number = [&](ir::PouId pou) {
        return context_.pou_numbers.find(ir::fold_name(program_.pous[pou.index].name));
      };
      const auto prototype = number(row.prototype);
      const auto target = number(row.target);
      if (prototype == context_.pou_numbers.end() || target == context_.pou_numbers.end()) {
        return base::Error{
            base::Refusal::kUndefinedSymbol,
            "`" + program_.types[row.type].name + "` overrides a method whose object is missing."};
      }
      image_.overrides.push_back({row.type, prototype->second, target->second});
    }
    std::sort(image_.overrides.begin(), image_.overrides.end(), [](const auto& a, const auto& b) {
      return std::pair(a.type.index, a.prototype) < std::pair(b.type.index, b.prototype);
    });
    return base::Ok{};
  }

  base::Status link_migrations() {
    for (const ir::Migration& row : program_.migrations) {
      const std::string& name = program_.pous[row.function.index].name;
      const auto pou = context_.pou_numbers.find(ir::fold_name(name));
      if (pou == context_.pou_numbers.end()) {
        return base::Error{base::Refusal::kUndefinedSymbol,
                           "migration `" + name + "`: its object is missing."};
      }
      image_.migrations.push_back(
          {row.type, pou->second, row.inverse, !row.from.empty(), row.from, row.values});
    }
    return base::Ok{};
  }

  base::Status link_contents() {
    const auto of = [](const ir::Object* object) {
      return object == nullptr ? ir::PouContent{} : ir::PouContent{object->content.identity};
    };
    for (const ir::Object* object : context_.objects) image_.contents.push_back(of(object));
    const auto is_known = [](const ir::PouContent& content) { return content != ir::PouContent{}; };
    if (std::ranges::none_of(image_.contents, is_known)) image_.contents.clear();
    if (!image_.contents.empty()) {
      held_ = HeldNames(program_);
      image_.held = held_parts(context_.objects, held_);
    }
    return base::Ok{};
  }

  base::Status link_charts() {
    for (const ir::Pou& pou : program_.pous) {
      const auto number = context_.pou_numbers.find(ir::fold_name(pou.name));
      if (pou.chart.empty() || number == context_.pou_numbers.end()) continue;
      image_.charts.push_back({number->second, pou.chart});
    }
    std::sort(image_.charts.begin(), image_.charts.end(),
              [](const auto& a, const auto& b) { return a.pou < b.pou; });
    return base::Ok{};
  }

  uint32_t event_of(const ir::Task& task) const {
    if (task.event == ir::kNoEvent) return 0;
    return image_.instances[0].data + image_.layouts[program_.globals].member_offsets[task.event];
  }

  // The instance in variable `member` of a program.
  uint32_t block_id(const ir::BlockTask& block) const {
    const uint32_t program = block.program + 1;
    const uint32_t slot = image_.layouts[nodes_[program].type].member_offsets[block.member];
    for (const InstanceNode& node : nodes_) {
      if (!node.program && node.parent == program && node.slot_offset == slot) return node.id;
    }
    return 0;
  }

  // Addresses that VAR_CONFIG gives to variables of single instances, and those that nobody gives.
  base::Status bind_located() {
    for (const ir::LocatedPath& located : program_.located) {
      const base::Result<ir::Symbol> symbol = ir::find_symbol(image_, located.path);
      if (!symbol.ok()) return symbol.error();
      bind_address(image_, located.address, symbol->data, symbol->type);
    }
    if (base::Status given = give_addresses(image_, nodes_, options_.base); !given.ok()) {
      return given;
    }
    if (base::Status sized = size_process_image(image_); !sized.ok()) return sized;
    if (base::Status placed = place_devices(image_, options_.devices); !placed.ok()) return placed;
    image_.safe = options_.safe;
    image_.unit_members = options_.unit_members;
    image_.access = program_.access;
    image_.shared = program_.shared;
    image_.schedule = program_.schedule;
    return base::Ok{};
  }

  base::Status measure_stack() {
    const base::Result<StackNeeds> needs = stack_needs(image_, context_.objects);
    if (!needs.ok()) return needs.error();
    image_.stack_bytes = needs->bytes;
    image_.call_depth = needs->depth;
    return base::Ok{};
  }

  const ir::Program& program_;
  const std::vector<ir::Object>& objects_;
  Options options_;
  std::optional<ir::Image> renamed_base_;
  std::optional<TypeNumbers> type_numbers_;
  ir::Image image_;
  ConstantPool pool_;
  LinkContext context_;
  ir::PouNames names_;
  HeldNames held_;
  std::unordered_map<uint32_t, uint32_t> pou_of_type_;
  std::vector<InstanceNode> nodes_;
};

}  // namespace

base::Result<LinkState> link_state(const ir::Program& program,
                                   const std::vector<ir::Object>& objects, const Options& options) {
  return Linker(program, objects, options).run();
}

base::Result<ir::Image> link(const ir::Program& program, const std::vector<ir::Object>& objects,
                             const Options& options) {
  base::Result<LinkState> linked = link_state(program, objects, options);
  if (!linked.ok()) return linked.error();
  return std::move(linked->image);
}

}  // namespace linker
