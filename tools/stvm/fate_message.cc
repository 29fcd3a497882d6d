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
void line_fields(A& a, T& line) {
  a.choice(line.row.fate, online_change::Fate::kDropped);
  a(line.row.path);
  a(line.row.old_type);
  a(line.row.new_type);
  a(line.row.may_lose);
  a(line.row.reason);
  a(line.row.count);
  a(line.live.now);
  a(line.live.after);
  a(line.live.loss);
  a(line.row.old_path);
  a(line.old_address);
  a(line.new_address);
}

template <class A, class T>
void fate_edit_fields(A& a, T& edit) {
  a.choice(edit.change, online_change::PouChange::kFollows);
  a(edit.pou);
  a(edit.instances);
  a(edit.what);
}

template <class A, class T>
void system_fields(A& a, T& edit) {
  a(edit.kind);
  a(edit.name);
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

static void fields(vm::FieldWriter& a, const FateLine& line) { stvm::line_fields(a, line); }
static void fields(vm::FieldReader& a, FateLine& line) { stvm::line_fields(a, line); }

}  // namespace tools

namespace online_change {

static void fields(vm::FieldWriter& a, const PouEdit& edit) { stvm::fate_edit_fields(a, edit); }
static void fields(vm::FieldReader& a, PouEdit& edit) { stvm::fate_edit_fields(a, edit); }
static void fields(vm::FieldWriter& a, const SystemEdit& edit) { stvm::system_fields(a, edit); }
static void fields(vm::FieldReader& a, SystemEdit& edit) { stvm::system_fields(a, edit); }

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
  if (reader.failed()) return vm::not_understood("fate report");
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
  if (reader.failed()) return vm::not_understood("report of the switch");
  return report;
}

}  // namespace stvm
