#include "tests/sim/world.h"

#include <cstdio>

#include "tests/differential/edit.h"
#include "tests/differential/generator.h"

namespace sim {
namespace {

std::optional<golden::Program> compiled(const differential::Program& tree) {
  golden::TestFile test;
  test.name = "sim.st";
  test.versions.push_back(differential::print(tree));
  golden::Outcome outcome;
  base::Result<golden::Program> program = golden::compile(test, 0, outcome);
  if (!program.ok()) return std::nullopt;
  return std::move(*program);
}

bool has_events(const golden::Program& program) {
  for (const ir::Task& task : program.program.tasks) {
    if (task.event != ir::kNoEvent) return true;
  }
  return false;
}

}  // namespace

World::World(uint64_t seed, bool trace) : random_(seed), trace_(trace) {}
World::~World() = default;

void World::say(const std::string& text) {
  if (trace_)
    std::printf("%8llu %s\n", static_cast<unsigned long long>(tally_.boundaries), text.c_str());
}

void World::refused(const base::Error& error) {
  ++tally_.refusals;
  say("  refused " + base::to_string(error).substr(0, 100));
  require(error.refusal != base::Refusal::kInternal, "internal: " + error.text);
}

bool World::begin() {
  auto first = std::make_shared<Version>();
  first->tree = differential::random_program(random_.next(), false);
  std::optional<golden::Program> program = compiled(first->tree);
  if (!program || has_events(*program)) return false;
  first->compiled = std::move(*program);
  base::Result<ir::VerifiedImage> image = golden::link(first->compiled, nullptr, false);
  if (!image.ok()) return false;
  versions_[image->digest()] = first_ = first;
  boot(*image);
  return true;
}

bool World::run(int steps) {
  const int64_t since_ns = clock_.now_ns();
  if (!begin()) return false;
  for (int i = 0; i < steps; ++i) step();
  tally_.plant_ns += static_cast<uint64_t>(clock_.now_ns() - since_ns);
  return true;
}

void World::switched(const Snapshot& before, const Snapshot& now) {
  ++tally_.switches;
  events_->switched();
  require(may_delay_ || clock_.now_ns() <= controller_->next_cycle_ns(),
          "a switch delayed a release");
  try {
    check_kept(before, now);
  } catch (const Violation&) {
    say("version before:\n" + differential::print(versions_.at(before.image().digest())->tree));
    say("version behind:\n" + differential::print(versions_.at(now.image().digest())->tree));
    throw;
  }
  // A change, too, may lead to the version from before.
  const size_t edits = service_->edits_on_trial();
  const bool back = edits < std::exchange(edits_, edits) && !on_trial_.empty() &&
                    on_trial_.back().before == now.image().digest();
  if (!back) {
    on_trial_.push_back({before.image().digest(), before});
    return;
  }
  const std::optional<Snapshot> at_switch = std::move(on_trial_.back().at_switch);
  on_trial_.pop_back();
  if (at_switch) check_restored(*at_switch, before, now);
}

World::Hand World::connect() {
  Hand hand;
  auto way = std::make_unique<FaultyTransport>(*service_);
  hand.way = way.get();
  hand.client.emplace(std::move(way));
  base::Result<vm::StatusReport> seen = hand.client->status();
  require(seen.ok(), "a controller says what it runs");
  hand.seen = *seen;
  return hand;
}

void World::bad_luck(Hand& hand) {
  if (!random_.one_in(4)) return;
  const auto fault = static_cast<Fault>(1 + random_.below(kFaultCount - 1));
  hand.way->arm(fault, random_.below(6), random_.next());
  ++tally_.faults;
  events_->any_refusal();
  say("  with a fault of the connection");
}

vm::StatusReport World::settled() {
  vm::StatusReport now = connect().seen;
  require(now.running == controller_->verified().digest(), "status names what runs");
  require((now.edits != 0) == (now.previous != base::Digest{}),
          "a trial has a version to go back to");
  require(now.edits <= on_trial_.size(), "each edit on trial was switched to");
  on_trial_.erase(on_trial_.begin(), on_trial_.end() - static_cast<ptrdiff_t>(now.edits));
  edits_ = now.edits;
  for (const vm::TaskStatus& task : now.tasks) {
    require(task.missed == 0, "a release of " + task.name + " was missed");
  }
  return now;
}

std::shared_ptr<World::Version> World::edited_version(const base::Digest& base) {
  const auto known = versions_.find(base);
  require(known != versions_.end(), "what runs is a version that somebody made");
  const bool large = differential::print(known->second->tree).size() > most_text_;
  const differential::Program& from = large ? first_->tree : known->second->tree;
  for (int attempt = 0; attempt < 5; ++attempt) {
    auto next = std::make_shared<Version>();
    next->tree = differential::edited(from, random_.next());
    std::optional<golden::Program> program = compiled(next->tree);
    if (!program || has_events(*program)) continue;
    next->compiled = std::move(*program);
    return next;
  }
  return nullptr;
}

std::optional<base::Bytes> World::package_for(const base::Digest& base, Version& next) {
  require(base == controller_->verified().digest(), "the base is what runs");
  auto image = golden::link(next.compiled, &controller_->image(), random_.one_in(6));
  if (!image.ok()) {
    require(image.error().refusal == base::Refusal::kOutOfMemory, base::to_string(image.error()));
    return std::nullopt;
  }
  versions_[image->digest()] = std::make_shared<Version>(next);
  auto package = online_change::make_package(controller_->verified().encoded(), image->encoded());
  require(package.ok(), "a plan between two versions");
  return online_change::encode(*package);
}

uint32_t World::strategy() { return random_.one_in(2) ? vm::kByStandby : 0u; }

void World::step() {
  ++tally_.steps;
  act(disk_failed_ ? 23u : random_.below(25));
  check_events();
}

void World::act(uint32_t kind) {
  if (kind < 6) return let_run();
  if (kind < 11) return change();
  if (kind < 13) return undo();
  if (kind < 15) return accept();
  if (kind == 15) return bad_package();
  if (kind == 16) return two_tools();
  if (kind == 17) return write_values();
  if (kind == 18) return force();
  if (kind == 19) return restart();
  if (kind == 20) return save();
  if (kind == 21) return disk_fault();
  if (kind == 22) return device_fault();
  return power_cut();
}

void World::let_run() {
  const uint32_t count = 1 + random_.below(5);
  say("run " + std::to_string(count));
  for (uint32_t i = 0; i < count; ++i) {
    for (size_t byte = 0; byte < controller_->image().input_bytes; ++byte) {
      devices_.set_input(byte, static_cast<uint8_t>(random_.next()));
    }
    boundary_->cycle();
  }
}

base::Status World::try_change(Hand& hand, base::ByteSpan package, uint32_t flags) {
  base::Status staged = hand.client->stage(package, strategy());
  if (!staged.ok()) return staged;
  base::Result<stvm::FatePage> page = hand.client->fates();
  if (!page.ok()) return page.error();
  auto report = hand.client->make_switch(flags);
  if (!report.ok()) return report.error();
  require(report->missed == 0, "a switch missed no release");
  require(report->counts.total() == page->counts.total(), "what was done is what was said");
  return base::Ok{};
}

void World::change() {
  Hand hand = connect();
  say("change of " + base::short_hex(hand.seen.running) + ", state " + hand.seen.change);
  std::shared_ptr<Version> next = edited_version(hand.seen.running);
  if (!next) return;
  std::optional<base::Bytes> package = package_for(hand.seen.running, *next);
  if (!package) return;
  const uint32_t flags =
      (random_.one_in(3) ? 0u : vm::kAllowLoss) | (random_.one_in(2) ? vm::kAllowOverrun : 0u) |
      (random_.one_in(5) ? vm::kPermanent : 0u) | (random_.one_in(3) ? vm::kLastEditBoots : 0u);
  // Until it is accepted, one that is permanent is on trial by its own policy, but loses no edit
  // below it that boots.
  const bool permanent = (flags & vm::kPermanent) != 0;
  const bool last_edit =
      (flags & vm::kLastEditBoots) != 0 || (permanent && hand.seen.last_edit_boots);
  if (!last_edit) may_boot_.push_back(hand.seen.boots_next);
  if (last_edit || permanent)
    may_boot_.push_back(ir::digest(online_change::decode(*package)->image));
  bad_luck(hand);
  boundary_->guard("a change that was not switched");
  may_delay_ = (flags & vm::kAllowOverrun) != 0;
  base::Status done = try_change(hand, *package, flags);
  may_delay_ = false;
  boundary_->guard("");
  if (!done.ok()) refused(done.error());
  told_refused(hand, done);
  const vm::StatusReport now = settled();
  const bool lost = hand.way->lost();
  if (done.ok() && !permanent && now.running == hand.seen.running && given_back()) {
    require(now.edits == hand.seen.edits, "what was given back is not on trial");
  } else if (done.ok()) {
    require(now.running != hand.seen.running, "a change that was answered runs");
    require(now.edits == (permanent ? 0 : hand.seen.edits + 1), "and is on trial until accepted");
    last_package_ = std::move(*package);
  } else if (!lost && !(permanent && disk_failed_)) {
    require(now.running == hand.seen.running, "a change that was refused does not run");
  }
  if (now.running == hand.seen.running) {
    require(now.boots_next == hand.seen.boots_next, "only accept changes what boots next");
  }
  if (now.change == "prepared" && random_.one_in(2)) {
    (void)connect().client->call({.command = vm::Command::kCancel}).ok();
  }
}

void World::bad_package() {
  Hand hand = connect();
  std::shared_ptr<Version> next = edited_version(hand.seen.running);
  if (!next) return;
  std::optional<base::Bytes> package = package_for(hand.seen.running, *next);
  if (!package) return;
  base::Bytes bad = *package;
  const uint32_t kind = random_.below(3);
  if (kind == 0) {
    bad.resize(random_.below(static_cast<uint32_t>(bad.size())));
  } else if (kind == 1) {
    const uint32_t bit = random_.below(static_cast<uint32_t>(bad.size() * 8));
    bad[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
  } else {
    bad = last_package_;
  }
  // The last one fits again when it was undone.
  base::Result<online_change::Package> last = online_change::decode(last_package_);
  if (kind == 2 && last.ok() && last->base == hand.seen.running) return;
  say("bad package " + std::to_string(kind));
  boundary_->guard("a bad package");
  base::Status staged = hand.client->stage(bad, strategy());
  boundary_->guard("");
  require(!staged.ok(), "a bad package is refused");
  refused(staged.error());
  told_refused(hand, staged.error());
  require(settled().running == hand.seen.running, "and nothing else happens");
}

// Whoever is second does not switch what the first one looked at, and the other way round.
void World::two_tools() {
  Hand one = connect();
  Hand two = connect();
  say("two tools");
  std::shared_ptr<Version> a = edited_version(one.seen.running);
  std::shared_ptr<Version> b = edited_version(one.seen.running);
  if (!a || !b) return;
  std::optional<base::Bytes> first = package_for(one.seen.running, *a);
  std::optional<base::Bytes> second = package_for(one.seen.running, *b);
  if (!first || !second || *first == *second) return;
  boundary_->guard("a change of one of two tools");
  base::Status staged = one.client->stage(*first, strategy());
  base::Status other = two.client->stage(*second, strategy());
  auto report = one.client->make_switch(vm::kAllowLoss);
  auto late = two.client->make_switch(vm::kAllowLoss);
  boundary_->guard("");
  require(!(report.ok() && late.ok()), "one of two tools switches at most");
  told_refused(one, staged);
  told_refused(two, other);
  if (!report.ok()) told_refused(one, report.error());
  if (!late.ok()) told_refused(two, late.error());
  const vm::StatusReport now = settled();
  if (!report.ok() && !late.ok()) {
    require(now.running == one.seen.running, "none switched, so the old program runs");
    (void)connect().client->call({.command = vm::Command::kCancel}).ok();
    return;
  }
  base::Result<online_change::Package> winner =
      online_change::decode(report.ok() ? *first : *second);
  const bool back = now.running == one.seen.running && given_back();
  require(back || (winner.ok() && ir::digest(winner->image) == now.running),
          "each tool switches its own change");
}

void World::undo() {
  Hand hand = connect();
  say("undo, state " + hand.seen.change);
  bad_luck(hand);
  const bool trial = hand.seen.edits != 0;
  // The edit below may have another policy than the one that goes.
  if (trial) may_boot_.insert(may_boot_.end(), {hand.seen.boots_next, hand.seen.previous});
  auto report = hand.client->undo("", {vm::kWithLoss});
  const vm::StatusReport now = settled();
  if (report.ok()) {
    require(trial && now.running == hand.seen.previous, "undo brings the previous program back");
    require(report->missed == 0, "an undo missed no release");
  } else {
    refused(report.error());
    told_refused(hand, report.error());
    const bool may_be = hand.way->lost() && trial && now.running == hand.seen.previous;
    require(may_be || now.running == hand.seen.running, "an undo that was refused does nothing");
  }
  require(now.boots_next == hand.seen.boots_next, "undo does not change what boots next");
}

void World::accept() {
  Hand hand = connect();
  say("accept, state " + hand.seen.change);
  bad_luck(hand);
  const bool trial = hand.seen.edits != 0;
  if (trial) may_boot_.push_back(hand.seen.running);
  boundary_->guard("accept");
  base::Result<base::Bytes> done = hand.client->call({.command = vm::Command::kAccept});
  boundary_->guard("");
  const vm::StatusReport now = settled();
  require(now.running == hand.seen.running, "accept does not change what runs");
  const bool lost = hand.way->lost();
  if (!done.ok()) refused(done.error());
  const bool nothing = !done.ok() && done.error().refusal == base::Refusal::kNothingToUndo;
  if (!done.ok() && !nothing) told_refused(hand, done.error());
  if (done.ok() && !lost) {  // else a bit that was damaged may have made another request of it
    require(trial, "only a trial can be accepted");
    require(now.boots_next == now.running && now.edits == 0, "what is accepted boots next");
  } else {
    require(
        (lost && trial && now.boots_next == now.running) || now.boots_next == hand.seen.boots_next,
        "an accept that was refused changes nothing");
  }
}

void World::write_values() {
  Hand hand = connect();
  base::Result<vm::Values> all = hand.client->list("*");
  require(all.ok(), "variables are listed");
  if (all->rows.empty()) return;
  const vm::ValueRow& row = all->rows[random_.below(static_cast<uint32_t>(all->rows.size()))];
  say("set " + row.path);
  bad_luck(hand);
  const char* const kValues[] = {"0", "1", "TRUE", "-5", "100000", "2.5", "'abc'", "T#1s"};
  base::Status done =
      hand.client->assign(vm::Command::kSet, {row.path}, {kValues[random_.below(8)]});
  if (!done.ok()) refused(done.error());
}

void World::force() {
  Hand hand = connect();
  base::Result<vm::Values> all = hand.client->list("*");
  require(all.ok(), "variables are listed");
  if (all->rows.empty() || random_.one_in(3)) {
    (void)hand.client->assign(vm::Command::kUnforce, {}, {}).ok();
    return;
  }
  const vm::ValueRow& row = all->rows[random_.below(static_cast<uint32_t>(all->rows.size()))];
  say("force " + row.path);
  base::Status done = hand.client->assign(vm::Command::kForce, {row.path}, {"1"});
  if (!done.ok()) refused(done.error());
}

void World::restart() {
  Hand hand = connect();
  say("restart");
  vm::Request request{.command = vm::Command::kRestart};
  request.flags = random_.below(4);
  base::Result<base::Bytes> done = hand.client->call(request);
  if (!done.ok()) refused(done.error());
  require(settled().running == hand.seen.running, "a restart keeps the program");
}

}  // namespace sim
