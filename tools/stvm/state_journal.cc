#include "tools/stvm/state_journal.h"

#include "online_change/store/store.h"
#include "vm/runtime/file_storage.h"

namespace stvm {

using online_change::JournalEntry;

base::Result<std::vector<JournalEntry>> stored_events(const std::string& directory) {
  vm::FileStorage storage(directory);
  auto entries = online_change::read_journal(storage, online_change::kJournalFile);
  if (!entries.ok()) return entries.error();
  auto traps = online_change::read_journal(storage, online_change::kTrapsFile);
  if (!traps.ok()) return traps.error();
  return online_change::by_time(std::move(*entries), std::move(*traps));
}

}  // namespace stvm
