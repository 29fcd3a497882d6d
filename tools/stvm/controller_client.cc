#include "tools/stvm/controller_client.h"

#include <algorithm>

#include "base/limits.h"
#include "base/visible_text.h"
#include "online_change/store/record.h"
#include "tools/common/files.h"
#include "tools/stvm/commands.h"
#include "tools/stvm/remote_client.h"
#include "tools/stvm/state_folder.h"

namespace stvm {
namespace {

// Rows of all pages together; what a controller may send is bounded.
constexpr size_t kMaxRows = 20'000'000;
constexpr size_t kMaxEvents = 65'536;  // a journal has 1,280 of them, a controller 2,048
constexpr size_t kLeastPart = 4096;    // bytes of an image, of each part but the last

base::Error endless() {
  return {base::Refusal::kProtocol, "message not understood: pages without end"};
}

}  // namespace

base::Result<ControllerClient> ControllerClient::connect(const tools::Options& options) {
  constexpr uint32_t kPatience = vm::SocketClient::kPatienceSeconds;
  if (!options.has("--host")) return connect_here(state_directory(options), kPatience);
  return connect_there(options.text("--host"), options.text("--dir"), kPatience);
}

base::Result<ControllerClient> ControllerClient::connect_to(const std::string& place,
                                                            uint32_t patience_s) {
  return tools::is_folder(place) ? connect_here(place, patience_s)
                                 : connect_there(place, {}, patience_s);
}

base::Result<ControllerClient> ControllerClient::connect_there(const std::string& host,
                                                               const std::string& directory,
                                                               uint32_t patience_s) {
  auto transport = RemoteClient::connect(host, directory, patience_s);
  if (!transport.ok()) return transport.error();
  return ControllerClient(std::move(*transport));
}

base::Result<ControllerClient> ControllerClient::connect_here(const std::string& directory,
                                                              uint32_t patience_s) {
  auto transport = vm::SocketClient::connect(directory, patience_s);
  const std::vector<std::string> resources =
      transport.ok() ? std::vector<std::string>() : stored_resources(directory);
  if (!resources.empty()) {
    return base::Error{base::Refusal::kNotRunning,
                       directory + " is of several resources; name one: --dir " + directory + "/" +
                           resources.front()};
  }
  if (!transport.ok()) return transport.error();
  return ControllerClient(std::move(*transport));
}

base::Result<base::Bytes> ControllerClient::call(vm::Request request) {
  request.expected = expected_;
  request.edition = edition_;
  base::Result<base::Bytes> answer = transport_->exchange(vm::encode(request));
  if (!answer.ok()) return answer;
  return vm::decode_answer(*answer);
}

base::Result<vm::StatusReport> ControllerClient::look() {
  base::Result<base::Bytes> body = call({.command = vm::Command::kStatus});
  if (!body.ok()) return body.error();
  return vm::decode_status(*body);
}

base::Result<vm::StatusReport> ControllerClient::status() {
  base::Result<vm::StatusReport> report = look();
  if (report.ok()) {
    expected_ = report->running;
    edition_ = report->edition;
  }
  return report;
}

base::Result<vm::TaskTimes> ControllerClient::task_times(const std::string& task) {
  base::Result<base::Bytes> body = call({.command = vm::Command::kTimes, .names = {task}});
  if (!body.ok()) return body.error();
  return vm::decode_task_times(*body);
}

base::Result<vm::Values> ControllerClient::get(std::vector<std::string> names) {
  vm::Request request{.command = vm::Command::kGet};
  size_t wanted = names.size();
  request.names = std::move(names);
  base::Result<base::Bytes> body = call(std::move(request));
  if (!body.ok()) return body.error();
  base::Result<vm::Values> values = vm::decode_values(*body);
  if (values.ok() && values->rows.size() != wanted) {
    return base::Error{base::Refusal::kProtocol,
                       "message not understood: another number of values"};
  }
  return values;
}

base::Result<vm::Values> ControllerClient::list(const std::string& pattern) {
  vm::Values all;
  vm::Request request{.command = vm::Command::kList};
  request.names = {pattern};
  for (;;) {
    base::Result<base::Bytes> body = call(request);
    if (!body.ok()) return body.error();
    base::Result<vm::Values> page = vm::decode_values(*body);
    if (!page.ok()) return page;
    std::move(page->rows.begin(), page->rows.end(), std::back_inserter(all.rows));
    if (page->next == 0) return all;
    if (page->next <= request.offset || all.rows.size() > kMaxRows) return endless();
    request.offset = page->next;
  }
}

base::Result<vm::ForceRows> ControllerClient::forces() {
  base::Result<base::Bytes> body = call({.command = vm::Command::kForces});
  if (!body.ok()) return body.error();
  return vm::decode_forces(*body);
}

base::Result<vm::ForceRows> ControllerClient::force(const std::vector<std::string>& names,
                                                    const std::vector<std::string>& values) {
  base::Result<base::Bytes> body =
      call({.command = vm::Command::kForce, .names = names, .values = values});
  if (!body.ok()) return body.error();
  return vm::decode_forces(*body);
}

base::Status ControllerClient::assign(vm::Command command, const std::vector<std::string>& names,
                                      const std::vector<std::string>& values) {
  vm::Request request{.command = command};
  request.names = names;
  request.values = values;
  base::Result<base::Bytes> body = call(std::move(request));
  if (!body.ok()) return body.error();
  return base::Ok{};
}

base::Result<base::Bytes> ControllerClient::image() {
  return image_parts({.command = vm::Command::kImage}, &expected_);
}

base::Result<base::Bytes> ControllerClient::image_before() {
  return image_parts({.command = vm::Command::kBefore}, nullptr);
}

base::Result<base::Bytes> ControllerClient::image_before(const std::string& edit) {
  return image_parts({.command = vm::Command::kBefore, .names = {edit}}, nullptr);
}

base::Result<base::Bytes> ControllerClient::image_parts(vm::Request request,
                                                        const base::Digest* expected) {
  base::Bytes all;
  for (;;) {
    request.offset = all.size();
    base::Result<base::Bytes> body = call(request);
    if (!body.ok()) return body.error();
    base::Result<vm::ImagePart> part = vm::decode_image_part(*body);
    if (!part.ok()) return part.error();
    if (expected != nullptr && part->digest != *expected) {
      const base::Result<vm::StatusReport> now = status();
      std::string text = "another program runs than a moment ago";
      if (now.ok() && !now->changed_by.empty()) text += ", made by " + now->changed_by;
      return base::Error{base::Refusal::kStaleBase, std::move(text)};
    }
    all.insert(all.end(), part->bytes.begin(), part->bytes.end());
    if (part->total > base::kMaxImageBytes || all.size() > part->total) return endless();
    if (all.size() == part->total) return all;
    if (part->bytes.size() < kLeastPart) return endless();
  }
}

// Whatever is no whole entry ends it: nothing else comes from a journal. Numbers rise from page to
// page: a controller that sends one page again and again is not listened to.
base::Result<bool> ControllerClient::journal_page(const vm::Request& request,
                                                  std::vector<online_change::JournalEntry>& all) {
  base::Result<base::Bytes> body = call(request);
  if (!body.ok()) return body.error();
  const size_t bytes = online_change::kSectorBytes;
  if (body->size() % bytes != 0 || all.size() > kMaxEvents) return endless();
  const size_t before = all.size();
  for (size_t at = 0; at < body->size(); at += bytes) {
    auto entry = online_change::decode_entry(base::ByteSpan(*body).subspan(at, bytes));
    if (!entry) return base::Error{base::Refusal::kProtocol, "message not understood: journal"};
    for (std::string* text : {&entry->who, &entry->text, &entry->source}) {
      *text = base::visible(*text);
    }
    all.push_back(std::move(*entry));
  }
  const bool more = all.size() != before;
  if (more && before != 0 && all.back().sequence <= all[before - 1].sequence) return endless();
  return more;
}

base::Result<std::vector<online_change::JournalEntry>> ControllerClient::journal() {
  std::vector<online_change::JournalEntry> all;
  vm::Request request{.command = vm::Command::kJournal};
  for (;;) {
    request.offset = all.size();
    base::Result<bool> more = journal_page(request, all);
    if (!more.ok()) return more.error();
    if (!*more) return all;
  }
}

base::Result<std::vector<online_change::JournalEntry>> ControllerClient::events(uint64_t first) {
  std::vector<online_change::JournalEntry> all;
  vm::Request request{.command = vm::Command::kEvents, .offset = first};
  for (;;) {
    base::Result<bool> more = journal_page(request, all);
    if (!more.ok()) return more.error();
    if (!*more) return all;
    request.offset = all.back().sequence + 1;
  }
}

base::Result<std::vector<UnitRow>> ControllerClient::units() {
  std::vector<UnitRow> all;
  vm::Request request{.command = vm::Command::kUnits};
  for (;;) {
    base::Result<base::Bytes> body = call(request);
    if (!body.ok()) return body.error();
    base::Result<UnitPage> page = decode_unit_page(*body);
    if (!page.ok()) return page.error();
    std::move(page->rows.begin(), page->rows.end(), std::back_inserter(all));
    if (page->next == 0) return all;
    if (page->next <= request.offset || all.size() > kMaxRows) return endless();
    request.offset = page->next;
  }
}

base::Result<std::map<std::string, std::string>> ControllerClient::facts() {
  std::map<std::string, std::string> out;
  base::Result<base::Bytes> body = call({.command = vm::Command::kFacts});
  if (!body.ok()) {
    const bool unknown = body.error().refusal == base::Refusal::kProtocol;
    return unknown ? base::Result<std::map<std::string, std::string>>(std::move(out))
                   : body.error();
  }
  base::Result<vm::Values> facts = vm::decode_values(*body);
  if (!facts.ok()) return facts.error();
  for (const vm::ValueRow& row : facts->rows) out[row.path] = base::visible(row.value);
  return out;
}

base::Result<std::vector<TrialEdit>> ControllerClient::edits() {
  std::vector<TrialEdit> all;
  vm::Request request{.command = vm::Command::kEdits};
  for (;;) {
    base::Result<base::Bytes> body = call(request);
    if (!body.ok()) return body.error();
    base::Result<EditPage> page = decode_edit_page(*body);
    if (!page.ok()) return page.error();
    std::move(page->edits.begin(), page->edits.end(), std::back_inserter(all));
    if (page->next == 0) return all;
    if (page->next <= request.offset || all.size() > kMaxRows) return endless();
    request.offset = page->next;
  }
}

base::Status ControllerClient::stage(base::ByteSpan package, uint32_t flags,
                                     const std::string& unless, const std::string& note,
                                     const std::string& taken_out) {
  vm::Request part{.command = vm::Command::kUpload};
  do {
    size_t size = std::min<size_t>(vm::kChunkBytes, package.size() - part.offset);
    base::ByteSpan bytes = package.subspan(part.offset, size);
    part.data.assign(bytes.begin(), bytes.end());
    base::Result<base::Bytes> taken = call(part);
    if (!taken.ok()) return taken.error();
    part.offset += size;
  } while (part.offset < package.size());
  vm::Request stage{.command = vm::Command::kStage};
  stage.digest = base::sha256(package);
  stage.flags = flags;
  stage.names = {unless, note, taken_out};
  while (!stage.names.empty() && stage.names.back().empty()) stage.names.pop_back();
  staged_ = stage.digest;
  return learn_edition(call(std::move(stage)));
}

base::Status ControllerClient::stage_again(const std::string& edit) {
  staged_.reset();
  return learn_edition(call({.command = vm::Command::kRedo, .names = {edit}}));
}

base::Status ControllerClient::learn_edition(const base::Result<base::Bytes>& staged) {
  if (!staged.ok()) return staged.error();
  base::Result<vm::StagedAnswer> answer = vm::decode_staged_answer(*staged);
  if (!answer.ok()) return answer.error();
  edition_ = answer->edition;
  return base::Ok{};
}

base::Result<FatePage> ControllerClient::fates(const std::string& way_back,
                                               const std::string& edit) {
  std::vector<std::string> names = {way_back, edit};
  while (!names.empty() && names.back().empty()) names.pop_back();
  return fate_pages(std::move(names));
}

base::Result<std::vector<FateLine>> ControllerClient::every_fate() {
  base::Result<FatePage> all = fate_pages({vm::kEveryVariable});
  if (!all.ok()) return all.error();
  return std::move(all->lines);
}

base::Result<FatePage> ControllerClient::fate_pages(std::vector<std::string> names) {
  FatePage all;
  vm::Request request{.command = vm::Command::kFates, .names = std::move(names)};
  for (;;) {
    base::Result<base::Bytes> body = call(request);
    if (!body.ok()) return body.error();
    base::Result<FatePage> page = decode_fate_page(*body);
    if (!page.ok()) return page;
    if (request.offset == 0) {
      all = std::move(*page);
    } else {
      std::move(page->lines.begin(), page->lines.end(), std::back_inserter(all.lines));
      all.next = page->next;
    }
    if (all.next == 0) return all;
    if (all.next <= request.offset || all.lines.size() > kMaxRows) return endless();
    request.offset = all.next;
  }
}

base::Result<online_change::SwitchReport> ControllerClient::switch_report(vm::Request request) {
  base::Result<base::Bytes> body = call(std::move(request));
  if (!body.ok()) return body.error();
  return decode_switch_report(*body);
}

base::Result<online_change::SwitchReport> ControllerClient::make_switch(uint32_t flags,
                                                                        const std::string& health) {
  vm::Request request{.command = vm::Command::kSwitch};
  request.flags = flags;
  if (!health.empty() || staged_) request.names = {health};
  if (staged_) request.names.push_back(base::to_hex(*staged_));
  return switch_report(std::move(request));
}

base::Result<online_change::SwitchReport> ControllerClient::undo(
    const std::string& edit, const std::vector<std::string>& ways) {
  vm::Request request{.command = vm::Command::kUndo};
  if (!edit.empty() || !ways.empty()) request.names = {edit};
  request.names.insert(request.names.end(), ways.begin(), ways.end());
  return switch_report(std::move(request));
}

}  // namespace stvm
