#include "tools/stvm/fate_message.h"

#include "vm/runtime/fields.h"

namespace stvm {
namespace {

template <class A, class T>
void count_fields(A& a, T& counts) {
  a(counts.kept);
  a(counts.moved);
  a(counts.converted);
  a(counts.initialised);
  a(counts.dropped);
}

template <class A, class T>
void row_fields(A& a, T& row) {
  a(row.path);
  a(row.old_type);
  a(row.new_type);
  a(row.may_lose);
  a(row.reason);
  a(row.count);
}

template <class A, class T>
void live_fields(A& a, T& live) {
  a(live.now);
  a(live.after);
  a(live.loss);
}

template <class A, class T>
void fate_edit_fields(A& a, T& edit) {
  a(edit.pou);
  a(edit.instances);
  a(edit.what);
}

template <class A, class T>
void loss_fields(A& a, T& loss) {
  a(loss.path);
  a(loss.old_value);
  a(loss.new_value);
  a(loss.what);
}

template <class A, class T>
void page_fields(A& a, T& page) {
  count_fields(a, page.counts);
  a(page.predicted_pause_ns);
  a(page.boundary_bytes);
  a(page.next);
  a.list(page.lines, 50);
  a(page.loss_count);
  a.list(page.losses, 16);
  a.list(page.edits, 17);
  a.list(page.system, 12);
}

template <class A, class T>
void report_fields(A& a, T& report) {
  a(report.cycle_before);
  a(report.cycle_after);
  a(report.pause_ns);
  a(report.missed);
  count_fields(a, report.counts);
  a(report.ago_ns);
}

}  // namespace

}  // namespace stvm

// list() finds functions in the namespace of its rows.
namespace tools {

static void fields(vm::FieldWriter& a, const FateLine& line) {
  a(static_cast<uint8_t>(line.row.fate));
  stvm::row_fields(a, line.row);
  stvm::live_fields(a, line.live);
  a(line.row.old_path);
  a(line.old_address);
  a(line.new_address);
}

static void fields(vm::FieldReader& a, FateLine& line) {
  uint8_t fate = 0;
  a(fate);
  if (fate > static_cast<uint8_t>(online_change::Fate::kDropped)) {
    a.fail();
    return;
  }
  line.row.fate = static_cast<online_change::Fate>(fate);
  stvm::row_fields(a, line.row);
  stvm::live_fields(a, line.live);
  a(line.row.old_path);
  a(line.old_address);
  a(line.new_address);
}

}  // namespace tools

namespace online_change {

static void fields(vm::FieldWriter& a, const PouEdit& edit) {
  a(static_cast<uint8_t>(edit.change));
  stvm::fate_edit_fields(a, edit);
}

static void fields(vm::FieldReader& a, PouEdit& edit) {
  uint8_t change = 0;
  a(change);
  if (change > static_cast<uint8_t>(PouChange::kFollows)) return a.fail();
  edit.change = static_cast<PouChange>(change);
  stvm::fate_edit_fields(a, edit);
}

static void fields(vm::FieldWriter& a, const SystemEdit& edit) {
  a(edit.kind);
  a(edit.name);
  a(edit.what);
}
static void fields(vm::FieldReader& a, SystemEdit& edit) {
  a(edit.kind);
  a(edit.name);
  a(edit.what);
}

}  // namespace online_change

namespace stvm {

static void fields(vm::FieldWriter& a, const LossLine& line) { loss_fields(a, line.loss); }
static void fields(vm::FieldReader& a, LossLine& line) { loss_fields(a, line.loss); }

base::Bytes encode(const FatePage& page) {
  vm::FieldWriter writer;
  page_fields(writer, page);
  return writer.take();
}

base::Result<FatePage> decode_fate_page(base::ByteSpan body) {
  vm::FieldReader reader(body);
  FatePage page;
  page_fields(reader, page);
  if (!reader.done()) return vm::not_understood("fate report");
  return page;
}

base::Bytes encode(const online_change::SwitchReport& report) {
  vm::FieldWriter writer;
  report_fields(writer, report);
  return writer.take();
}

base::Result<online_change::SwitchReport> decode_switch_report(base::ByteSpan body) {
  vm::FieldReader reader(body);
  online_change::SwitchReport report;
  report_fields(reader, report);
  if (!reader.done()) return vm::not_understood("report of the switch");
  return report;
}

}  // namespace stvm
