#include "tools/stvm/unit_message.h"

#include "base/check.h"
#include "vm/runtime/fields.h"

namespace stvm {

const char* other_slot_name(OtherSlot what) {
  constexpr const char* kNames[] = {"empty", "before", "undone", "staged", "left"};
  return kNames[static_cast<size_t>(what)];
}

namespace {

constexpr auto unit_fields = [](auto& a, auto& row) {
  a(row.name);
  a(row.instances);
  a(row.slot);
  a(row.unit);
  a.enumerator(row.other, OtherSlot::kLeft);
  a(row.other_unit);
  a(row.other_version);
  a(row.cycle);
  a(row.time_ns);
  a(row.who);
  a(row.event);
};

constexpr auto pou_fields = [](auto& a, auto& edit) {
  a.enumerator(edit.change, online_change::PouChange::kFollows);
  a(edit.pou);
  a(edit.instances);
  a(edit.what);
};

constexpr auto type_fields = [](auto& a, auto& edit) {
  a.enumerator(edit.change, online_change::TypeChange::kEdited);
  a(edit.type);
};

constexpr auto variable_fields = [](auto& a, auto& row) {
  a.enumerator(row.fate, online_change::Fate::kDropped);
  a(row.path);
  a(row.old_type);
  a(row.new_type);
  a(row.reason);
  a(row.count);
};

constexpr auto edit_fields = [](auto& a, auto& edit) {
  a(edit.name);
  a(edit.undone);
  a(edit.from);
  a(edit.to);
  a(edit.cycle);
  a(edit.time_ns);
  a(edit.who);
  a.rows(edit.pous, 17, pou_fields);
  a(edit.pou_count);
  a.rows(edit.types, 5, type_fields);
  a(edit.type_count);
  a.rows(edit.variables, 25, variable_fields);
  a(edit.variable_count);
};

constexpr auto unit_page_fields = [](auto& a, auto& page) {
  a(page.next);
  a.rows(page.rows, 138, unit_fields);
};

constexpr auto edit_page_fields = [](auto& a, auto& page) {
  a(page.next);
  a.rows(page.edits, 125, edit_fields);
};

}  // namespace

base::Bytes encode(const UnitPage& page) { return vm::write_fields(page, unit_page_fields); }
base::Bytes encode(const EditPage& page) { return vm::write_fields(page, edit_page_fields); }
base::Result<UnitPage> decode_unit_page(base::ByteSpan body) {
  return vm::read_fields<UnitPage>(body, "units", unit_page_fields);
}
base::Result<EditPage> decode_edit_page(base::ByteSpan body) {
  return vm::read_fields<EditPage>(body, "edits", edit_page_fields);
}

}  // namespace stvm
