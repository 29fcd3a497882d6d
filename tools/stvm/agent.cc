#include "tools/stvm/agent.h"

#include <algorithm>
#include <utility>

#include "base/joined.h"
#include "ir/bytecode/verify.h"
#include "tools/stvm/fleet_visit.h"

namespace stvm {
namespace {

constexpr int64_t kPatienceMs = 60'000;  // for the next piece of a file

base::ByteSpan text_bytes(std::string_view text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

bool brings_edit(AgentAct act) { return act == AgentAct::kCheck || act == AgentAct::kBring; }

}  // namespace

Agent::Agent(std::string name, AgentTopics topics, AgentPorts ports)
    : name_(std::move(name)), topics_(std::move(topics)), ports_(std::move(ports)) {}

void Agent::take(const mqtt::Event& event) {
  using Kind = mqtt::Event::Kind;
  if (event.kind == Kind::kConnected) return connected();
  if (event.kind == Kind::kLost) {
    if (connected_) ports_.say("the broker is gone: " + event.text);
    connected_ = false;
    return;
  }
  const mqtt::Message& message = event.message;
  if (message.topic == topics_.of(name_, kAgentDesired)) return desired(message.payload);
  piece(message);
}

// The broker may have forgotten everything; what it still holds is given again.
void Agent::connected() {
  connected_ = true;
  waits_ = false;
  ports_.say("connected to the broker");
  sent_about_.clear();
  sent_status_.clear();
  look();
  (void)ports_.broker.publish(topics_.of(name_, kAgentOnline), text_bytes("1"), true);
  if (!ports_.memory.answer().empty()) {
    (void)ports_.broker.publish(topics_.of(name_, kAgentAnswer), ports_.memory.answer(), true);
  }
  if (pieces_) (void)ports_.broker.subscribe(topics_.file(pieces_->file().digest, "+"));
  (void)ports_.broker.subscribe(topics_.of(name_, kAgentDesired));
}

void Agent::desired(base::ByteSpan payload) {
  if (payload.empty()) {  // somebody has taken it away
    waits_ = false;
    return;
  }
  const bool same = std::ranges::equal(payload, ports_.memory.order());
  if (same && !ports_.memory.answer().empty()) {
    (void)ports_.broker.publish(topics_.of(name_, kAgentAnswer), ports_.memory.answer(), true);
    return;
  }
  const base::Digest id = base::sha256(payload);
  if (order_ && order_id_ == id) return;  // at work
  base::Result<AgentOrder> order = admit(payload);
  if (!order.ok()) return say_refused(id, order.error());
  if (is_question(order->act)) {
    question_.assign(payload.begin(), payload.end());
    if (order_) return;  // it waits until that has ended
  } else {
    waits_ = false;
  }
  forget_work();
  begin(id, std::move(*order));
}

// The answer to what came before stands.
void Agent::say_refused(const base::Digest& id, const base::Error& why) {
  ports_.say("order refused: " + base::to_string(why));
  AgentAnswer refusal;
  refusal.order = id;
  refusal.row.outcome = FleetOutcome::kRefused;
  refusal.row.why = why;
  (void)ports_.broker.publish(topics_.of(name_, kAgentAnswer), encode(refusal), false);
}

base::Result<AgentOrder> Agent::admit(base::ByteSpan payload) {
  if (payload.size() > kMostOrderBytes) {
    return base::Error{base::Refusal::kTooMany, "an order of more than 256 KiB"};
  }
  if (!online_change::has_signed_magic(payload)) {
    return base::Error{base::Refusal::kUnsigned, "an order that nobody has signed"};
  }
  base::Bytes content(payload.begin(), payload.end());
  base::Result<online_change::SignedFile> file = online_change::open_signed(content);
  if (!file.ok()) return file.error();
  base::Result<AgentOrder> order = decode_agent_order(content);
  base::Status taken = take_statement(*file, payload, order.ok() && is_question(order->act));
  if (!taken.ok()) return taken.error();
  return order;
}

// It is remembered before it is marked as taken: a crash between the two leaves it to be done. A
// question is neither: late or again, it changes nothing.
base::Status Agent::take_statement(const online_change::SignedFile& file, base::ByteSpan payload,
                                   bool asks) {
  const online_change::Statement& said = file.statement;
  if (said.target != name_) {
    return base::Error{base::Refusal::kOtherTarget,
                       base::joined({"signed for ", said.target.empty() ? "any" : said.target,
                                     ", and orders are for one controller alone, here ", name_})};
  }
  const int64_t now = ports_.wall_s();
  base::Result<Signed> who = ports_.trust.check(file, online_change::SignedKind::kOrder, now);
  const bool again = asks || std::ranges::equal(payload, ports_.memory.order());
  if (!who.ok() && who.error().refusal == base::Refusal::kReplayed && again) {
    return ports_.trust.check_again({"the key of before", said}, now);
  }
  if (!who.ok()) return who.error();
  if (asks) return base::Ok{};
  base::Status kept = ports_.memory.begin(payload);
  return kept.ok() ? ports_.trust.take(*who, now) : kept;
}

void Agent::begin(const base::Digest& id, AgentOrder order) {
  order_id_ = id;
  order_ = std::move(order);
  if (!is_question(order_->act)) {
    about_.plan = order_->plan;
    about_.trace = {};
  }
  go_on();
}

void Agent::begin_waiting() {
  if (order_ || !connected_) return;
  if (!question_.empty()) return desired(std::exchange(question_, {}));
  if (!waits_ || !about_.trace.answers) return;
  waits_ = false;
  desired(base::Bytes(ports_.memory.order()));
}

void Agent::forget_work() {
  if (pieces_) (void)ports_.broker.unsubscribe(topics_.file(pieces_->file().digest, "+"));
  pieces_.reset();
  order_.reset();
  package_.clear();
  has_package_ = false;
}

void Agent::go_on() {
  const bool shows = order_->act == AgentAct::kShow;
  if (!shows && order_->fleet.digest != fleet_digest_) return want(order_->fleet);
  if (brings_edit(order_->act) && !has_package_) return want(order_->package);
  carry_out();
}

void Agent::want(const AgentFile& file) {
  pieces_.emplace(file);
  waits_since_ms_ = ports_.now_ms();
  if (!order_->source.empty()) {
    base::Result<base::Bytes> all =
        ports_.fetch(order_->source + "/" + base::to_hex(file.digest), file.size);
    if (all.ok() && base::sha256(*all) != file.digest) {
      all = base::Error{base::Refusal::kBadHash, order_->source + ": another file is there"};
    }
    return came(std::move(all));
  }
  if (pieces_->whole()) return came(pieces_->take());
  base::Status asked = ports_.broker.subscribe(topics_.file(file.digest, "+"));
  // Without a connection it is asked for again with the next one.
  if (!asked.ok() && asked.error().refusal != base::Refusal::kNotRunning) refuse(asked.error());
}

void Agent::piece(const mqtt::Message& message) {
  if (!pieces_) return;
  const std::string topic = topics_.file(pieces_->file().digest, "");
  if (!message.topic.starts_with(topic)) return;
  if (!pieces_->add(std::string_view(message.topic).substr(topic.size()), message.payload)) return;
  waits_since_ms_ = ports_.now_ms();
  if (!pieces_->whole()) return;
  (void)ports_.broker.unsubscribe(topic + "+");
  came(pieces_->take());
}

void Agent::came(base::Result<base::Bytes> bytes) {
  const base::Digest digest = pieces_->file().digest;
  pieces_.reset();
  if (!bytes.ok()) return refuse(bytes.error());
  if (digest == order_->fleet.digest) {
    fleet_ = std::move(*bytes);
    fleet_digest_ = digest;
  } else {
    package_ = std::move(*bytes);
    has_package_ = true;
  }
  go_on();
}

// Not kept: the order may come again.
void Agent::refuse(const base::Error& why) {
  AgentAnswer out;
  out.row.outcome = FleetOutcome::kRefused;
  out.row.why = why;
  answer(std::move(out), false);
}

void Agent::carry_out() {
  if (order_->act == AgentAct::kShow) return answer(show(), false);
  base::Result<FleetEdit> edit = ports_.open_edit(fleet_);
  if (!edit.ok()) return refuse(edit.error());
  edit->matching = order_->matching;
  AgentAnswer done = do_it(*edit);
  const bool kept = done.ends() && !is_question(order_->act);
  answer(std::move(done), kept);
}

static SwitchOptions agent_switch(const AgentOrder& order) {
  SwitchOptions how;
  how.stage_flags = order.stage_flags;
  how.switch_flags = order.switch_flags;
  how.note = order.note;
  how.guard = order.guard;
  how.window_ms = order.window_ms;
  how.ask = false;
  how.json = true;
  how.dry_run = order.act == AgentAct::kCheck;
  if (how.dry_run) how.stage_flags |= vm::kRehearsal;
  return how;
}

AgentAnswer Agent::do_it(const FleetEdit& edit) {
  AgentAnswer out;
  FleetAccess access;
  access.connect = [this](const FleetMember&) { return ports_.connect(); };
  access.package = [this](const base::Bytes& running, size_t) -> base::Result<base::Bytes> {
    const base::Result<ir::VerifiedImage> image = ir::verify(running);
    if (!image.ok()) return image.error();
    if (image->digest() == order_->base) return package_;
    return base::Error{base::Refusal::kStaleBase,
                       "the package is for " + base::short_hex(order_->base) + ", and here runs " +
                           base::short_hex(image->digest())};
  };
  const FleetMember member{name_, name_};
  const SwitchOptions how = agent_switch(*order_);
  if (order_->act == AgentAct::kBring) out.trace = trace(order_->plan);
  if (order_->act == AgentAct::kMakeFinal) {
    out.row = FleetAccept(edit, how, access).visit(member);
  } else if (order_->act == AgentAct::kTakeBack) {
    out.row = FleetUndo(edit, how, access).visit(member);
  } else if (out.trace.switched) {  // the order came before this agent ended in the middle of it
    out.row.outcome = FleetOutcome::kDone;
    out.row.from = out.trace.from;
  } else {
    out.row = FleetChange(edit, how, access).visit(member);
  }
  if (!how.dry_run) out.trace = trace(order_->plan);
  return out;
}

// Whoever has the sources links the edit into the program that runs here.
AgentAnswer Agent::show() {
  AgentAnswer out;
  base::Result<ControllerClient> client = ports_.connect();
  base::Result<vm::StatusReport> status =
      client.ok() ? client->status() : base::Result<vm::StatusReport>(client.error());
  base::Result<base::Bytes> image =
      status.ok() ? client->image() : base::Result<base::Bytes>(status.error());
  out.row.place = name_;
  if (!image.ok()) {
    out.row.outcome = FleetOutcome::kUnreachable;
    out.row.why = image.error();
    return out;
  }
  out.row.outcome = FleetOutcome::kReached;
  out.row.from = status->running;
  out.row.program = status->name;
  out.shown = {base::sha256(*image), image->size()};
  const base::ByteSpan all = *image;
  for (uint64_t at = 0; at < all.size(); at += kAgentPiece) {
    const std::string topic = topics_.file(out.shown.digest, std::to_string(at / kAgentPiece));
    (void)ports_.broker.publish(
        topic, all.subspan(at, std::min<uint64_t>(kAgentPiece, all.size() - at)), true);
  }
  return out;
}

PlanTrace Agent::trace(const std::string& plan) {
  base::Result<ControllerClient> client = ports_.connect();
  if (!client.ok() || plan.empty()) return {};
  return find_plan(*client, plan, about_.trace);
}

void Agent::answer(AgentAnswer done, bool kept) {
  done.order = order_id_;
  ports_.say(base::joined({"plan ", order_->plan, ": ", outcome_name(done.row.outcome),
                           done.row.why ? ": " + base::to_string(*done.row.why) : ""}));
  const base::Bytes bytes = encode(done);
  if (kept) {
    if (base::Status stored = ports_.memory.end(bytes); !stored.ok()) {
      ports_.say("the answer cannot be kept: " + base::to_string(stored.error()));
    }
  }
  const bool asked = is_question(order_->act);
  const bool last = asked && base::sha256(question_) == done.order;
  if (last) question_.clear();
  forget_work();
  say_state();  // before the answer: who reads it can rely on what is said of the controller
  (void)ports_.broker.publish(topics_.of(name_, kAgentAnswer), bytes, kept);
  if (!asked) waits_ = !done.ends();
  if (!question_.empty()) begin_waiting();
}

void Agent::look() {
  if (pieces_ && ports_.now_ms() - waits_since_ms_ > kPatienceMs) {
    return refuse({base::Refusal::kFileNotFound, "file " + base::short_hex(pieces_->file().digest) +
                                                     " does not come from the broker"});
  }
  say_state();
  begin_waiting();
}

void Agent::say_state() {
  base::Result<ControllerClient> client = ports_.connect();
  base::Result<vm::StatusReport> status =
      client.ok() ? client->status() : base::Result<vm::StatusReport>(client.error());
  if (!status.ok()) {
    about_.trace.answers = false;
    return publish_state(nullptr);
  }
  if (status->running != about_.running) {
    const base::Result<base::Bytes> image = client->image();
    if (!image.ok()) return;  // somebody changes it: the next look sees it
    base::Result<ir::VerifiedImage> verified = ir::verify(*image);
    if (!verified.ok()) return;
    about_.running = verified->digest();
    about_.program = verified->image().name;
    about_.parts = ir::parts_of(verified->image());
    if (auto facts = client->facts(); facts.ok()) facts_ = std::move(*facts);
  }
  about_.edits = status->edits;
  if (!about_.plan.empty()) {
    about_.trace = find_plan(*client, about_.plan, about_.trace);
  } else {
    about_.trace.answers = true;
  }
  publish_state(&*status);
}

void Agent::publish_state(const vm::StatusReport* status) {
  if (!connected_) return;
  std::string text = agent_status_json(name_, about_, status, facts_);
  if (text != sent_status_) {
    const base::Status sent =
        ports_.broker.publish(topics_.of(name_, kAgentStatus), text_bytes(text), true);
    if (sent.ok()) sent_status_ = std::move(text);  // else the next look says it
  }
  base::Bytes bytes = encode(about_);
  if (bytes == sent_about_) return;
  const base::Status sent = ports_.broker.publish(topics_.of(name_, kAgentAbout), bytes, true);
  if (sent.ok()) sent_about_ = std::move(bytes);
}

}  // namespace stvm
