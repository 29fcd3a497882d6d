#include "linker/merge_pous.h"

#include <algorithm>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "base/name_case.h"
#include "ir/program/overrides.h"

namespace linker {
namespace {

using ir::PartKind;

// One POU in the three programs.
struct Versions {
  std::optional<uint32_t> original;  // number of the image
  std::optional<uint32_t> edited;
  std::optional<uint32_t> target;
};
enum class Source : uint8_t { kTarget, kEdited, kNone };

// Objects of a program by folded name.
std::unordered_map<std::string, size_t> objects_by_name(const Unlinked& from) {
  std::unordered_map<std::string, size_t> numbers;
  for (size_t i = 0; i < from.objects.size(); ++i) {
    numbers.emplace(ir::fold_name(from.objects[i].name), i);
  }
  return numbers;
}

class PouMerger {
 public:
  PouMerger(const MergeInput& input, const PartChoice& choice, const Unlinked& edited,
            const Unlinked& target, MergedRows& rows)
      : input_(input), choice_(choice), edited_(edited), target_(target), rows_(rows) {
    original_parts_ = ir::parts_of(input.original, units());
    edited_parts_ = ir::parts_of(input.edited);
    target_parts_ = ir::parts_of(input.target, units());
  }

  base::Result<MergedPous> run() {
    collect();
    choose();
    add_all();
    if (!problems_.empty()) return base::Error{base::Refusal::kCannotRelink, problems_};
    add_overrides();
    add_migrations();
    if (!problems_.empty()) return base::Error{base::Refusal::kCannotRelink, problems_};
    return std::move(out_);
  }

 private:
  const ir::UnitMembers& units() const { return input_.edited.unit_members; }

  static base::Digest unit_of(const std::vector<ir::Part>& parts, const std::string& name) {
    const ir::Part* const part = ir::find_part(parts, PartKind::kUnit, name);
    return part == nullptr ? base::Digest{} : part->identity;
  }

  void refuse(const std::string& text) { problems_ += (problems_.empty() ? "" : "; ") + text; }

  void collect() {
    const auto add = [this](const ir::Image& image, std::optional<uint32_t> Versions::*which) {
      for (uint32_t i = 0; i < image.pous.size(); ++i) {
        const std::string& name = image.pous[i].name;
        if (name.empty()) continue;
        const auto [found, added] = number_of_.try_emplace(ir::fold_name(name), pous_.size());
        if (added) pous_.emplace_back();
        pous_[found->second].*which = i;
      }
    };
    // Versions of the target come first, so their order stays.
    add(input_.target, &Versions::target);
    add(input_.edited, &Versions::edited);
    add(input_.original, &Versions::original);
  }

  // --- where each comes from ------------------------------------------------------

  void choose() {
    for (const Versions& pou : pous_) {
      const bool of_edit = pou.edited || pou.original;
      const std::string unit = name_of_unit(pou);
      sources_.push_back(!of_edit       ? stays(pou, unit)
                         : unit.empty() ? choose_made(pou)
                                        : choose_written(pou, unit));
    }
  }

  std::string name_of_unit(const Versions& pou) const {
    if (pou.target) return ir::unit_name(input_.target, *pou.target, units());
    if (pou.edited) return ir::unit_name(input_.edited, *pou.edited);
    return ir::unit_name(input_.original, *pou.original, units());
  }

  static base::Digest digest_of(const ir::Image& image, std::optional<uint32_t> pou) {
    return pou ? image.pous[*pou].identity : base::Digest{};
  }

  Source choose_written(const Versions& pou, const std::string& unit) {
    if (choice_.takes(PartKind::kUnit, unit)) return pou.edited ? comes(pou) : Source::kNone;
    if (choice_.drops(PartKind::kUnit, unit)) return Source::kNone;
    const bool follows =
        digest_of(input_.original, pou.original) != digest_of(input_.edited, pou.edited);
    const base::Digest here = unit_of(target_parts_, unit);
    const bool known = here != base::Digest{} && here == unit_of(edited_parts_, unit);
    if (follows && known && pou.edited) return comes(pou);
    if (!pou.target) return Source::kNone;
    // What the edit does not concern is as it was made for both.
    const bool same_as_before = here == unit_of(original_parts_, unit);
    return known && same_as_before ? Source::kTarget : stays(pou, unit);
  }

  // Code that the compiler has made goes by what it is.
  Source choose_made(const Versions& pou) {
    const base::Digest original = digest_of(input_.original, pou.original);
    const base::Digest edited = digest_of(input_.edited, pou.edited);
    const base::Digest here = digest_of(input_.target, pou.target);
    if (original == edited || here == edited) return pou.target ? Source::kTarget : Source::kNone;
    if (here == original) return pou.edited ? Source::kEdited : Source::kNone;
    refuse("`" + name_of(pou) + "`, which the compiler makes of the whole program (initial values" +
           ", FB_Init, FB_Exit), is another one here, and the edit changes it");
    return pou.target ? Source::kTarget : Source::kNone;
  }

  std::string name_of(const Versions& pou) const {
    if (pou.target) return input_.target.pous[*pou.target].name;
    if (pou.edited) return input_.edited.pous[*pou.edited].name;
    return input_.original.pous[*pou.original].name;
  }

  // A unit of the target's own, whose code was made without the edit.
  Source stays(const Versions& pou, const std::string& unit) {
    if (unit.empty()) {
      check_made(input_.target.pous[*pou.target].name);
    } else {
      check_held(input_.target, *pou.target,
                 [this](PartKind kind, const auto& name) { return is_edited(kind, name); });
      check_generic(*pou.target);
    }
    return Source::kTarget;
  }

  // `F(LREAL)`, which only the target needs, is the same source as `F(INT)` that the edit brings.
  void check_generic(uint32_t pou) {
    const std::string& name = input_.target.pous[pou].name;
    const size_t bracket = name.find('(');
    if (bracket == std::string::npos || input_.target.contents.empty()) return;
    const auto sources = [&](const ir::Image& image) {
      std::vector<base::Digest> out;
      for (size_t i = 0; i < image.contents.size(); ++i) {
        const std::string& other = image.pous[i].name;
        const bool same = other.find('(') == bracket &&
                          ir::same_name(other.substr(0, bracket), name.substr(0, bracket));
        if (same) out.push_back(image.contents[i].identity);
      }
      return out;
    };
    std::vector<base::Digest> known = sources(input_.original);
    known.push_back(input_.target.contents[pou].identity);
    for (const base::Digest& source : sources(input_.edited)) {
      if (std::ranges::find(known, source) != known.end()) continue;
      refuse("the code of `" + name + "` was made of another `" + name.substr(0, bracket) + "`");
      return;
    }
  }
  bool is_edited(PartKind kind, const std::string& name) const {
    return choice_.takes(kind, name) || choice_.drops(kind, name);
  }

  // `Pump.__RESET`, which only the target needs: for instances that are made anew at each call. It
  // gives initial values, and calls FB_Init, of the block, of its bases and of what is in them.
  void check_made(const std::string& made) {
    constexpr std::string_view kReset = ".__RESET";
    if (!made.ends_with(kReset)) return;
    const ir::TypeTable& types = input_.target.types;
    const std::string owner = made.substr(0, made.size() - kReset.size());
    std::vector<ir::TypeId> open;
    for (uint32_t i = ir::kElementaryCount; i < types.size(); ++i) {
      if (ir::same_name(types[ir::TypeId(i)].name, owner)) open.push_back(ir::TypeId(i));
    }
    std::unordered_set<uint32_t> seen;
    while (!open.empty()) {
      const ir::TypeId id = open.back();
      open.pop_back();
      if (!seen.insert(id.index).second) continue;
      const ir::Type& type = types[id];
      const bool block = type.kind == ir::Kind::kFunctionBlock;
      if (block && is_edited(PartKind::kUnit, type.name)) {
        refuse("an instance of `" + owner + "` is made anew at each call here, with what `" +
               type.name + "` was before the edit");
      }
      if ((block || type.kind == ir::Kind::kArray) && type.base.valid()) open.push_back(type.base);
      if (!block && type.kind != ir::Kind::kStruct) continue;
      for (const ir::Member& member : type.members) open.push_back(member.type);
    }
  }

  // A unit that the edit brings, whose code was made without what the target has of its own.
  Source comes(const Versions& pou) {
    check_held(input_.edited, *pou.edited, [this](PartKind kind, const auto& name) {
      if (choice_.takes(kind, name)) return false;
      const ir::Part* const made_for = ir::find_part(edited_parts_, kind, name);
      const ir::Part* const here = ir::find_part(target_parts_, kind, name);
      return made_for == nullptr || here == nullptr || made_for->identity != here->identity;
    });
    return Source::kEdited;
  }

  // Does its code hold something that is another one in the merged program?
  template <class IsOther>
  void check_held(const ir::Image& image, uint32_t pou, const IsOther& is_other) {
    constexpr PartKind kKinds[] = {PartKind::kUnit, PartKind::kGlobal, PartKind::kType};
    const auto first =
        std::lower_bound(image.held.begin(), image.held.end(), pou,
                         [](const ir::HeldPart& row, uint32_t number) { return row.pou < number; });
    for (auto row = first; row != image.held.end() && row->pou == pou; ++row) {
      const PartKind kind = kKinds[static_cast<size_t>(row->what.kind)];
      const std::string& name =
          kind == PartKind::kUnit ? ir::unit_of(units(), row->what.name) : row->what.name;
      if (!is_other(kind, name)) continue;
      refuse("the code of `" + image.pous[pou].name + "` was made with another " +
             std::string(ir::part_kind_name(kind)) + " `" + name + "`");
    }
  }

  // --- POUs and objects -------------------------------------------------------------

  void add_all() {
    const auto in_edited = objects_by_name(edited_);
    const auto in_target = objects_by_name(target_);
    ir::Program& merged = *rows_.merged;
    struct Added {
      bool edited;
      const ir::Object* object;
    };
    std::vector<Added> added;
    for (size_t i = 0; i < pous_.size(); ++i) {
      if (sources_[i] == Source::kNone) continue;
      const bool edited = sources_[i] == Source::kEdited;
      const Unlinked& from = edited ? edited_ : target_;
      const size_t number = (edited ? in_edited : in_target).at(ir::fold_name(name_of(pous_[i])));
      // Objects and POUs of what was taken apart have one order.
      Translator& translator = edited ? *rows_.from_edited : *rows_.from_target;
      translator.forget_problem();
      merged.pous.push_back(pou_of(from.program.pous[number], translator));
      if (!translator.problem().empty()) refuse(uses(merged.pous.back().name, translator));
      added.push_back({edited, &from.objects[number]});
    }
    const Parameters there{merged, ir::pou_names(merged)};
    const Parameters of_edited{edited_.program, ir::pou_names(edited_.program)};
    const Parameters of_target{target_.program, ir::pou_names(target_.program)};
    for (const Added& row : added) {
      Translator& translator = row.edited ? *rows_.from_edited : *rows_.from_target;
      translator.forget_problem();
      out_.objects.push_back(
          translator.object(*row.object, row.edited ? of_edited : of_target, there));
      if (!translator.problem().empty()) refuse(uses(row.object->name, translator));
      if (row.object->fixed) note(*row.object, row.edited ? out_.from_edited : out_.from_target);
    }
  }

  static void note(const ir::Object& object, FixedPous& fixed) {
    if (fixed.offsets.empty()) fixed.offsets = object.name;
    for (size_t i = 0; i < object.code.size() && fixed.sizes.empty();) {
      const ir::Opcode op = object.code[i].opcode();
      if (op == ir::Opcode::SIZE_OF) fixed.sizes = object.name;
      i += ir::opcode_row(op).extended ? 2 : 1;
    }
  }

  static std::string uses(const std::string& pou, const Translator& translator) {
    return "`" + pou + "` uses " + translator.problem();
  }

  static ir::Pou pou_of(const ir::Pou& from, Translator& translator) {
    ir::Pou pou = from;
    pou.self = translator.type(from.self);
    for (ir::Local& local : pou.locals) local.type = translator.type(local.type);
    for (ir::ChartMove& move : pou.chart) {
      for (std::vector<uint32_t>* const steps : {&move.from, &move.to}) {
        for (uint32_t& step : *steps) step = translator.member(from.self, step).value_or(step);
        std::sort(steps->begin(), steps->end());
      }
    }
    pou.taken_in.clear();  // by name, in the object
    return pou;
  }

  // --- methods that stand for others, and migrations ----------------------------------

  std::optional<ir::PouId> merged_pou(const ir::Program& from, ir::PouId pou,
                                      const ir::PouNames& names) const {
    const auto found = names.find(ir::fold_name(from.pous[pou.index].name));
    if (found == names.end()) return std::nullopt;
    return found->second;
  }

  void add_overrides() {
    const ir::PouNames names = ir::pou_names(*rows_.merged);
    std::set<ir::PouId> prototypes;
    for (const Unlinked* const from : {&target_, &edited_}) {
      for (const ir::Override& row : from->program.overrides) {
        if (const auto pou = merged_pou(from->program, row.prototype, names)) {
          prototypes.insert(*pou);
        }
      }
    }
    rows_.merged->overrides = ir::find_overrides(*rows_.merged, std::move(prototypes));
  }

  void add_migrations() {
    const ir::PouNames names = ir::pou_names(*rows_.merged);
    std::set<std::pair<uint32_t, bool>> known;
    for (const Unlinked* const from : {&edited_, &target_}) {
      Translator& translator = from == &edited_ ? *rows_.from_edited : *rows_.from_target;
      for (const ir::Migration& row : from->program.migrations) {
        const auto pou = merged_pou(from->program, row.function, names);
        if (!pou || !known.emplace(pou->index, row.inverse).second) continue;
        translator.forget_problem();
        ir::Migration merged = row;
        merged.function = *pou;
        merged.type = translator.type(row.type);
        rows_.merged->migrations.push_back(std::move(merged));
        if (!translator.problem().empty())
          refuse(uses(rows_.merged->pous[pou->index].name, translator));
      }
    }
  }

  const MergeInput& input_;
  const PartChoice& choice_;
  const Unlinked& edited_;
  const Unlinked& target_;
  MergedRows& rows_;
  MergedPous out_;
  std::vector<ir::Part> original_parts_;
  std::vector<ir::Part> edited_parts_;
  std::vector<ir::Part> target_parts_;
  std::vector<Versions> pous_;
  std::vector<Source> sources_;                        // as pous_
  std::unordered_map<std::string, size_t> number_of_;  // by folded name, in pous_
  std::string problems_;
};

}  // namespace

base::Result<MergedPous> merge_pous(const MergeInput& input, const PartChoice& choice,
                                    const Unlinked& edited, const Unlinked& target,
                                    MergedRows& rows) {
  return PouMerger(input, choice, edited, target, rows).run();
}

}  // namespace linker
