#include "tools/stvm/fate_message.h"

#include "vm/runtime/fields.h"

namespace stvm {
namespace {

constexpr auto count_fields = [](auto& a, auto& counts) {
  a(counts.kept);
  a(counts.moved);
  a(counts.converted);
  a(counts.initialised);
  a(counts.dropped);
};

constexpr auto line_fields = [](auto& a, auto& line) {
  a.enumerator(line.row.fate, online_change::Fate::kDropped);
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
};

constexpr auto fate_edit_fields = [](auto& a, auto& edit) {
  a.enumerator(edit.change, online_change::PouChange::kFollows);
  a(edit.pou);
  a(edit.instances);
  a(edit.what);
};

constexpr auto system_fields = [](auto& a, auto& edit) {
  a(edit.kind);
  a(edit.name);
  a(edit.what);
};

constexpr auto loss_fields = [](auto& a, auto& line) {
  a(line.loss.path);
  a(line.loss.old_value);
  a(line.loss.new_value);
  a(line.loss.what);
};

constexpr auto page_fields = [](auto& a, auto& page) {
  count_fields(a, page.counts);
  a(page.predicted_pause_ns);
  a(page.boundary_bytes);
  a(page.next);
  a.rows(page.lines, 50, line_fields);
  a(page.loss_count);
  a.rows(page.losses, 16, loss_fields);
  a.rows(page.edits, 17, fate_edit_fields);
  a.rows(page.system, 12, system_fields);
};

constexpr auto report_fields = [](auto& a, auto& report) {
  a(report.cycle_before);
  a(report.cycle_after);
  a(report.pause_ns);
  a(report.missed);
  count_fields(a, report.counts);
  a(report.ago_ns);
};

}  // namespace

base::Bytes encode(const FatePage& page) { return vm::write_fields(page, page_fields); }

base::Result<FatePage> decode_fate_page(base::ByteSpan body) {
  return vm::read_fields<FatePage>(body, "fate report", page_fields);
}

base::Bytes encode(const online_change::SwitchReport& report) {
  return vm::write_fields(report, report_fields);
}

base::Result<online_change::SwitchReport> decode_switch_report(base::ByteSpan body) {
  return vm::read_fields<online_change::SwitchReport>(body, "report of the switch", report_fields);
}

}  // namespace stvm
