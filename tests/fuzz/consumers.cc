#include "tests/fuzz/consumers.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/identities.h"
#include "ir/bytecode/name_index.h"
#include "ir/bytecode/renames.h"
#include "ir/bytecode/symbols.h"
#include "linker/merge.h"
#include "linker/unlink.h"
#include "online_change/plan/online_limits.h"
#include "online_change/plan/pou_edits.h"
#include "online_change/plan/system_edits.h"
#include "online_change/plan/table_edits.h"
#include "online_change/plan/type_edits.h"
#include "tests/fuzz/answered.h"
#include "tools/common/all_system_edits.h"
#include "tools/common/fate_report.h"
#include "tools/common/fleet_parts.h"
#include "tools/common/json.h"
#include "tools/common/source_edits.h"
#include "tools/stc/addresses_text.h"
#include "tools/stc/image_text.h"
#include "tools/stc/package_text.h"
#include "tools/stc/parts_text.h"
#include "tools/stvm/fleet_diff.h"
#include "vm/native/make_function.h"
#include "vm/runtime/memory_report.h"
#include "vm/runtime/shared_globals.h"

namespace fuzz {
namespace {

using namespace online_change;

// A look into the table of names gives what a walk over the image does.
void find_by_both(const ir::NameIndex& names, const std::string& path) {
  const base::Result<ir::Symbol> walked = ir::find_symbol(names.image(), path);
  const base::Result<ir::Symbol> looked = ir::find_symbol(names, path);
  base::check(walked.ok() == looked.ok(), "a name is there for both");
  if (!walked.ok()) return base::check(walked.error().text == looked.error().text, "one reason");
  base::check(ir::same_place(*walked, *looked) && walked->type == looked->type &&
                  walked->constant == looked->constant,
              "a name is one variable for both");
}

void read_values(const ir::Image& image) {
  const ir::NameIndex names(image);
  std::vector<uint8_t> memory(image.data_capacity);
  for (const ir::DataRun& run : image.data) {
    std::copy(run.bytes.begin(), run.bytes.end(), memory.begin() + run.offset);
  }
  base::check(ir::state_text(image, memory).size() != 1, "lines of values");
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    const base::Result<ir::Symbol> found = ir::find_symbol(image, path);
    find_by_both(names, path);
    find_by_both(names, path.substr(0, path.rfind('.')));
    if (answered(found)) ir::path_of(image, *found);
    ir::format_value(image, symbol, memory);
    if (const auto value = ir::parse_value(image, symbol.type, "1"); !value.ok()) {
      must_say_why(value.error());
    }
  });
}

// What a controller asks before it takes a change, and what tools ask before they bring one.
void compare_tables(const ir::Image& from, const ir::Image& to) {
  for (const TableSide side : {TableSide::kBefore, TableSide::kOwn}) {
    const auto edits = table_edits(from, to, side);
    base::check(edits.empty() || !table_edits_text(edits).empty(), "edits as text");
    answered(check_table(edits, "the table that runs"));
  }
  for (const OnlineEdit& edit : online_edits(from, to)) {
    base::check(edit_kind_name(edit.kind) != nullptr, "a kind has a name");
  }
  answered(check_own_limits(from, to));
  answered(check_limits(online_limits().front(), from, to));
  const auto parts = linker::merge_parts({from, to, from});
  tools::part_edits_text(parts, false);
  tools::part_edits_text(parts, true);
  const stvm::FleetDifference difference = stvm::fleet_difference(from, to);
  base::check(!stvm::difference_text(difference).empty(), "a difference as text");
  tools::JsonWriter json;
  json.begin_object();
  stvm::difference_json(difference, json);
  json.end_object();
}

bool has_unique_pous(const ir::Image& image) {
  std::set<std::string> names;
  return std::ranges::all_of(image.pous, [&](const ir::LinkedPou& pou) {
    return pou.name.empty() || names.insert(ir::fold_name(pou.name)).second;
  });
}

void compare_texts(const ir::VerifiedImage& from, const ir::VerifiedImage& to,
                   const Package& package) {
  const auto edits = pou_edits(from.image(), to.image());
  const EncodedImage before{from.image(), from.encoded()};
  const EncodedImage after{to.image(), to.encoded()};
  const bool same = pou_edits(before, after).size() == edits.size();
  const bool unique = has_unique_pous(from.image()) && has_unique_pous(to.image());
  base::check(same || !unique, "the same edits of POUs");
  for (const TypeEdit& edit : type_edits(before, after)) {
    base::check(!edit.type.empty(), "a type has a name");
  }
  answered(check_restricted(edits));
  auto system = tools::all_system_edits(from, to);
  tools::all_system_edits(from, to, true);
  for (auto& edit : tools::source_edits(from.encoded(), to.encoded())) {
    system.push_back(std::move(edit));
  }
  const Plan& plan = package.forward;
  base::check(!tools::fate_report(plan, {}, edits, system).empty(), "a report");
  const auto lines = tools::every_line(plan, from.image(), to.image());
  tools::every_fate_text(lines);
  tools::JsonWriter json;
  json.begin_object();
  tools::fate_report(plan, {}, edits, system, json);
  tools::every_fate(lines, json);
  json.end_object();
  base::check(!stc::package_text(package, from.image(), to.image()).empty(), "a package as text");
}

}  // namespace

void read_image(const ir::VerifiedImage& verified) {
  const ir::Image& image = verified.image();
  for (const ir::LinkedPou& pou : image.pous) ir::disassemble(image, pou);
  base::check(!stc::image_text(image, verified.digest()).empty(), "tables as text");
  stc::symbols_text(image);
  stc::addresses_text(image);
  stc::layout_text(image);
  base::check(!stc::parts_text(image).empty(), "parts as text");
  vm::memory_report(image);
  const vm::SharedGlobals shared(image);
  for (uint32_t id = 0; id < image.instances.size(); ++id) image.instance_path(id);
  if (const auto sources = ir::sources_of(verified.encoded()); answered(sources)) {
    const auto texts = ir::unpack_sources(*sources);
    base::check(!answered(texts) || texts->size() == sources->files.size(), "a text of each");
  }
  if (can_run(verified)) read_values(image);
}

void compare_images(const ir::VerifiedImage& from, const ir::VerifiedImage& to) {
  ir::under_new_names(from.image(), to.image());
  const base::Result<Package> package = make_package(from.encoded(), to.encoded());
  if (!answered(package)) return;
  compare_tables(from.image(), to.image());
  compare_texts(from, to, *package);
  answered(check_package(*package, from.image(), to.image()));
  answered(decode(encode(*package)));
  const base::Bytes brief = encode_short(*package, from.encoded());
  const base::Result<Package> again = decode(brief, from.encoded());
  base::check(again.ok() && encode(*again) == encode(*package), "the short form is the same");
}

void merge_images(const ir::VerifiedImage& original, const ir::VerifiedImage& edited,
                  const ir::VerifiedImage& target) {
  const auto merged = linker::merge({original.image(), edited.image(), target.image()}, {{}, true});
  if (!answered(merged)) return;
  answered(ir::verify(ir::encode(*merged)));
}

void read_code(const ir::VerifiedImage& verified) {
  vm::native::functions_text(verified.image());
  answered(linker::unlink(verified.image()));
}

void link_on(const Relink& relink, const ir::VerifiedImage& base) {
  const base::Result<ir::Image> linked = relink(base.image());
  if (!answered(linked)) return;
  const auto next = ir::verify(ir::encode(*linked));
  if (answered(next)) compare_images(base, *next);
}

}  // namespace fuzz
