#include "tools/stc/online_base.h"

#include <algorithm>
#include <map>
#include <utility>

#include "online_change/plan/planner.h"
#include "tools/common/change_settings.h"
#include "tools/stc/declared_places.h"
#include "tools/stc/original.h"

namespace stc {
namespace {

using base::DiagnosticCode;
using online_change::PouChange;
using online_change::PouEdit;
using online_change::TableChange;
using online_change::TableEdit;

constexpr const char* kFreeTable =
    "keep what was there and put new variables beside it, or lift the rule: --table free";
constexpr const char* kOtherTarget =
    "leave it out, or restart the controller with the new program; `stc explain online-edits` "
    "lists what each version takes";

DiagnosticCode code_of(TableChange change) {
  if (change == TableChange::kRemoved) return DiagnosticCode::kTableRemoved;
  if (change == TableChange::kOrder) return DiagnosticCode::kTableOrder;
  return DiagnosticCode::kTableSetting;
}

// What there is to say, each place once: several findings of one kind at a place are one message.
class Findings {
 public:
  explicit Findings(const Project& project) : project_(project) {}

  const DeclaredPlaces& places() {
    if (!places_) places_.emplace(project_);
    return *places_;
  }

  void add(DiagnosticCode code, base::SourceSpan span, const std::string& name,
           const std::string& what, const char* fix) {
    base::Diagnostic& row = rows_[{code, span.begin}];
    row.code = code;
    row.span = span;
    row.text += (row.text.empty() ? "`" : "; `") + name + "`: " + what;
    row.fix = fix;
  }

  void move_to(base::Diagnostics& diagnostics) {
    for (auto& [key, row] : rows_) diagnostics.add(std::move(row));
  }

 private:
  const Project& project_;
  std::optional<DeclaredPlaces> places_;
  std::map<std::pair<DiagnosticCode, base::SourcePos>, base::Diagnostic> rows_;
};

std::string type_of_program(const ir::Image& image, const std::string& instance) {
  for (const uint32_t id : image.program_ids()) {
    if (ir::same_name(image.instances[id].name, instance)) {
      return image.types->text(image.instances[id].type);
    }
  }
  return {};
}

// What is deleted is shown where it stood: after its neighbour, or at its program.
base::SourceSpan place_of(const TableEdit& edit, const ir::Image& edited,
                          const DeclaredPlaces& places) {
  const std::string& path = edit.change == TableChange::kRemoved ? edit.after : edit.path;
  const base::SourceSpan as_named = places.variable(path);
  if (edit.program.empty() || as_named.begin.valid()) return as_named;
  const std::string type = type_of_program(edited, edit.program);
  const size_t within = std::min(path.size(), edit.program.size());
  const base::SourceSpan found = places.variable(type + path.substr(within));
  return found.begin.valid() ? found : places.unit(type);
}

void add_table(const ir::Image& original, const ir::Image& edited, Findings& findings) {
  for (const TableEdit& edit :
       online_change::table_edits(original, edited, online_change::TableSide::kBefore)) {
    findings.add(code_of(edit.change), place_of(edit, edited, findings.places()), edit.path,
                 edit.what, kFreeTable);
  }
}

void add_units(const ir::Image& original, const ir::Image& edited, bool restricted,
               Findings& findings) {
  for (const PouEdit& edit : online_change::pou_edits(original, edited)) {
    if (edit.change == PouChange::kAdded) {
      findings.add(DiagnosticCode::kUnitAdded, findings.places().unit(edit.pou), edit.pou,
                   "the running program does not have it", "");
    } else if (edit.change == PouChange::kRemoved) {
      findings.add(DiagnosticCode::kUnitRemoved, {}, edit.pou, "it is deleted", "");
    } else if (edit.change == PouChange::kInterface) {
      findings.add(
          restricted ? DiagnosticCode::kOnlineInterface : DiagnosticCode::kInterfaceEdited,
          findings.places().unit(edit.pou), edit.pou, edit.what,
          restricted ? "keep it, and add a unit beside it; or leave out --restricted" : "");
    }
  }
}

void add_limits(const online_change::OnlineLimits& limits, const ir::Image& original,
                const ir::Image& edited, Findings& findings) {
  if (limits.refused == 0) return;
  for (const auto& edit : online_change::online_edits(original, edited)) {
    if (limits.takes(edit.kind)) continue;
    const DeclaredPlaces& places = findings.places();
    const base::SourceSpan unit = places.unit(edit.name);
    findings.add(DiagnosticCode::kOnlineLimit,
                 unit.begin.valid() ? unit : places.variable(edit.name), edit.name,
                 online_change::edit_kind_name(edit.kind), kOtherTarget);
  }
}

// The number after the magic.
uint32_t format_of(const base::Bytes& image) {
  base::ByteReader in(image);
  (void)in.raw(ir::kImageMagic.size());
  return in.u32();
}

void add_format(const online_change::ChosenLimits& chosen, const base::Bytes& image,
                Findings& findings) {
  const uint32_t format = format_of(image);
  const online_change::OnlineLimits& limits = chosen.limits;
  if (format >= limits.first_format && format <= limits.last_format) return;
  findings.add(DiagnosticCode::kOnlineLimit, {}, "format " + std::to_string(format),
               "limits are " + chosen.text + ", which reads formats of images from " +
                   std::to_string(limits.first_format) + " to " +
                   std::to_string(limits.last_format),
               kOtherTarget);
}

void add_plan(const ir::Image& original, const ir::Image& edited, Findings& findings) {
  const base::Result<online_change::Plan> plan = online_change::plan(original, edited);
  if (plan.ok()) return;
  const base::Error& error = plan.error();
  findings.add(DiagnosticCode::kOnlineLimit, {}, base::refusal_code(error.refusal), error.text,
               base::refusal_help(error.refusal));
}

}  // namespace

std::string placed_table_edits(const std::vector<TableEdit>& edits, const ir::Image& edited,
                               const Project& project) {
  const DeclaredPlaces places(project);
  std::vector<TableEdit> placed = edits;
  for (TableEdit& edit : placed) {
    const base::SourceLocation at = project.sources.locate(place_of(edit, edited, places).begin);
    if (at.line == 0) continue;
    edit.what += " (" + std::string(at.file) + ":" + std::to_string(at.line) + ":" +
                 std::to_string(at.column) + ")";
  }
  return online_change::table_edits_text(placed);
}

base::Result<std::optional<OnlineBase>> OnlineBase::of(const tools::Options& options) {
  if (!options.has("--online-base")) {
    for (const char* option : {"--target", "--table", "--restricted"}) {
      if (!options.has(option)) continue;
      return base::Error{base::Refusal::kUsage,
                         std::string(option) + " says how an edit is checked: give --online-base"};
    }
    return std::optional<OnlineBase>();
  }
  base::Result<Version> original = open_original(options, options.text("--online-base"));
  if (!original.ok()) return original.error();
  const std::vector<std::string>& paths = options.arguments();
  base::Result<tools::ChangeSettings> settings =
      tools::change_settings(paths.empty() ? std::vector<std::string>{"."} : paths);
  if (!settings.ok()) return settings.error();
  OnlineBase out;
  out.original_ = std::move(*original);
  out.free_table_ = options.text("--table") == "free";
  out.restricted_ = settings->restricted || options.has("--restricted");
  out.limits_ =
      online_change::chosen_limits(online_change::online_limits(), target_versions(options));
  return std::optional<OnlineBase>(std::move(out));
}

void OnlineBase::check(const Project& project, const ir::Image& edited,
                       base::Diagnostics& diagnostics) const {
  Findings findings(project);
  if (!free_table_) add_table(original(), edited, findings);
  add_units(original(), edited, restricted_, findings);
  add_limits(limits_.limits, original(), edited, findings);
  findings.move_to(diagnostics);
  diagnostics.add(DiagnosticCode::kOnlineLimits, {}, "limits are " + limits_.text);
}

void OnlineBase::check(const Project& project, const Version& edited,
                       base::Diagnostics& diagnostics) const {
  check(project, edited.image, diagnostics);
  Findings findings(project);
  add_format(limits_, edited.bytes, findings);
  add_plan(original(), edited.image, findings);
  findings.move_to(diagnostics);
}

const ResourceVersion& OnlineBase::matching(const std::vector<ResourceVersion>& versions) const {
  // "plant.Line": the project may have another name by now.
  const std::string& name = original().name;
  const std::string resource = name.substr(name.rfind('.') + 1);
  const auto found = std::find_if(versions.begin(), versions.end(), [&](const auto& row) {
    return ir::same_name(row.resource, resource);
  });
  return found == versions.end() ? versions.front() : *found;
}

}  // namespace stc
