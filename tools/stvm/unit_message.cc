#include "tools/stvm/unit_message.h"

#include "base/check.h"
#include "vm/runtime/fields.h"

namespace stvm {

const char* other_slot_name(OtherSlot what) {
  constexpr const char* kNames[] = {"empty", "before", "undone", "staged", "left"};
  return kNames[static_cast<size_t>(what)];
}

namespace {

template <class A, class T>
void unit_fields(A& a, T& row) {
  a(row.name);
  a(row.instances);
  a(row.slot);
  a(row.unit);
  a.choice(row.other, OtherSlot::kLeft);
  a(row.other_unit);
  a(row.other_version);
  a(row.cycle);
  a(row.time_ns);
  a(row.who);
  a(row.event);
}

template <class A, class T>
void pou_fields(A& a, T& edit) {
  a.choice(edit.change, online_change::PouChange::kFollows);
  a(edit.pou);
  a(edit.instances);
  a(edit.what);
}

template <class A, class T>
void type_fields(A& a, T& edit) {
  a.choice(edit.change, online_change::TypeChange::kEdited);
  a(edit.type);
}

template <class A, class T>
void variable_fields(A& a, T& row) {
  a.choice(row.fate, online_change::Fate::kDropped);
  a(row.path);
  a(row.old_type);
  a(row.new_type);
  a(row.reason);
  a(row.count);
}

template <class A, class T>
void edit_fields(A& a, T& edit) {
  a(edit.name);
  a(edit.undone);
  a(edit.from);
  a(edit.to);
  a(edit.cycle);
  a(edit.time_ns);
  a(edit.who);
  a.list(edit.pous, 17);
  a(edit.pou_count);
  a.list(edit.types, 5);
  a(edit.type_count);
  a.list(edit.variables, 25);
  a(edit.variable_count);
}

template <class A, class T>
void unit_page_fields(A& a, T& page) {
  a(page.next);
  a.list(page.rows, 138);
}

template <class A, class T>
void edit_page_fields(A& a, T& page) {
  a(page.next);
  a.list(page.edits, 125);
}

}  // namespace

static void fields(vm::FieldWriter& a, const UnitRow& row) { unit_fields(a, row); }
static void fields(vm::FieldReader& a, UnitRow& row) { unit_fields(a, row); }
static void fields(vm::FieldWriter& a, const EditedPou& edit) { pou_fields(a, edit); }
static void fields(vm::FieldReader& a, EditedPou& edit) { pou_fields(a, edit); }
static void fields(vm::FieldWriter& a, const EditedType& edit) { type_fields(a, edit); }
static void fields(vm::FieldReader& a, EditedType& edit) { type_fields(a, edit); }
static void fields(vm::FieldWriter& a, const EditedVariable& row) { variable_fields(a, row); }
static void fields(vm::FieldReader& a, EditedVariable& row) { variable_fields(a, row); }
static void fields(vm::FieldWriter& a, const TrialEdit& edit) { edit_fields(a, edit); }
static void fields(vm::FieldReader& a, TrialEdit& edit) { edit_fields(a, edit); }
static void fields(vm::FieldWriter& a, const UnitPage& page) { unit_page_fields(a, page); }
static void fields(vm::FieldReader& a, UnitPage& page) { unit_page_fields(a, page); }
static void fields(vm::FieldWriter& a, const EditPage& page) { edit_page_fields(a, page); }
static void fields(vm::FieldReader& a, EditPage& page) { edit_page_fields(a, page); }

base::Bytes encode(const UnitPage& page) { return vm::write_fields(page); }
base::Bytes encode(const EditPage& page) { return vm::write_fields(page); }
base::Result<UnitPage> decode_unit_page(base::ByteSpan body) {
  return vm::read_fields<UnitPage>(body, "units");
}
base::Result<EditPage> decode_edit_page(base::ByteSpan body) {
  return vm::read_fields<EditPage>(body, "edits");
}

}  // namespace stvm
