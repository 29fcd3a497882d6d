#include "tools/stvm/agent_answer.h"

#include <algorithm>

#include "base/joined.h"
#include "online_change/package/signed_file.h"
#include "tools/stvm/fate_message.h"
#include "vm/runtime/fields.h"

namespace stvm {
namespace {

constexpr uint32_t kAnswerVersion = 1;
constexpr size_t kMostParts = 65'536;

constexpr base::Refusal kRefusals[] = {
#define REFUSAL(id, code, text, help) base::Refusal::id,
#include "base/refusals.def"
#undef REFUSAL
};

constexpr auto trace_fields = [](auto& a, auto& trace) {
  a(trace.answers);
  a(trace.on_trial);
  a(trace.switched);
  a(trace.accepted);
  a(trace.edit);
  a(trace.from);
  a(trace.to);
  a(trace.text);
  a(trace.alarm);
};

constexpr auto part_fields = [](auto& a, auto& part) {
  a.enumerator(part.kind, ir::kPartKindCount);
  a(part.name);
  a(part.identity);
};

constexpr auto part_edit_fields = [](auto& a, auto& part) {
  a.enumerator(part.kind, ir::kPartKindCount);
  a(part.name);
  a.enumerator(part.state, ir::PartState::kDifferent);
  a(part.original);
  a(part.edited);
  a(part.here);
};

constexpr auto about_fields = [](auto& a, auto& about) {
  a(about.running);
  a(about.program);
  a.rows(about.parts, 37, part_fields);
  a(about.plan);
  trace_fields(a, about.trace);
  a.added(about.edits);
};

// As it travels: an error by its code, so that versions of the tools need not agree on numbers.
struct AnswerMessage {
  base::Digest order{};
  FleetOutcome outcome = FleetOutcome::kNotAsked;
  std::string code;
  std::string why;
  std::string program;
  base::Digest from{};
  std::string edits;
  std::vector<ir::PartEdit> parts;
  base::Bytes report;  // as controllers send it; none
  PlanTrace trace;
  AgentFile shown;
};

constexpr auto answer_fields = [](auto& a, auto& answer) {
  a(answer.order);
  a.enumerator(answer.outcome, FleetOutcome::kTakenBack);
  a(answer.code);
  a(answer.why);
  a(answer.program);
  a(answer.from);
  a(answer.edits);
  a.rows(answer.parts, 102, part_edit_fields);
  a(answer.report);
  trace_fields(a, answer.trace);
  a(answer.shown.digest);
  a(answer.shown.size);
};

template <class T, class Fields>
base::Bytes write_versioned(const T& message, Fields&& fields) {
  vm::FieldWriter out;
  out(kAnswerVersion);
  fields(out, message);
  return out.take();
}

template <class T, class Fields>
base::Result<T> read_versioned(base::ByteSpan bytes, const char* what, Fields&& fields) {
  vm::FieldReader in(bytes);
  uint32_t version = 0;
  in(version);
  T message;
  if (version == kAnswerVersion) fields(in, message);
  if (!in.failed() && version == kAnswerVersion) return message;
  return base::Error{base::Refusal::kBadFormat,
                     std::string(what) + " of an agent: it is damaged, or of another version"};
}

base::Error error_of(const std::string& code, const std::string& text) {
  for (const base::Refusal refusal : kRefusals) {
    if (code == base::refusal_code(refusal)) return {refusal, text};
  }
  return {base::Refusal::kProtocol, base::joined({code, ": ", text})};
}

bool is_topic_char(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.' ||
         c == '_' || c == '-';
}

}  // namespace

base::Bytes encode(const AgentAbout& about) { return write_versioned(about, about_fields); }

base::Result<AgentAbout> decode_agent_about(base::ByteSpan bytes) {
  base::Result<AgentAbout> about = read_versioned<AgentAbout>(bytes, "what is known", about_fields);
  if (!about.ok() || about->parts.size() <= kMostParts) return about;
  return base::Error{base::Refusal::kTooMany, "an agent names more than 65,536 parts"};
}

base::Bytes encode(const AgentAnswer& answer) {
  const FleetRow& row = answer.row;
  AnswerMessage message{answer.order, row.outcome, {}, {},           row.program, row.from,
                        row.edits,    row.parts,   {}, answer.trace, answer.shown};
  if (row.why) message.code = base::refusal_code(row.why->refusal);
  if (row.why) message.why = row.why->text;
  if (row.report) message.report = encode(*row.report);
  return write_versioned(message, answer_fields);
}

base::Result<AgentAnswer> decode_agent_answer(base::ByteSpan bytes) {
  base::Result<AnswerMessage> message =
      read_versioned<AnswerMessage>(bytes, "an answer", answer_fields);
  if (!message.ok()) return message.error();
  AgentAnswer answer;
  answer.order = message->order;
  answer.row.outcome = message->outcome;
  if (!message->code.empty()) answer.row.why = error_of(message->code, message->why);
  answer.row.program = message->program;
  answer.row.from = message->from;
  answer.row.edits = message->edits;
  answer.row.parts = std::move(message->parts);
  if (!message->report.empty()) {
    base::Result<online_change::SwitchReport> report = decode_switch_report(message->report);
    if (!report.ok()) return report.error();
    answer.row.report = *report;
  }
  answer.trace = std::move(message->trace);
  answer.shown = message->shown;
  return answer;
}

bool is_agent_name(std::string_view name) {
  return !name.empty() && name.size() <= online_change::kMostSignedName && name != "-" &&
         std::ranges::all_of(name, is_topic_char);
}

bool is_topic_prefix(std::string_view prefix) {
  const auto may = [](char c) { return is_topic_char(c) || c == '/'; };
  return !prefix.empty() && prefix.size() <= 256 && std::ranges::all_of(prefix, may);
}

}  // namespace stvm
