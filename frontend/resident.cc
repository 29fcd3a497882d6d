#include "frontend/resident.h"

#include <algorithm>
#include <utility>

#include "frontend/resident_parts.h"

namespace frontend {
namespace {

std::vector<ir::PouId> prototypes_of(const ir::Pou& pou) {
  std::vector<ir::PouId> found;
  for (const ir::Block& block : pou.blocks) {
    for (const ir::Inst& inst : block.insts) {
      if (inst.op == ir::Op::kCallVirtual) found.push_back(inst.pou);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

bool same_writes(const std::vector<OutputWrite>& a, const std::vector<OutputWrite>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.address == y.address && x.type == y.type;
  });
}

// Members of the globals that the POU names are those below this number.
uint32_t globals_below(const ir::Pou& pou) {
  uint32_t below = 0;
  for (const ir::Place& place : pou.places) {
    if (place.base != ir::PlaceBase::kGlobal || place.steps.empty()) continue;
    below = std::max(below, place.steps[0].index + 1);
  }
  return below;
}

// Constants that a body may have more than before an edit.
constexpr uint32_t kSpare = 256;

// `{IF` asks what is declared anywhere, before anything is parsed.
bool has_condition(std::string_view text) {
  for (size_t at = 0; (at = text.find('{', at)) != std::string_view::npos;) {
    at = text.find_first_not_of(" \t\r\n", at + 1);
    if (at == std::string_view::npos) return false;
    if (ir::same_name(text.substr(at, 2), "if")) return true;
  }
  return false;
}

}  // namespace

Resident::Resident() = default;
Resident::~Resident() = default;

ir::Program* Resident::compile(const base::SourceMap& sources, const CompileOptions& options,
                               base::Diagnostics& diagnostics) {
  followable_ = false;
  sema_.reset();
  options_ = options;
  diagnostics_ = base::Diagnostics();
  parsed_ = parse_project(sources, options_, LibraryExtent::kWhole, diagnostics_);
  if (parsed_ != nullptr) {
    const auto& configs = parsed_->tree.configs;
    const bool several = configs.size() == 1 && configs[0].resources.size() > 1;
    if (several && !diagnostics_.has_errors()) return nullptr;
    sema_ = std::make_unique<Sema>(parsed_->sources, parsed_->tree, parsed_->library_file, options_,
                                   options_.tests ? Purpose::kTest : Purpose::kRun, diagnostics_);
    declare_all(*sema_);
    lower_all_bodies();
    check_whole(*sema_);
  }
  for (const base::Diagnostic& message : diagnostics_.all()) diagnostics.add(message);
  if (diagnostics_.has_errors()) return nullptr;
  followable_ = can_follow();
  if (followable_) note_files();
  return &sema_->program;
}

const std::vector<TestCase>& Resident::test_cases() const { return sema_->tests.cases; }

bool Resident::can_follow() const {
  const size_t found = diagnostics_.warning_count() + diagnostics_.note_count();
  if (diagnostics_.all().size() != found) return false;  // too many to keep
  if (!sema_->program.migrations.empty()) return false;
  // A body that names `x.pvalue` makes another interface of its function.
  for (const PouInfo& info : sema_->declared.pous) {
    if (info.library || info.decl == nullptr || info.decl->kind != PouKind::kFunction) continue;
    const bool any = std::ranges::any_of(info.variables, [&](VarId id) {
      const Variable& variable = sema_->declared.variables[id.index];
      if (variable.section != VarSection::kInput || variable.decl == nullptr) return false;
      const Spec& spec = parsed_->tree[variable.decl->spec];
      return spec.kind == SpecKind::kNamed && ir::same_name(spec.name.text.substr(0, 3), "ANY");
    });
    if (any && sema_->options.dialect != Dialect::kIec) return false;
  }
  // A body that leaves out a bare address may unshare its place.
  if (sema_->addresses.direct_shares) return false;
  const base::SourceMap& sources = parsed_->sources;
  for (uint32_t file = 0; file < parsed_->library_file; ++file) {
    if (!sources.is_source(file) || has_condition(sources.text(file))) return false;
  }
  return true;
}

Resident::Sizes Resident::sizes() const {
  const ir::Program& program = sema_->program;
  return {program.types.size(), static_cast<uint32_t>(sema_->declared.variables.size()),
          static_cast<uint32_t>(sema_->declared.pous.size()),
          static_cast<uint32_t>(program.types[program.globals].members.size()),
          static_cast<uint32_t>(sema_->addresses.direct_uses.size())};
}

// Lowers a body, where nothing of it is left from before.
void Resident::run_body(uint32_t pou, uint32_t next_type, BodyRecord& record) {
  Sema& sema = *sema_;
  ir::ConstTable& constants = sema.program.constants;
  record.before = sizes();
  sema.program.types.expect_in_turn(next_type);
  record.first_constant = constants.next();
  BodyLog log;
  sema.log = &log;
  lower_body(sema, pou);
  sema.log = nullptr;
  ++lowered_;
  const PouInfo& info = sema.declared.pous[pou];
  record.behind = sizes();
  record.end_constant = constants.next();
  record.other_lines = log.other_lines;
  record.marks = std::move(log.marks);
  std::sort(record.marks.begin(), record.marks.end());
  record.marks.erase(std::unique(record.marks.begin(), record.marks.end()), record.marks.end());
  record.callees = info.callees;
  record.writes = info.writes;
  record.prototypes = prototypes_of(sema.program.pous[info.id.index]);
  record.for_others = called_for_others(sema.program.pous[info.id.index]);
}

void Resident::lower_all_bodies() {
  Sema& sema = *sema_;
  bodies_.clear();
  heads_.clear();
  std::vector<uint8_t> declared;  // what declarations mark
  for (const Variable& variable : sema.declared.variables) {
    declared.push_back(variable.used);
    declared.push_back(variable.written);
  }
  before_ = diagnostics_.all();
  for (uint32_t pou = 0; pou < sema.declared.pous.size(); ++pou) {
    BodyRecord& record = bodies_.emplace_back();
    const ir::PouId id = sema.declared.pous[pou].id;
    if (!id.valid()) continue;
    if (heads_.size() <= id.index) {
      heads_.resize(id.index + 1);
      number_of_.resize(id.index + 1);
    }
    heads_[id.index] = sema.program.pous[id.index];
    number_of_[id.index] = pou;
    const size_t messages = diagnostics_.all().size();
    run_body(pou, sema.program.types.size(), record);
    record.in_turn = sema.program.types.came_in_turn(sema.program.types.size());
    record.messages.assign(diagnostics_.all().begin() + static_cast<ptrdiff_t>(messages),
                           diagnostics_.all().end());
  }
  marks_.assign(2 * sema.declared.variables.size(), 0);
  std::copy(declared.begin(), declared.end(), marks_.begin());
  for (const BodyRecord& record : bodies_) {
    for (const uint32_t mark : record.marks) ++marks_[mark];
  }
  for (size_t i = 0; i < sema.declared.variables.size(); ++i) {  // of those that came with a body
    if (sema.declared.variables[i].used && marks_[2 * i] == 0) marks_[2 * i] = 1;
    if (sema.declared.variables[i].written && marks_[2 * i + 1] == 0) marks_[2 * i + 1] = 1;
  }
}

// Would the body have given everything else the same numbers, had it been so from the start?
bool Resident::is_alike(const BodyRecord& old, const BodyRecord& now, uint32_t pou) const {
  const ir::Program& program = sema_->program;
  if (now.behind != now.before || !program.types.came_in_turn(old.behind.types)) return false;
  if (!now.marks.empty() && now.marks.back() >= 2 * old.before.variables) return false;
  const auto known = [&](uint32_t callee) { return callee < old.before.pous; };
  if (!std::all_of(now.callees.begin(), now.callees.end(), known)) return false;
  const ir::Pou& code = program.pous[sema_->declared.pous[pou].id.index];
  if (globals_below(code) > old.before.globals) return false;
  if (now.prototypes != old.prototypes || !same_writes(now.writes, old.writes)) return false;
  if (now.callees == old.callees) return true;
  // A program that somebody calls does not run by itself.
  const auto is_program = [&](uint32_t callee) {
    return sema_->declared.pous[callee].decl->kind == PouKind::kProgram;
  };
  return std::none_of(now.callees.begin(), now.callees.end(), is_program) &&
         std::none_of(old.callees.begin(), old.callees.end(), is_program);
}

// Leaves the record of the body, with the numbers that it has in the whole.
bool Resident::lower_anew(uint32_t pou, Undo& undo) {
  Sema& sema = *sema_;
  BodyRecord& old = bodies_[pou];
  PouInfo& info = sema.declared.pous[pou];
  Sizes with_types = old.before;
  with_types.types = old.behind.types;
  if (with_types != old.behind || !old.in_turn || !info.outer_uses.empty()) return false;
  ir::Program& program = sema.program;
  Undo::Code& was = undo.codes.emplace_back();
  was.pou = pou;
  was.record = old;
  was.code = std::move(program.pous[info.id.index]);
  was.constants = constants_between(old.first_constant, old.end_constant);
  // A body with more constants writes over those of others first.
  const uint32_t size = program.constants.size();
  const Values others =
      constants_between(old.end_constant, std::min(size, old.end_constant + kSpare));
  program.pous[info.id.index] = heads_[info.id.index];
  program.constants.set_next(old.first_constant);
  sema.report.forget();
  info.callees.clear();
  info.writes.clear();
  diagnostics_ = base::Diagnostics();
  BodyRecord now;
  run_body(pou, old.before.types, now);
  Values made = constants_between(now.first_constant, now.end_constant);
  set_constants(old.end_constant, others, size);
  const bool all_spared = others.size() < kSpare || now.end_constant <= old.end_constant + kSpare;
  undo.complete = undo.complete && all_spared;
  count_marks(old.marks, false);
  count_marks(now.marks, true);
  bool alike = !diagnostics_.has_errors() && info.outer_uses.empty() && is_alike(old, now, pou);
  alike =
      alike && undo.complete && (now.end_constant == old.end_constant || may_move_constants(pou));
  if (!alike) now.end_constant = old.end_constant;
  uses_changed_ = uses_changed_ || now.marks != old.marks || now.callees != old.callees ||
                  now.for_others != old.for_others;
  now.before = old.before;
  now.behind = old.behind;
  now.in_turn = true;
  now.messages = diagnostics_.all();
  const uint32_t new_end = std::exchange(now.end_constant, old.end_constant);
  old = std::move(now);
  if (alike && new_end != old.end_constant) replace_constants(pou, std::move(made));
  return alike;
}

// The program, and what is known of it, as before these edits.
void Resident::undo_edits(Undo& undo) {
  ir::Program& program = sema_->program;
  for (auto code = undo.codes.rbegin(); code != undo.codes.rend(); ++code) {
    PouInfo& info = sema_->declared.pous[code->pou];
    BodyRecord& record = bodies_[code->pou];
    count_marks(record.marks, false);
    count_marks(code->record.marks, true);
    replace_constants(code->pou, std::move(code->constants));
    record = std::move(code->record);
    info.callees = record.callees;
    info.writes = record.writes;
    info.outer_uses.clear();
    program.pous[info.id.index] = std::move(code->code);
  }
  for (const Undo::Statements& was : undo.statements) {
    was.pou->body = was.body;
    was.pou->code = was.code;
    was.pou->content = was.content;
  }
  for (auto& [number, file] : undo.files) files_[number] = std::move(file);
  set_pieces();
  behind_ = std::move(undo.behind);
}

void Resident::count_marks(const std::vector<uint32_t>& marks, bool more) {
  if (marks_.size() < 2 * sema_->declared.variables.size())
    marks_.resize(2 * sema_->declared.variables.size());
  for (const uint32_t mark : marks) {
    marks_[mark] += more ? 1u : ~0u;
    Variable& variable = sema_->declared.variables[mark / 2];
    (mark % 2 == 0 ? variable.used : variable.written) = marks_[mark] != 0;
  }
}

bool Resident::lower_again(ir::PouId id) {
  Sema& sema = *sema_;
  const BodyRecord& record = bodies_[number_of_[id.index]];
  PouInfo& info = sema.declared.pous[number_of_[id.index]];
  ir::Program& program = sema.program;
  program.pous[id.index] = heads_[id.index];
  program.constants.set_next(record.first_constant);
  diagnostics_ = base::Diagnostics();
  BodyRecord now;
  run_body(info.number, 0, now);
  info.callees = record.callees;
  info.writes = record.writes;
  const bool same = now.behind == now.before && now.end_constant == record.end_constant;
  program.constants.set_next(program.constants.size());
  diagnostics_ = base::Diagnostics();
  followable_ = followable_ && same;
  return same;
}

std::vector<std::vector<ir::PouId>> Resident::callees() const {
  std::vector<std::vector<ir::PouId>> out(sema_->program.pous.size());
  for (uint32_t pou = 0; pou < bodies_.size(); ++pou) {
    if (!sema_->declared.pous[pou].id.valid()) continue;
    for (const uint32_t callee : bodies_[pou].callees) {
      const ir::PouId id = sema_->declared.pous[callee].id;
      if (id.valid()) out[sema_->declared.pous[pou].id.index].push_back(id);
    }
  }
  return out;
}

}  // namespace frontend
