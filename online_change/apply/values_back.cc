#include "online_change/apply/values_back.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "ir/bytecode/name_index.h"
#include "ir/bytecode/symbols.h"
#include "online_change/apply/plan_edit.h"
#include "online_change/diff/areas.h"

namespace online_change {
namespace {

// What the way back of an edit does to the values of the version before, by their place there.
class WayBack {
 public:
  explicit WayBack(const TakenEdit& edit) : edit_(edit) {
    const std::vector<Piece>& pieces = edit.way_back.pieces();
    for (uint32_t number = 0; number < pieces.size(); ++number) {
      const Piece& piece = pieces[number];
      if (piece.kind == StepKind::kInitialise) add_anew(number);
      if (piece.kind != StepKind::kConvert) continue;
      for (uint32_t i = 0; i < piece.count; ++i) {
        const uint32_t to = piece.to + i * piece.to_stride;
        places_.push_back({to, to + piece.size, number, i});
      }
    }
    std::sort(places_.begin(), places_.end(),
              [](const Place& a, const Place& b) { return a.begin < b.begin; });
  }

  struct Value {
    const uint8_t* before = nullptr;
    bool converted = false;
    uint32_t from = 0;              // converted: in the version that the edit made
    const uint8_t* made = nullptr;  // what it was there; null: the same as before
    uint32_t made_size = 0;
  };
  std::optional<Value> at(uint32_t begin, uint32_t size) const {
    auto found = std::upper_bound(places_.begin(), places_.end(), begin,
                                  [](uint32_t at, const Place& one) { return at < one.begin; });
    if (found == places_.begin()) return std::nullopt;
    const Place& place = *--found;
    if (uint64_t{begin} + size > place.end) return std::nullopt;
    const Piece& piece = edit_.way_back.pieces()[place.piece];
    Value out;
    out.before =
        edit_.way_back.remembered(piece) + size_t{place.index} * piece.size + (begin - place.begin);
    if (piece.kind == StepKind::kInitialise) return out;
    out.converted = true;
    out.from = piece.from + place.index * piece.from_stride;
    out.made_size = edit_.way_back.source_size(piece);
    out.made = edit_.forward.converted(out.from, out.made_size);
    return out;
  }

 private:
  struct Place {
    uint32_t begin = 0;
    uint32_t end = 0;
    uint32_t piece = 0;
    uint32_t index = 0;
  };
  // A value may begin in one part of a step and end in the next.
  void add_anew(uint32_t number) {
    const Piece& piece = edit_.way_back.pieces()[number];
    if (!places_.empty() && places_.back().end == piece.to) {
      const Piece& first = edit_.way_back.pieces()[places_.back().piece];
      const bool goes_on =
          first.kind == StepKind::kInitialise && first.at + (piece.to - first.to) == piece.at;
      if (goes_on) {
        places_.back().end += piece.total();
        return;
      }
    }
    places_.push_back({piece.to, piece.to + piece.total(), number, 0});
  }

  const TakenEdit& edit_;
  std::vector<Place> places_;
};

// What has come of what the edit made at `offset`, in the version that runs; nullopt: a later edit
// knows no such variable, or another one.
std::optional<ir::Symbol> still_there(const TakenEdit& edit,
                                      const std::vector<ir::NamesOnDemand>& names,
                                      const Areas& made, uint32_t offset) {
  const std::optional<Node> leaf = made.leaf_at(offset);
  if (!leaf || leaf->begin != offset) return std::nullopt;
  const std::string path = made.path_at(offset);
  std::optional<ir::Symbol> now;
  for (size_t i = 0; i < names.size(); ++i) {
    const ir::Image* const image = edit.later[i];
    const base::Result<ir::Symbol> found = ir::find_symbol(names[i].of(*image), path);
    const bool same = found.ok() && found->bit_mask == 0 &&
                      ir::same_value_type(edit.after.types, edit.after.layouts, leaf->type,
                                          image->types, image->layouts, found->type);
    if (!same) return std::nullopt;
    now = *found;
  }
  return now;
}

}  // namespace

uint64_t put_values_back(Plan& plan, const ir::Image& next, const TakenEdit& edit) {
  const WayBack way_back(edit);
  const Areas made(edit.after);
  PlanEdit changed(plan, *edit.later.back(), next);
  const ir::NamesOnDemand names;
  const std::vector<ir::NamesOnDemand> later_names(edit.later.size());
  ir::for_each_leaf(edit.before, [&](const std::string& path, const ir::Symbol& there) {
    const uint32_t size = edit.before.layouts[there.type].size;
    const std::optional<WayBack::Value> value = way_back.at(there.data, size);
    if (!value || there.bit_mask != 0) return;
    if (ir::is_reference(edit.before.types[there.type].kind)) return;
    const base::Result<ir::Symbol> here = ir::find_symbol(names.of(next), path);
    if (!here.ok() || here->bit_mask != 0) return;
    if (!ir::same_value_type(edit.before.types, edit.before.layouts, there.type, next.types,
                             next.layouts, here->type)) {
      return;
    }
    if (!value->converted) {
      changed.initialise(here->data, {value->before, size});
    } else if (value->made != nullptr) {
      const std::optional<ir::Symbol> now = still_there(edit, later_names, made, value->from);
      if (now) changed.convert(*now, path, *here, {value->made, value->made_size}, value->before);
    }
  });
  return changed.finish();
}

}  // namespace online_change
