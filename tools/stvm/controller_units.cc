// The table of units (D8) and the edits on trial (D3), as the serving controller tells of them.
// Both are known to this thread: nothing here waits for a boundary, or makes a scan wait.
#include <algorithm>
#include <utility>

#include "base/limits.h"
#include "base/tool_limits.h"
#include "ir/bytecode/image_versions.h"
#include "tools/common/version.h"
#include "tools/stvm/controller_service.h"
#include "vm/native/program.h"

namespace stvm {
namespace {

// How many POUs, types and variables of an edit are shown, each: an edit is one message.
constexpr size_t kShownRows = 200;
constexpr size_t kShownBytes = vm::kMaxMessageBytes / 8;

size_t text_bytes(const online_change::PouEdit& edit) { return edit.pou.size() + edit.what.size(); }
size_t text_bytes(const online_change::TypeEdit& edit) { return edit.type.size(); }
size_t text_bytes(const online_change::FateRow& row) {
  return row.path.size() + row.old_type.size() + row.new_type.size() + row.reason.size();
}

// The first rows of one kind, until one does not fit any more.
class FirstRows {
 public:
  template <class Row>
  bool take(const Row& row) {
    bytes_ += text_bytes(row);
    return ++rows_ <= kShownRows && bytes_ <= kShownBytes;
  }

 private:
  size_t rows_ = 0;
  size_t bytes_ = 0;
};

template <class Row>
std::vector<Row> first_of(std::vector<Row> all, uint64_t& count) {
  count = all.size();
  FirstRows first;
  size_t taken = 0;
  while (taken < all.size() && first.take(all[taken])) ++taken;
  all.resize(taken);
  return all;
}

}  // namespace

void ControllerService::note_units(const char* event, uint64_t cycle) {
  units_.note({cycle, wall_time_(), who_, event});
}

TrialEdit ControllerService::describe_staged() const {
  TrialEdit edit = describe(controller_.verified(), *staged_, change_.plan());
  edit.time_ns = wall_time_();
  edit.who = who_;
  return edit;
}

TrialEdit ControllerService::describe(const ir::VerifiedImage& running,
                                      const ir::VerifiedImage& next,
                                      const online_change::Plan& plan) {
  using online_change::Fate;
  const online_change::EncodedImage before{running.image(), running.encoded()};
  const online_change::EncodedImage after{next.image(), next.encoded()};
  TrialEdit edit;
  edit.from = running.digest();
  edit.to = next.digest();
  edit.pous = first_of(online_change::pou_edits(before, after), edit.pou_count);
  edit.types = first_of(online_change::type_edits(before, after), edit.type_count);
  FirstRows first;
  for (const online_change::FateRow& row : plan.fates) {
    // Who only moves is as it was.
    const bool same = row.fate == Fate::kMoved || row.fate == Fate::kKept;
    if (same && !online_change::is_renamed(row)) continue;
    ++edit.variable_count;
    if (first.take(row)) edit.variables.push_back(row);
  }
  return edit;
}

base::Result<base::Bytes> ControllerService::units(const vm::Request& request) {
  return encode(units_.page(request.offset, staged_ ? &*staged_ : nullptr, previous()));
}

base::Result<base::Bytes> ControllerService::edits(const vm::Request& request) {
  EditPage page;
  const uint64_t count = trials_.size() + undone_.size();
  if (request.offset >= count) return encode(page);
  const uint64_t at = request.offset;
  const bool undone = at >= trials_.size();
  page.edits.push_back(undone ? undone_[count - 1 - at].edit : trials_[at].edit);
  page.edits.front().undone = undone;
  page.next = at + 1 < count ? at + 1 : 0;
  return encode(page);
}

base::Status ControllerService::check_newest(const vm::Request& request) const {
  if (trials_.empty() || request.names.empty()) return base::Ok{};
  const std::string& newest = trials_.back().edit.name;
  if (request.names.front() == newest || request.names.front().empty()) return base::Ok{};
  return base::Error{base::Refusal::kNothingToUndo,
                     "`" + request.names.front() + "` is not the newest edit on trial, which is " +
                         newest + "; `stvm edits` shows them"};
}

// Rows may come and go from version to version: who asks knows each by its name (E-06).
base::Result<base::Bytes> ControllerService::facts(const vm::Request&) {
  vm::Values facts;
  const auto add = [&](const char* name, std::string value) {
    facts.rows.push_back({name, {}, std::move(value)});
  };
  add("version", version_);
  add("first_image_version", std::to_string(ir::kFirstImageVersion));
  add("last_image_version", std::to_string(ir::kLastImageVersion));
  add("protocol", std::to_string(vm::kProtocolVersion));
  add("native_tier", tools::native_tier(vm::native::is_available()).values.front());
  add("most_edits_on_trial", std::to_string(base::kMostEditsOnTrial));
  add("most_package_bytes", std::to_string(base::kMaxImageBytes));
  add("most_pous", std::to_string(base::kMaxPous));
  add("most_instances", std::to_string(base::kMaxInstances));
  add("most_retained_bytes", std::to_string(base::kMaxRetainBytes));
  return vm::encode(facts);
}

// As it was brought: what has changed since in the values that it reads, it meets as any change
// does.
base::Result<base::Bytes> ControllerService::redo(const vm::Request& request) {
  if (undone_.empty()) {
    return base::Error{base::Refusal::kNothingToUndo,
                       "no edit was undone that could be brought "
                       "again"};
  }
  const Trial& next = undone_.back();
  if (!request.names.empty() && request.names.front() != next.edit.name) {
    return base::Error{base::Refusal::kNothingToUndo, "`" + request.names.front() +
                                                          "` is not the edit that was undone last, "
                                                          "which is " +
                                                          next.edit.name +
                                                          "; `stvm edits` shows them"};
  }
  if (next.edit.from != controller_.verified().digest()) {
    return base::Error{base::Refusal::kStaleBase,
                       "the program has been changed since " + next.edit.name + " was undone"};
  }
  const base::Result<Signer> signer = admission_.bring_again(next.signer, local_, wall_time_());
  if (!signer.ok()) {
    note_done(online_change::Event::kRefused, who_, base::to_string(signer.error()));
    return signer.error();
  }
  return stage_package(next.package, next.flags, {}, next.edit.name, next.taken_out, *signer);
}

online_change::TakenOut ControllerService::trial_taken_out(const std::string& edit) const {
  for (size_t i = 0; i < trials_.size(); ++i) {
    if (trials_[i].edit.name == edit) return {&change_, i};
  }
  return {};
}

}  // namespace stvm
