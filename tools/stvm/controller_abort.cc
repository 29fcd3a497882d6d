// What ends a change that is being prepared (C9): a command, the end of the connection that brings
// it, and a condition of the user. Between the steps of a request that prepares one, the service
// looks whether any of them has come; then the old program runs on as if nothing had been.
#include <utility>

#include "ir/bytecode/variable_names.h"
#include "tools/stvm/controller_service.h"

namespace stvm {
namespace {

using online_change::State;

base::Bytes abort_answer(bool done, const std::string& text) {
  return vm::encode(vm::AbortAnswer{done, text});
}

std::string unless_text(const std::string& name) {
  return "by the condition `" + name + "`, which is TRUE";
}

}  // namespace

base::Result<uint32_t> ControllerService::find_unless(const std::string& name) const {
  if (name.empty()) return 0u;
  const ir::Image& running = controller_.image();
  base::Result<ir::Symbol> symbol = ir::named_symbol(running, name);
  if (!symbol.ok()) return symbol.error();
  if (running.types[symbol->type].kind != ir::Kind::kBool) {
    return base::Error{base::Refusal::kBadValue,
                       "the condition `" + name + "` is " + running.types.text(symbol->type) +
                           "; name a BOOL of the running program that is TRUE when nothing may " +
                           "be changed"};
  }
  return symbol->data;
}

base::Status ControllerService::check_unless(const std::string& name) {
  base::Result<uint32_t> data = find_unless(name);
  if (!data.ok()) return data.error();
  const Unless staged = std::exchange(unless_, {name, *data, false});
  base::Status taken = look_at_boundary([&] { unless_holds(); });
  const bool holds = std::exchange(unless_, staged).seen;
  if (!taken.ok() || !holds) return taken;
  return base::Error{base::Refusal::kDeadline,
                     "the change was aborted " + unless_text(name) + "; the old program runs on"};
}

bool ControllerService::unless_holds() {
  if (unless_.data == 0) return false;
  if (controller_.memory().data()[unless_.data] != 0) unless_.seen = true;
  return unless_.seen;
}

bool ControllerService::watches_unless() const {
  return unless_.data != 0 && staged_ && change_.state() != State::kTrial;
}

// While somebody thinks about the report.
void ControllerService::watch_unless() {
  if (!watches_unless()) return;
  base::Status taken = look_at_boundary([&] { unless_holds(); });
  if (taken.ok() && aborted()) (void)give_up();
}

bool ControllerService::aborted() {
  if (meanwhile && preparing_) meanwhile();
  if (abort_why_.empty() && unless_.seen) {
    abort_why_ = unless_text(unless_.name);
  }
  return !abort_why_.empty();
}

base::Error ControllerService::abort_error() const {
  return {base::Refusal::kDeadline,
          "the change was aborted " + abort_why_ + "; the old program runs on"};
}

base::Error ControllerService::give_up() {
  const base::Error error = abort_error();
  aborted_of_ = staged_of_;
  aborted_ = time_text(wall_time_()) + ", " + abort_why_;
  if (!only_looked_at_) {
    online_change::JournalEntry cancelled = entry(online_change::Event::kCancelled);
    cancelled.text = "aborted " + abort_why_;
    store_.note(std::move(cancelled));
  }
  change_.cancel();
  forget_staged();
  abort_why_.clear();
  return error;
}

base::Status ControllerService::check_not_aborted() const {
  if (staged_ || aborted_.empty() || aborted_of_ != session_) return base::Ok{};
  return base::Error{base::Refusal::kDeadline,
                     "the change was aborted: " + aborted_ + "; the old program runs on"};
}

void ControllerService::asker_left() {
  if (preparing_ && abort_why_.empty()) {
    abort_why_ = "because the connection of " + who_ + " has ended";
  }
}

// In the middle of preparing: it is given up before anything else is done with it.
std::optional<base::Bytes> ControllerService::answer_urgent(const std::string& user,
                                                            base::ByteSpan request) {
  base::Result<vm::Request> asked = vm::decode_request(request);
  if (!preparing_ || !asked.ok() || asked->command != vm::Command::kAbort) return std::nullopt;
  if (abort_why_.empty()) abort_why_ = "by " + user;
  return vm::encode_answer(abort_answer(true, "the change of " + who_ + " is aborted"));
}

// Beside a request that prepares one: it has been brought, or a part of it.
base::Result<base::Bytes> ControllerService::abort(const vm::Request&) {
  if (change_.state() == State::kTrial) {
    return abort_answer(false,
                        "nothing is being prepared; a change is on trial: `stvm undo` "
                        "takes it back");
  }
  if (staged_) {
    const std::string whose = changed_by_;
    abort_why_ = "by " + who_;
    (void)give_up();
    return abort_answer(true, "the change of " + whose + " is aborted");
  }
  if (!upload_.empty()) {
    upload_ = base::Bytes();
    aborted_of_ = upload_of_;
    aborted_ = time_text(wall_time_()) + ", by " + who_;
    const std::string whose = std::exchange(upload_by_, {});
    online_change::JournalEntry cancelled = entry(online_change::Event::kCancelled);
    cancelled.text = "aborted by " + who_ + " while " + whose + " was bringing it";
    store_.note(std::move(cancelled));
    return abort_answer(true, "the change that " + whose + " was bringing is aborted");
  }
  return abort_answer(false, "nothing is being prepared");
}

}  // namespace stvm
