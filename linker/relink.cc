#include "linker/relink.h"

#include <algorithm>
#include <ranges>

#include "linker/call_graph.h"
#include "linker/held.h"
#include "linker/relocate.h"
#include "linker/tables.h"
#include "linker/type_numbers.h"

namespace linker {
namespace {

class Relinker {
 public:
  Relinker(LinkState& state, const ir::Program& program, const Options& options)
      : state_(state),
        program_(program),
        options_(options),
        context_{program,
                 state.image,
                 state.pool,
                 std::move(state.pou_numbers),
                 std::move(state.objects),
                 std::move(state.parameter_offsets),
                 std::move(state.table_numbers)} {}
  ~Relinker() {
    state_.pou_numbers = std::move(context_.pou_numbers);
    state_.objects = std::move(context_.objects);
    state_.parameter_offsets = std::move(context_.parameter_offsets);
    state_.table_numbers = std::move(context_.table_numbers);
  }
  Relinker(const Relinker&) = delete;
  Relinker& operator=(const Relinker&) = delete;

  bool run(const std::vector<EditedPou>& edited) {
    std::vector<uint32_t> pous;
    bool same_tables = true;
    bool same_constants = true;
    bool same_stack = true;
    for (const EditedPou& pou : edited) {
      if (!is_known(pou.number)) return false;
      const ir::Object& object = *context_.objects[pou.number];
      pous.push_back(pou.number);
      same_tables = same_tables && same_tables_of(pou.before, object);
      same_constants = same_constants && has_constants(pou.before, object);
      same_stack = same_stack && same_calls(pou.before, object);
    }
    if (!same_tables && !fill_tables_again()) return false;
    if (!same_constants) make_pool_again(pous);
    std::vector<LinkedCode> codes;
    for (const uint32_t pou : pous) {
      base::Result<LinkedCode> linked = relocate(context_, *context_.objects[pou]);
      if (!linked.ok()) return false;
      linked->pou.identity = known_identity(*context_.objects[pou], program_, state_.names);
      same_stack = same_stack && linked->pou.frame_size == state_.image.pous[pou].frame_size;
      codes.push_back(std::move(*linked));
    }
    put_in(pous, codes);
    if (!state_.image.contents.empty()) put_contents(pous);
    if (state_.image.code.size() > options_.max_code_units) return false;
    return same_stack || measure_stack();
  }

 private:
  // As before, seen from outside?
  bool is_known(uint32_t number) const {
    const ir::Object& object = *context_.objects[number];
    const ir::LinkedPou& linked = state_.image.pous[number];
    if (object.name != linked.name || object.kind != linked.kind || object.self != linked.self) {
      return false;
    }
    const ir::PouId pou = state_.names.at(ir::fold_name(object.name));
    if (!has_chart(number, program_.pous[pou.index].chart)) return false;
    for (const std::string& callee : object.callees) {
      if (!context_.pou_numbers.contains(ir::fold_name(callee))) return false;
    }
    const base::Result<FrameLayout> frame = lay_out_frame(object, state_.image.layouts, {});
    if (!frame.ok()) return false;
    const std::vector<uint64_t>& known = context_.parameter_offsets[number];
    for (size_t slot = 0; slot < object.slots.size(); ++slot) {
      if (object.slots[slot].kind != ir::SlotKind::kParam) break;
      if (slot >= known.size() || known[slot] != frame->offsets[slot]) return false;
    }
    return true;
  }

  bool has_chart(uint32_t number, const std::vector<ir::ChartMove>& moves) const {
    const std::vector<ir::LinkedChart>& charts = state_.image.charts;
    const auto chart =
        std::lower_bound(charts.begin(), charts.end(), number,
                         [](const ir::LinkedChart& row, uint32_t pou) { return row.pou < pou; });
    if (chart == charts.end() || chart->pou != number) return moves.empty();
    return chart->moves == moves;
  }

  static bool same_tables_of(const ir::Object& a, const ir::Object& b) {
    const auto same = [](const ir::Bound& x, const ir::Bound& y) {
      return x.array == y.array && x.dim == y.dim && x.name == y.name;
    };
    return a.ranges == b.ranges &&
           std::equal(a.bounds.begin(), a.bounds.end(), b.bounds.begin(), b.bounds.end(), same);
  }

  // Has the object the same constants, one after the other, as the pool has for what it was before?
  bool has_constants(const ir::Object& before, const ir::Object& object) const {
    const InitialValues initial(program_.types, program_.constants, state_.image.layouts);
    if (before.constants.size() != object.constants.size()) return false;
    for (uint32_t i = 0; i < object.constants.size(); ++i) {
      const ir::ObjectConstant& now = object.constants[i];
      const ir::ObjectConstant& old = before.constants[i];
      if (now.type != old.type || (!now.type.valid() && now.bytes != old.bytes)) return false;
      if (!now.type.valid()) continue;
      base::Bytes bytes(state_.image.layouts[now.type].size, 0);
      initial.write_value(now.type, now.value, bytes);
      const base::Bytes& pool = state_.pool.bytes();
      const uint32_t at = state_.pool.offset(object, i);
      const bool inside = at <= pool.size() && bytes.size() <= pool.size() - at;
      if (!inside || !std::equal(bytes.begin(), bytes.end(), pool.begin() + at)) return false;
    }
    return true;
  }

  // Entries that live on must keep their numbers; POUs that were not edited name them.
  bool fill_tables_again() {
    const std::unordered_map<std::string, uint32_t> old = std::move(context_.table_numbers);
    context_.table_numbers.clear();
    state_.image.bounds.clear();
    state_.image.ranges.clear();
    const TypeNumbers types(program_.types, base_of(options_));
    fill_tables(context_, base_of(options_), types);
    return std::all_of(context_.table_numbers.begin(), context_.table_numbers.end(),
                       [&](const auto& entry) {
                         const auto found = old.find(entry.first);
                         return found == old.end() || found->second == entry.second;
                       });
  }

  // POUs whose constants have other places now are linked again, too.
  void make_pool_again(std::vector<uint32_t>& pous) {
    const InitialValues initial(program_.types, program_.constants, state_.image.layouts);
    ConstantPool pool = make_pool(context_.objects, initial, state_.image.layouts,
                                  base_of(options_) == nullptr ? nullptr : &options_.base->pool);
    const std::vector<uint32_t> edited = pous;
    for (uint32_t number = 0; number < context_.objects.size(); ++number) {
      const ir::Object* object = context_.objects[number];
      if (object == nullptr || state_.pool.same_offsets(pool, *object)) continue;
      if (std::binary_search(edited.begin(), edited.end(), number)) continue;
      pous.push_back(number);
    }
    std::sort(pous.begin(), pous.end());
    state_.pool = std::move(pool);
    state_.image.pool = state_.pool.bytes();
  }

  void put_contents(const std::vector<uint32_t>& pous) {
    std::vector<const ir::Object*> objects(context_.objects.size());
    for (const uint32_t pou : pous) {
      objects[pou] = context_.objects[pou];
      state_.image.contents[pou].identity = objects[pou]->content.identity;
    }
    const auto is_edited = [&](const ir::HeldPart& row) { return objects[row.pou] != nullptr; };
    const std::vector<ir::HeldPart> added = held_parts(objects, state_.held);
    const bool same = std::ranges::equal(
        added, state_.image.held.all() | std::views::filter(is_edited));
    if (same) return;  // the table stays one with that of the version before
    std::vector<ir::HeldPart>& rows = state_.image.held.own();
    std::erase_if(rows, is_edited);
    rows.insert(rows.end(), added.begin(), added.end());
    std::sort(rows.begin(), rows.end());
  }

  void put_in(const std::vector<uint32_t>& numbers, std::vector<LinkedCode>& codes) {
    // Each moves what is after it; many are better put together anew.
    constexpr size_t kMany = 8;
    if (numbers.size() > kMany) return put_together(numbers, codes);
    for (size_t i = 0; i < numbers.size(); ++i) exchange(numbers[i], std::move(codes[i]));
  }

  void exchange(uint32_t number, LinkedCode linked) {
    std::vector<ir::LinkedPou>& pous = state_.image.pous;
    std::vector<ir::Unit>& code = state_.image.code;
    const uint32_t first = pous[number].first_unit;
    const uint32_t old_count = pous[number].unit_count;
    const uint32_t count = linked.pou.unit_count;
    const auto behind = code.begin() + first + old_count;
    if (count > old_count) {
      code.insert(behind, count - old_count, ir::Unit());
    } else {
      code.erase(code.begin() + first + count, behind);
    }
    std::copy(linked.code.begin(), linked.code.end(), code.begin() + first);
    linked.pou.first_unit = first;
    pous[number] = std::move(linked.pou);
    for (uint32_t i = number + 1; i < pous.size(); ++i) pous[i].first_unit += count - old_count;
  }

  void put_together(const std::vector<uint32_t>& numbers, std::vector<LinkedCode>& codes) {
    ir::Image& image = state_.image;
    std::vector<ir::Unit> made;
    made.reserve(image.code.size());
    size_t next = 0;
    for (uint32_t number = 0; number < image.pous.size(); ++number) {
      const auto first = static_cast<uint32_t>(made.size());
      if (next < numbers.size() && numbers[next] == number) {
        made.insert(made.end(), codes[next].code.begin(), codes[next].code.end());
        image.pous[number] = std::move(codes[next++].pou);
      } else {
        const auto old = image.code.begin() + image.pous[number].first_unit;
        made.insert(made.end(), old, old + image.pous[number].unit_count);
      }
      image.pous[number].first_unit = first;
    }
    image.code = std::move(made);
  }

  bool measure_stack() {
    const base::Result<StackNeeds> needs = stack_needs(state_.image, context_.objects);
    if (!needs.ok()) return false;
    state_.image.stack_bytes = needs->bytes;
    state_.image.call_depth = needs->depth;
    return true;
  }

  LinkState& state_;
  const ir::Program& program_;
  const Options& options_;
  LinkContext context_;
};

bool same_constant(const ir::ConstValue& a, const ir::ConstValue& b) {
  return a.bits == b.bits && a.text == b.text &&
         std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(), b.elements.end(),
                    [](const ir::ConstElement& x, const ir::ConstElement& y) {
                      return x.first == y.first && x.count == y.count && x.value == y.value;
                    });
}

// Without a difference the table stays one with that of the version before.
void copy_constants(LinkState& state, const ir::Program& program, EditedConstants range) {
  const base::Shared<ir::ConstTable>& known = state.image.constants;
  while (range.first < range.end && same_constant(known[ir::ConstId(range.first)],
                                                  program.constants[ir::ConstId(range.first)])) {
    ++range.first;
  }
  if (range.first == range.end) return;
  ir::ConstTable& constants = state.image.constants.own();
  constants.set_next(range.first);
  for (uint32_t i = range.first; i < range.end; ++i) {
    constants.add(program.constants[ir::ConstId(i)]);
  }
  constants.set_next(constants.size());
}

}  // namespace

bool relink(LinkState& state, const ir::Program& program, std::vector<EditedPou>& pous,
            std::span<const EditedConstants> constants, const Options& options) {
  if (!state.own_types) return false;
  if (state.image.constants.size() != program.constants.size()) {
    state.image.constants = program.constants;
  } else {
    for (const EditedConstants& range : constants) copy_constants(state, program, range);
  }
  std::sort(pous.begin(), pous.end(),
            [](const EditedPou& a, const EditedPou& b) { return a.number < b.number; });
  return Relinker(state, program, options).run(pous);
}

}  // namespace linker
