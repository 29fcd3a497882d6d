// The edits on trial in a file of their own (D4). The control record decides which of them count:
// a list that is newer or older than it leads to what it names all the same.
#include "online_change/store/store.h"

#include "base/check.h"

namespace online_change {

base::Status Store::keep_edits(const std::vector<StoredEdit>& edits) {
  const base::Bytes payload = encode(edits);
  base::dcheck([&] { return decode_edits(payload).has_value(); },
               "a list of edits is read as it was written");
  std::lock_guard lock(before_mutex_);
  return replace_record(storage_, kEditsFile, RecordKind::kEdits, 1, payload,
                        record_bytes(payload.size()));
}

base::Result<std::vector<StoredEdit>> Store::edits() const {
  std::lock_guard lock(before_mutex_);
  const Record record = read_record(storage_, kEditsFile, RecordKind::kEdits);
  std::optional<std::vector<StoredEdit>> edits;
  if (record.state == RecordState::kValid) edits = decode_edits(record.payload);
  if (edits) return std::move(*edits);
  return failed("the list of the edits on trial cannot be read, or is damaged");
}

base::Status Store::set_resumes(bool resumes) {
  std::lock_guard lock(mutex_);
  if (!control_.trial || control_.resumes == resumes) return base::Ok{};
  ControlRecord next = control_;
  next.resumes = resumes;
  return write_control(next);
}

base::Status Store::make_whole() {
  std::lock_guard lock(mutex_);
  return settle_locked();
}

}  // namespace online_change
