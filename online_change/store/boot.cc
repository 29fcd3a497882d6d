#include "online_change/store/boot.h"

#include <algorithm>
#include <utility>

#include "ir/bytecode/no_program.h"
#include "online_change/store/retained_values.h"

namespace online_change {
namespace {

std::optional<ir::VerifiedImage> verified(const std::optional<StoredImage>& stored,
                                          std::string& why) {
  if (!stored) return std::nullopt;
  base::Result<ir::VerifiedImage> image = ir::verify(stored->bytes);
  const bool named = image.ok() && image->digest() == stored->digest;
  if (named && retained_bytes(image->image()).ok()) return *image;
  why = "the stored program " + base::short_hex(stored->digest) + ": " +
        (image.ok() ? "not what it is called" : base::to_string(image.error()));
  return std::nullopt;
}

bool fits(const ir::Image& image, const RetainRecord& record) {
  const base::Result<uint64_t> bytes = retained_bytes(image);
  return bytes.ok() && *bytes == record.values.size();
}

base::Error unfit() {
  return {base::Refusal::kNothingBoots, "they do not fit the program that they are of"};
}

// The newest values, in the layout of `image`.
base::Result<CarriedValues> values_for(const ir::VerifiedImage& image, const Recovered& found) {
  const RetainRecord& newest = *found.newest;
  if (newest.image == image.digest()) {
    if (!fits(image.image(), newest)) return unfit();
    return CarriedValues{newest.values, {}};
  }
  std::string why;
  const std::optional<ir::VerifiedImage> other = verified(found.other, why);
  if (!other || other->digest() != newest.image || !fits(other->image(), newest)) return unfit();
  const bool known = found.before && fits(image.image(), *found.before);
  if (!newest.trial && !known) return carry_retained(*other, newest.values, image);
  const base::Bytes before = known ? found.before->values : initial_retained(image.image());
  return carry_retained_back(*other, newest.values, image, before);
}

class Booting {
 public:
  Booting(Store& store, const std::string& who, int64_t time_ns)
      : store_(store), who_(who), time_ns_(time_ns), found_(store.take_recovered()) {}

  base::Result<Boot> run(const std::optional<ir::VerifiedImage>& given, bool create) {
    base::Result<Boot> boot = choose(given, create);
    if (boot.ok()) boot->steps = std::move(steps_);
    return boot;
  }

 private:
  base::Result<Boot> choose(const std::optional<ir::VerifiedImage>& given, bool create) {
    std::string why = found_.nothing;
    const std::optional<ir::VerifiedImage> stored = verified(found_.boots, why);
    if (!stored) store_.reject_boots();
    if (!stored && !given) return hold(why, create);
    if (given) {
      base::Result<uint64_t> bytes = retained_bytes(given->image());
      if (!bytes.ok()) return bytes.error();
    }
    const ir::VerifiedImage& first = stored ? *stored : *given;
    Boot boot{first, initial_retained(first.image()), {}, std::move(found_.alarms)};
    const bool same = !given || (stored && given->digest() == stored->digest());
    if (stored && same && found_.resumes && resume(*stored, boot)) {
      note_alarms();
      note(Event::kResumed, stored->digest(), boot.image.digest(),
           std::to_string(boot.edits.size()) + " edit(s) are on trial still");
      note(Event::kStarted, {}, boot.image.digest(), {});
      return boot;
    }
    if (stored) {
      begin_with(*stored, boot);
    } else if (!is_new()) {
      begin_without(why, *given, boot);
    }
    if (given && (!stored || given->digest() != stored->digest())) install(*given, stored, boot);
    note_alarms();
    note(Event::kStarted, {}, boot.image.digest(), {});
    return boot;
  }

  JournalEntry entry(Event event, const base::Digest& from, const base::Digest& to,
                     std::string text) const {
    JournalEntry out;
    out.time_ns = time_ns_;
    out.event = event;
    out.who = who_;
    out.from = from;
    out.to = to;
    out.text = std::move(text);
    return out;
  }

  void note(Event event, const base::Digest& from, const base::Digest& to, std::string text) {
    steps_.push_back({BootStep::Kind::kNote, entry(event, from, to, std::move(text))});
  }

  // Those of the steps before, too.
  void note_alarms() {
    steps_.push_back({BootStep::Kind::kAlarms, entry(Event::kAlarm, {}, {}, {})});
  }

  // Nothing was ever stored, as far as anybody can tell.
  bool is_new() const {
    return found_.virgin && !store_.retained_program() && store_.history().empty();
  }

  // The accepted program is damaged, or the control records are. The newest retained values say
  // which program ran last, and whether it was on trial.
  base::Result<Boot> hold(const std::string& why, bool create) {
    if (is_new()) {
      if (create) return hold_nothing(why);
      return base::Error{base::Refusal::kFileNotFound, why};
    }
    const std::optional<RetainRecord>& newest = found_.newest;
    const auto likely = [&](const StoredImage& image) {
      return newest && (newest->image == image.digest) != newest->trial;
    };
    const std::vector<StoredImage>& held = found_.held;
    for (size_t i = 0; i < 2 * held.size(); ++i) {  // the likely ones first
      const StoredImage& stored = held[i % held.size()];
      if (likely(stored) != (i < held.size())) continue;
      std::string unused;
      const std::optional<ir::VerifiedImage> image = verified(stored, unused);
      if (!image) continue;
      Boot boot{*image, initial_retained(image->image()), {}, std::move(found_.alarms)};
      const bool own = newest && newest->image == image->digest();
      if (own && fits(image->image(), *newest)) boot.retained = newest->values;
      if (!newest) take(no_values(), boot);
      note_alarms();
      boot.fault = why + "; program " + base::short_hex(image->digest()) +
                   " is stored, too: `stvm restart` runs it";
      note(Event::kAlarm, {}, image->digest(), boot.fault);
      return boot;
    }
    return hold_nothing(why);
  }

  // Changes nothing of what is stored, but for the journal.
  base::Result<Boot> hold_nothing(const std::string& why) {
    Boot boot{ir::no_program(), {}, {}, std::move(found_.alarms)};
    boot.fault = why + (found_.virgin ? "" : ", and no other program is intact") +
                 "; `stvm change SOURCES|IMAGE` brings one";
    if (const std::optional<base::Digest> kept = store_.retained_program()) {
      boot.fault += "; retained values of " + base::short_hex(*kept) +
                    " are stored, and come back with that very image";
    }
    note_alarms();
    note(Event::kAlarm, {}, {}, boot.fault);
    return boot;
  }

  base::Result<CarriedValues> no_values() const {
    return base::Error{base::Refusal::kNothingBoots, found_.no_newest};
  }

  // What `boot` holds already stays where there are none.
  static void take(base::Result<CarriedValues> values, Boot& boot) {
    if (values.ok()) boot.retained = std::move(values->values);
    const std::string why = values.ok() ? values->alarm : "retained values: " + values.error().text;
    if (!why.empty()) boot.alarms.push_back(why);
  }

  // Of `image`, where they are the newest ones; also where no slot has the program any more.
  std::optional<base::Bytes> own_values(const ir::VerifiedImage& image) const {
    std::optional<base::Bytes> own = store_.retained_of(image.digest());
    const base::Result<uint64_t> bytes = retained_bytes(image.image());
    if (!own || !bytes.ok() || own->size() != *bytes) return std::nullopt;
    return own;
  }

  // Of a trial that is lost, as undo of edit by edit would leave them. Nullopt: the edits do not
  // lead from `accepted` to it, or the newest values are of none of its versions.
  std::optional<base::Result<CarriedValues>> values_of_lost_trial(
      const ir::VerifiedImage& accepted) const {
    if (!found_.trial_lost) return std::nullopt;
    const base::Result<std::vector<StoredEdit>> all = store_.edits();
    if (!all.ok()) return std::nullopt;
    ir::VerifiedImage image = accepted;
    const std::optional<std::vector<ResumedEdit>> edits =
        follow_edits(way_between(*all, accepted.digest(), *found_.trial_lost), accepted, image);
    if (!edits) return std::nullopt;
    size_t above = edits->size();  // edits whose version `image` is
    std::optional<base::Bytes> own = own_values(image);
    while (!own && above > 0) {
      image = (*edits)[--above].before;
      own = own_values(image);
    }
    if (!own) return std::nullopt;
    CarriedValues out{std::move(*own), {}};
    while (above > 0) {
      const ResumedEdit& edit = (*edits)[--above];
      base::Result<CarriedValues> below =
          carry_retained_back(image, out.values, edit.before, edit.stored.retained);
      if (!below.ok()) return below;
      image = edit.before;
      out.values = std::move(below->values);
      if (!below->alarm.empty()) out.alarm += (out.alarm.empty() ? "" : "; ") + below->alarm;
    }
    return out;
  }

  void begin_with(const ir::VerifiedImage& image, Boot& boot) {
    if (auto values = values_of_lost_trial(image)) {
      take(std::move(*values), boot);
    } else {
      take(found_.newest ? values_for(image, found_) : no_values(), boot);
    }
    boot.trial_lost = found_.trial_lost;
    // Noted first: a cut in between notes it twice, not never.
    if (boot.trial_lost) note(Event::kTrialLost, *boot.trial_lost, image.digest(), {});
    steps_.push_back({BootStep::Kind::kSettle});
  }

  // What is given comes in place of a program that cannot be read: of the retained values, those
  // whose layout is known.
  void begin_without(const std::string& why, const ir::VerifiedImage& given, Boot& boot) {
    base::Result<CarriedValues> values = values_left_for(given);
    if (values.ok()) boot.alarms.push_back(why + "; the retained values are taken over");
    if (!values.ok()) {
      boot.alarms.push_back("cold start: " + why + "; retained values: " + values.error().text);
    } else {
      take(std::move(values), boot);
    }
  }

  base::Result<CarriedValues> values_left_for(const ir::VerifiedImage& given) const {
    if (std::optional<base::Bytes> own = own_values(given)) {
      return CarriedValues{std::move(*own), {}};
    }
    if (!found_.newest) return no_values();
    for (const StoredImage& stored : found_.held) {
      if (found_.newest->image != stored.digest) continue;
      std::string unused;
      const std::optional<ir::VerifiedImage> image = verified(stored, unused);
      if (!image || !fits(image->image(), *found_.newest)) break;
      return carry_retained(*image, found_.newest->values, given);
    }
    return unfit();
  }

  // What the newest values are of: the newest edit mostly; one below it, where a cut came before it
  // had saved any; the one above it, where a cut came after an undo. That one is not in the list
  // when it was not to boot: what it had dropped begins anew then.
  base::Result<CarriedValues> values_on_trial(const std::vector<StoredEdit>& all,
                                              const Boot& boot) const {
    const ir::VerifiedImage& image = boot.image;
    if (std::optional<base::Bytes> own = own_values(image)) {
      return CarriedValues{std::move(*own), {}};
    }
    if (!found_.newest) return no_values();
    const RetainRecord& newest = *found_.newest;
    for (const ResumedEdit& edit : boot.edits) {
      const bool of_it = edit.before.digest() == newest.image;
      if (of_it && fits(edit.before.image(), newest)) {
        return carry_retained(edit.before, newest.values, image);
      }
    }
    std::string why;
    const std::optional<ir::VerifiedImage> above = verified(found_.other, why);
    for (const StoredEdit& edit : all) {
      const bool of_it = above && above->digest() == newest.image && edit.to == newest.image;
      if (of_it && edit.from == image.digest() && fits(above->image(), newest)) {
        return carry_retained_back(*above, newest.values, image, edit.retained);
      }
    }
    if (above && above->digest() == newest.image && fits(above->image(), newest)) {
      return carry_retained_back(*above, newest.values, image, initial_retained(image.image()));
    }
    return unfit();
  }

  // D4. What cannot be resumed is lost, which is said.
  bool resume(const ir::VerifiedImage& accepted, Boot& boot) {
    const base::Result<std::vector<StoredEdit>> all = store_.edits();
    const base::Digest& trial = *found_.trial_lost;
    Boot next{accepted, {}, {}, {}};
    std::optional<std::vector<ResumedEdit>> edits;
    if (all.ok()) {
      edits = follow_edits(way_between(*all, accepted.digest(), trial), accepted, next.image);
    }
    if (!edits || edits->empty()) {
      boot.alarms.push_back("the edits on trial cannot be resumed: " +
                            (all.ok() ? std::string("no stored edits lead to the program on trial")
                                      : all.error().text));
      return false;
    }
    next.edits = std::move(*edits);
    next.alarms = std::move(boot.alarms);
    next.retained = initial_retained(next.image.image());
    take(values_on_trial(*all, next), next);
    steps_.push_back({BootStep::Kind::kMakeWhole});
    boot = std::move(next);
    return true;
  }

  // Durable before it runs. The values of the program before are stored in its own layout first, so
  // that a cut in between finds them.
  void install(const ir::VerifiedImage& given, const std::optional<ir::VerifiedImage>& stored,
               Boot& boot) {
    if (stored) {
      boot.before = stored->digest();
      boot.values_before = std::move(boot.retained);
      boot.retained = initial_retained(given.image());
      take(carry_retained(*stored, boot.values_before, given), boot);
    }
    const base::Digest from = boot.before.value_or(base::Digest{});
    steps_.push_back({BootStep::Kind::kInstall});
    note(Event::kInstalled, from, given.digest(), {});
    boot.image = given;
  }

  Store& store_;
  std::string who_;
  int64_t time_ns_;
  Recovered found_;
  std::vector<BootStep> steps_;
};

}  // namespace

base::Result<Boot> choose_boot(Store& store, const std::optional<ir::VerifiedImage>& given,
                               const std::string& who, int64_t time_ns, bool create) {
  return Booting(store, who, time_ns).run(given, create);
}

static base::Status install(Store& store, const Boot& boot) {
  if (boot.before && !store.retained_fits()) {
    base::Status saved = store.save_retained(*boot.before, 0, boot.values_before);
    if (!saved.ok()) return saved;
  }
  return store.install({boot.image.digest(), boot.image.encoded()}, boot.retained.size());
}

base::Status carry_out(Store& store, Boot& boot) {
  for (BootStep& step : std::exchange(boot.steps, {})) {
    base::Status done = base::Ok{};
    if (step.kind == BootStep::Kind::kNote) store.note(std::move(step.row));
    if (step.kind == BootStep::Kind::kAlarms) {
      for (const std::string& alarm : boot.alarms) {
        step.row.text = alarm;
        store.note(step.row);
      }
    }
    if (step.kind == BootStep::Kind::kSettle) done = store.settle();
    if (step.kind == BootStep::Kind::kMakeWhole) done = store.make_whole();
    if (step.kind == BootStep::Kind::kInstall) {
      done = install(store, boot);
      if (!done.ok()) return done;
    }
    if (!done.ok()) boot.alarms.push_back(done.error().text);
  }
  return base::Ok{};
}

base::Result<Boot> boot(Store& store, const std::optional<ir::VerifiedImage>& given,
                        const std::string& who, int64_t time_ns, bool create) {
  base::Result<Boot> boot = choose_boot(store, given, who, time_ns, create);
  if (!boot.ok()) return boot;
  base::Status done = carry_out(store, *boot);
  if (!done.ok()) return done.error();
  return boot;
}

}  // namespace online_change
