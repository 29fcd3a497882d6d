#include "linker/relink.h"

#include <algorithm>

#include "linker/call_graph.h"
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

  bool run(std::vector<uint32_t> pous) {
    std::sort(pous.begin(), pous.end());
    for (const uint32_t pou : pous) {
      if (!is_known(pou)) return false;
    }
    if (!fill_tables_again()) return false;
    add_moved_constants(pous);
    std::vector<LinkedCode> codes;
    for (const uint32_t pou : pous) {
      base::Result<LinkedCode> linked = relocate(context_, *context_.objects[pou]);
      if (!linked.ok()) return false;
      linked->pou.identity = ir::identity(*context_.objects[pou], program_, state_.names);
      codes.push_back(std::move(*linked));
    }
    put_in(pous, codes);
    return state_.image.code.size() <= options_.max_code_units && measure_stack();
  }

 private:
  // As before, seen from outside?
  bool is_known(uint32_t number) const {
    const ir::Object& object = *context_.objects[number];
    const ir::LinkedPou& linked = state_.image.pous[number];
    if (object.name != linked.name || object.kind != linked.kind || object.self != linked.self) {
      return false;
    }
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

  // Entries that live on must keep their numbers; POUs that were not edited name them.
  bool fill_tables_again() {
    const std::unordered_map<std::string, uint32_t> old = std::move(context_.table_numbers);
    context_.table_numbers.clear();
    state_.image.bounds.clear();
    state_.image.ranges.clear();
    const TypeNumbers types(program_.types, options_.base);
    fill_tables(context_, options_.base, types);
    return std::all_of(context_.table_numbers.begin(), context_.table_numbers.end(),
                       [&](const auto& entry) {
                         const auto found = old.find(entry.first);
                         return found == old.end() || found->second == entry.second;
                       });
  }

  // POUs whose constants have other places now are linked again, too.
  void add_moved_constants(std::vector<uint32_t>& pous) {
    const InitialValues initial(program_.types, program_.constants, state_.image.layouts);
    ConstantPool pool =
        make_pool(context_.objects, initial, state_.image.layouts,
                  options_.base == nullptr ? nullptr : &options_.base->pool);
    const size_t edited = pous.size();
    for (uint32_t number = 0; number < context_.objects.size(); ++number) {
      const ir::Object* object = context_.objects[number];
      if (object == nullptr || state_.pool.same_offsets(pool, *object)) continue;
      if (!std::binary_search(pous.begin(), pous.begin() + static_cast<ptrdiff_t>(edited), number)) {
        pous.push_back(number);
      }
    }
    std::sort(pous.begin(), pous.end());
    state_.pool = std::move(pool);
    state_.image.pool = state_.pool.bytes();
  }

  void put_in(const std::vector<uint32_t>& numbers, std::vector<LinkedCode>& codes) {
    ir::Image& image = state_.image;
    std::vector<ir::Unit>& code = image.code;
    const bool same_sizes = std::equal(
        numbers.begin(), numbers.end(), codes.begin(), [&](uint32_t number, const auto& linked) {
          return image.pous[number].unit_count == linked.pou.unit_count;
        });
    if (same_sizes) {
      for (size_t i = 0; i < numbers.size(); ++i) {
        codes[i].pou.first_unit = image.pous[numbers[i]].first_unit;
        std::copy(codes[i].code.begin(), codes[i].code.end(),
                  code.begin() + codes[i].pou.first_unit);
        image.pous[numbers[i]] = std::move(codes[i].pou);
      }
      return;
    }
    std::vector<ir::Unit> made;
    made.reserve(code.size() + code.size() / 8);
    size_t next = 0;
    for (uint32_t number = 0; number < image.pous.size(); ++number) {
      const bool edited = next < numbers.size() && numbers[next] == number;
      const ir::LinkedPou& old = image.pous[number];
      const auto first = static_cast<uint32_t>(made.size());
      if (edited) {
        made.insert(made.end(), codes[next].code.begin(), codes[next].code.end());
        image.pous[number] = std::move(codes[next++].pou);
      } else {
        made.insert(made.end(), code.begin() + old.first_unit,
                    code.begin() + old.first_unit + old.unit_count);
      }
      image.pous[number].first_unit = first;
    }
    code = std::move(made);
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

}  // namespace

bool relink(LinkState& state, const ir::Program& program, std::span<const uint32_t> pous,
            const Options& options) {
  if (!state.own_types) return false;
  state.image.constants = program.constants;
  return Relinker(state, program, options).run({pous.begin(), pous.end()});
}

}  // namespace linker
