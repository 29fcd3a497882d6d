#include "workspace/incremental_build.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <string_view>

#include "ir/lower/lower.h"
#include "ir/program/verify.h"

namespace workspace {
namespace {

#ifdef NDEBUG
constexpr bool kVerifyEach = false;
#else
constexpr bool kVerifyEach = true;
#endif

uint32_t moved(uint32_t line, const std::vector<frontend::LineShift>& shifts) {
  int64_t by = 0;
  for (const frontend::LineShift& shift : shifts) {
    if (line >= shift.from) by = shift.by;
  }
  return static_cast<uint32_t>(line + by);
}

// Functions in front of what calls them. Of a circle nobody is inlined, and its order is the same
// to everybody.
class CalleesFirst {
 public:
  explicit CalleesFirst(const std::vector<std::vector<ir::PouId>>& callees) : callees_(callees) {}

  // One of `pous` that calls none of the others, not even through somebody.
  ir::PouId next_of(const std::set<ir::PouId>& pous) const {
    for (const ir::PouId pou : pous) {
      if (!reaches(pou, pous)) return pou;
    }
    return *pous.begin();
  }

 private:
  bool reaches(ir::PouId from, const std::set<ir::PouId>& pous) const {
    std::set<ir::PouId> seen{from};
    std::vector<ir::PouId> open{from};
    while (!open.empty()) {
      const ir::PouId pou = open.back();
      open.pop_back();
      for (const ir::PouId callee : callees_[pou.index]) {
        if (!seen.insert(callee).second) continue;
        if (pous.contains(callee)) return true;
        open.push_back(callee);
      }
    }
    return false;
  }

  const std::vector<std::vector<ir::PouId>>& callees_;
};

}  // namespace

IncrementalBuild::IncrementalBuild(Settings settings) : settings_(std::move(settings)) {}

base::Result<const ir::Image*> IncrementalBuild::build(const base::SourceMap& sources,
                                                       base::Diagnostics& diagnostics) {
  std::vector<uint32_t> all(sources.file_count());
  std::iota(all.begin(), all.end(), 0u);
  return build(sources, all, diagnostics);
}

base::Result<const ir::Image*> IncrementalBuild::build(const base::SourceMap& sources,
                                                       const std::vector<uint32_t>& saved,
                                                       base::Diagnostics& diagnostics) {
  differing_.insert(saved.begin(), saved.end());
  if (has_files_of(sources)) {
    std::vector<uint32_t> files;
    for (const uint32_t file : differing_) {
      if (sources.text(file) != sources_.text(file)) files.push_back(file);
    }
    if (follow(sources, files, diagnostics)) {
      for (const uint32_t file : files) sources_.replace(file, std::string(sources.text(file)));
      differing_.clear();
      ++counts_.edits;
      return &kept_->linked->image;
    }
  }
  return build_whole(sources, diagnostics);
}

bool IncrementalBuild::has_files_of(const base::SourceMap& sources) const {
  if (kept_ == nullptr || sources.file_count() != sources_.file_count()) return false;
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    const bool same = sources.file_name(file) == sources_.file_name(file) &&
                      sources.is_source(file) == sources_.is_source(file);
    if (!same) return false;
  }
  return true;
}

base::Result<const ir::Image*> IncrementalBuild::build_whole(const base::SourceMap& sources,
                                                             base::Diagnostics& diagnostics) {
  auto made = std::make_unique<Kept>();
  made->link = settings_.link;
  made->base = next_base_;
  if (made->base != nullptr) made->link.base = made->base.get();
  ++counts_.whole;
  const size_t before = diagnostics.error_count();
  made->program = made->frontend.compile(sources, settings_.compile, diagnostics);
  if (made->program == nullptr) {
    const size_t errors = diagnostics.error_count() - before;
    if (errors == 0) {
      return base::Error{base::Refusal::kUsage, "several RESOURCEs are not built incrementally"};
    }
    return base::Error{base::Refusal::kSourceErrors, std::to_string(errors) + " error(s)"};
  }
  if (kVerifyEach) {
    if (base::Status sound = ir::verify(*made->program); !sound.ok()) return sound.error();
  }
  base::Status optimised =
      ir::optimise(*made->program, settings_.passes, kVerifyEach, settings_.jobs);
  if (!optimised.ok()) return optimised.error();
  for (uint32_t pou = 0; pou < made->program->pous.size(); ++pou) {
    made->inlined.push_back(ir::can_be_inlined(*made->program, ir::PouId(pou)));
  }
  auto objects = ir::lower_all(*made->program, {}, settings_.jobs);
  if (!objects.ok()) return objects.error();
  made->objects = std::move(*objects);
  auto linked = linker::link_state(*made->program, made->objects, made->link);
  if (!linked.ok()) return linked.error();
  made->linked = std::move(*linked);
  kept_ = std::move(made);
  sources_ = sources;
  differing_.clear();
  return &kept_->linked->image;
}

// False: what is kept is of no use any more, or the edit is of another kind; nothing was reported.
bool IncrementalBuild::follow(const base::SourceMap& sources, const std::vector<uint32_t>& files,
                              base::Diagnostics& diagnostics) {
  base::Diagnostics messages;
  const uint64_t lowered = kept_->frontend.lowered();
  auto update = kept_->frontend.follow(sources, files, messages);
  if (!update) {
    if (!kept_->frontend.kept()) kept_.reset();
    return false;
  }
  bool done = optimise_with_callers(update->pous);
  move_lines(update->lines);
  for (const auto& constants : update->constants) move_constants(constants);
  std::vector<linker::EditedPou> pous;
  for (const ir::PouId pou : update->pous) {
    if (!done) break;
    base::Result<ir::Object> object = ir::lower(*kept_->program, pou);
    done = object.ok();
    if (!done) break;
    std::swap(kept_->objects[pou.index], *object);
    const std::string name = ir::fold_name(kept_->program->pous[pou.index].name);
    pous.push_back({kept_->linked->pou_numbers.at(name), std::move(*object)});
  }
  std::vector<linker::EditedConstants> constants;
  const uint32_t all = kept_->program->constants.size();
  for (const auto& made : update->constants) {
    const bool moves = made.end != made.new_end;
    constants.push_back({moves ? 0 : made.first, moves ? all : made.new_end});
  }
  if (done && !pous.empty()) {
    done = linker::relink(*kept_->linked, *kept_->program, pous, constants, kept_->link);
  }
  if (!done) {
    kept_.reset();
    return false;
  }
  counts_.lowered += kept_->frontend.lowered() - lowered;
  for (const base::Diagnostic& message : messages.all()) diagnostics.add(message);
  return true;
}

// Who holds the body of an edited function is made again from what it was before.
bool IncrementalBuild::optimise_with_callers(std::vector<ir::PouId>& pous) {
  ir::Program& program = *kept_->program;
  const auto is_function = [&](ir::PouId pou) {
    return program.pous[pou.index].kind == ir::PouKind::kFunction;
  };
  std::vector<std::vector<ir::PouId>> callees;
  if (std::any_of(pous.begin(), pous.end(), is_function)) callees = kept_->frontend.callees();
  std::set<ir::PouId> waiting(pous.begin(), pous.end());
  std::set<ir::PouId> done;
  while (!waiting.empty()) {
    const ir::PouId pou =
        callees.empty() ? *waiting.begin() : CalleesFirst(callees).next_of(waiting);
    waiting.erase(pou);
    done.insert(pou);
    if (!ir::optimise(program, pou, settings_.passes, kVerifyEach).ok()) return false;
    if (!is_function(pou)) continue;
    const bool was_inlined = kept_->inlined[pou.index];
    kept_->inlined[pou.index] = ir::can_be_inlined(program, pou);
    if (!was_inlined && !kept_->inlined[pou.index]) continue;
    for (uint32_t caller = 0; caller < callees.size(); ++caller) {
      const auto& called = callees[caller];
      const ir::PouId id(caller);
      if (std::find(called.begin(), called.end(), pou) == called.end()) continue;
      if (done.contains(id) || waiting.contains(id)) continue;
      if (!kept_->frontend.lower_again(id)) return false;
      waiting.insert(id);
    }
  }
  pous.assign(done.begin(), done.end());
  return true;
}

void IncrementalBuild::move_lines(const std::vector<frontend::Resident::FileLines>& files) {
  for (const frontend::Resident::FileLines& edited : files) {
    const auto is_moved = [&](const ir::LineEntry& entry) {
      return moved(entry.line, edited.shifts) != entry.line;
    };
    // Lines that stay are not touched: versions share them.
    const auto move = [&](const std::string& file, const auto& now, auto& lines) {
      if (edited.file != file || std::none_of(now.begin(), now.end(), is_moved)) return;
      for (ir::LineEntry& entry : lines) entry.line = moved(entry.line, edited.shifts);
    };
    for (ir::Object& object : kept_->objects) move(object.file, object.lines, object.lines);
    for (ir::LinkedPou& pou : kept_->linked->image.pous) move(pou.file, pou.lines, pou.lines);
  }
}

// Objects that were not made anew name theirs by number.
void IncrementalBuild::move_constants(const frontend::Resident::Constants& moved) {
  if (moved.end == moved.new_end) return;
  for (ir::Object& object : kept_->objects) {
    for (ir::ObjectConstant& constant : object.constants) {
      const bool behind = constant.value.valid() && constant.value.index >= moved.end;
      if (behind) constant.value = ir::ConstId(constant.value.index + moved.new_end - moved.end);
    }
  }
}

}  // namespace workspace
