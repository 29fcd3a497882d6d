// R-10: events on their way to standard error, to memory and to the journal.
#include "tools/stvm/event_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "online_change/store/record.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/event_filter.h"
#include "tools/stvm/event_text.h"

namespace stvm {
namespace {

using online_change::Event;
using online_change::JournalEntry;
using online_change::Level;

constexpr int64_t kSecond = 1'000'000'000;

JournalEntry event(Event what, const std::string& text = {}, const std::string& source = {}) {
  static int64_t time_ns = 0;
  JournalEntry entry;
  entry.time_ns = ++time_ns;
  entry.event = what;
  entry.text = text;
  entry.source = source;
  return entry;
}

struct StoppedClocks : EventLog::Clocks {
  int64_t wall_ns() const override { return wall; }
  int64_t steady_ns() const override { return steady; }
  int64_t wall = 1'000 * kSecond;
  int64_t steady = kSecond;
};

// A log of a store in memory; what is written goes into a pipe.
class EventLogTest : public ::testing::Test {
 protected:
  EventLogTest() {
    EXPECT_EQ(::pipe2(pipe_, O_CLOEXEC), 0);
    begin();
  }
  ~EventLogTest() override {
    log_.reset();
    output_.reset();
    for (const int end : pipe_) ::close(end);
  }
  void begin() {
    log_.reset();
    output_ = std::make_shared<LogOutput>(pipe_[1], true);
    store_ = std::make_unique<online_change::Store>(disk_);
    log_ = std::make_unique<EventLog>(*store_, "Line", output_, clocks_);
  }
  // All lines so far.
  std::string written() {
    log_.reset();
    output_.reset();
    char bytes[65536];
    ::fcntl(pipe_[0], F_SETFL, O_NONBLOCK);
    const ssize_t size = ::read(pipe_[0], bytes, sizeof bytes);
    return size > 0 ? std::string(bytes, static_cast<size_t>(size)) : std::string();
  }
  std::vector<JournalEntry> from(uint64_t first, size_t most = 10'000) const {
    std::vector<JournalEntry> out;
    const base::Bytes page = log_->page(first, most * online_change::kSectorBytes);
    for (size_t at = 0; at < page.size(); at += online_change::kSectorBytes) {
      out.push_back(*online_change::decode_entry(
          base::ByteSpan(page).subspan(at, online_change::kSectorBytes)));
    }
    return out;
  }
  std::vector<std::string> texts() const {
    std::vector<std::string> out;
    for (const JournalEntry& entry : from(0)) out.push_back(event_text(entry));
    return out;
  }
  void trap(uint64_t cycle) {
    vm::ScanEvent* const scan = log_->ring().begin(vm::ScanEventKind::kTrap);
    if (scan == nullptr) return;
    scan->cycle = cycle;
    scan->source.add("task Fast");
    scan->text.add("a.st:1 (P): division");
    log_->ring().end();
  }

  int pipe_[2] = {-1, -1};
  StoppedClocks clocks_;
  sim::SimStorage disk_;
  std::shared_ptr<LogOutput> output_;
  std::unique_ptr<online_change::Store> store_;
  std::unique_ptr<EventLog> log_;
};

TEST_F(EventLogTest, R10_WhatIsNotedIsALineAndCanBeAskedFor) {
  store_->note(event(Event::kStarted));
  store_->note(event(Event::kSet, "a=1"));
  log_->take_device(vm::DeviceEvent::kLost, "press", "refused");
  EXPECT_EQ(texts(), (std::vector<std::string>{"started", "set: a=1",
                                               "device lost: device press: refused"}));
  EXPECT_EQ(from(2, 10).front().text, "a=1") << "by number";
  EXPECT_EQ(from(1, 2).size(), 2u) << "as many as are wanted";
  EXPECT_TRUE(from(4, 10).empty());
  EXPECT_EQ(written(),
            "<5>Line: started\n<6>Line: set: a=1\n"
            "<4>Line: device lost: device press: refused\n");
}

// What is durable is there after a restart, the rest is not.
TEST_F(EventLogTest, R10_ARestartLeavesWhatIsDurable) {
  store_->note(event(Event::kStarted));
  store_->note(event(Event::kSet, "a=1"));
  store_->note(event(Event::kForced, "b=2"));
  trap(7);
  log_->look();
  begin();
  EXPECT_EQ(texts(), (std::vector<std::string>{"started", "forced: b=2",
                                               "trap: task Fast: a.st:1 (P): division"}));
  const auto journal = online_change::read_journal(disk_, online_change::kJournalFile);
  ASSERT_TRUE(journal.ok());
  EXPECT_EQ(journal->size(), 1u) << "forces and traps do not push changes out";
  EXPECT_EQ(from(0, 10).back().cycle, 7u);
}

// A million traps in a second: the ring, its reader and the disk see few of them, and none is
// unsaid.
TEST_F(EventLogTest, R10_AFloodIsCountedAndSparesTheDisk) {
  uint64_t writes = 0;
  disk_.before_call = [&] { ++writes; };
  constexpr uint64_t kTraps = 1'000'000;
  for (uint64_t i = 0; i < kTraps; ++i) {
    trap(i);
    if (i % 50'000 == 0) log_->look();
  }
  log_->look();
  const uint64_t told = texts().size();
  EXPECT_EQ(told, EventLimits::kOfPlant);
  clocks_.steady += EventLimits::kPeriodNs;
  log_->look();
  uint64_t left_out = 0;
  const std::vector<std::string> all = texts();
  for (size_t i = told; i < all.size(); ++i) {
    const size_t and_at = all[i].find("... and ");
    ASSERT_NE(and_at, std::string::npos) << all[i];
    EXPECT_NE(all[i].find(" more like this in 10 s"), std::string::npos) << all[i];
    left_out += std::stoull(all[i].substr(and_at + 8));
  }
  EXPECT_EQ(told + left_out, kTraps);
  EXPECT_LT(writes, 40u);
}

// Their times are those of the wall clock when it happened, and the order is that of happening.
TEST_F(EventLogTest, R10_AClockThatStepsChangesNoOrder) {
  trap(1);
  log_->look();
  const int64_t first = from(0, 1).front().time_ns;
  clocks_.wall -= 500 * kSecond;
  store_->note(event(Event::kSet, "later"));
  trap(2);
  log_->look();
  const auto all = from(0, 10);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[1].text, "later");
  EXPECT_EQ(all[2].cycle, 2u);
  EXPECT_LT(all[2].time_ns, first);
}

TEST_F(EventLogTest, R10_MemoryIsBounded) {
  for (size_t i = 0; i < 3 * EventLog::kMostKept; ++i) store_->note(event(Event::kHangup));
  for (size_t i = 0; i < EventLog::kMostKept + 5; ++i) {
    store_->note(event(Event::kNewFolder, std::to_string(i)));
  }
  const auto all = from(0);
  ASSERT_EQ(all.size(), EventLog::kMostKept);
  EXPECT_EQ(all.front().text, "5");
  EXPECT_EQ(from(all.back().sequence, 10).size(), 1u);
}

TEST_F(EventLogTest, R10_AtTheEndCountsAreTold) {
  for (int i = 0; i < 12; ++i) log_->take_device(vm::DeviceEvent::kBack, "d", "online");
  const std::string lines = written();
  EXPECT_NE(lines.find("device back: device d: ... and 7 more like this in 1 s"), std::string::npos)
      << lines;
}

// --- standard error ------------------------------------------------------------------

std::string read_all(int descriptor) {
  std::string out;
  char bytes[4096];
  for (ssize_t size = 1; size > 0;) {
    size = ::read(descriptor, bytes, sizeof bytes);
    if (size > 0) out.append(bytes, static_cast<size_t>(size));
  }
  return out;
}

// "line 0", "line 1", ..., or in their place how many are missing.
void expect_in_order(const std::string& text, uint64_t count) {
  uint64_t next = 0;
  for (size_t at = 0, end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line.find(" lines are missing here") != std::string::npos) {
      next += std::stoull(line.substr(line.find("warning ") + 8));
    } else if (const size_t number = line.find("line "); number != std::string::npos) {
      ASSERT_EQ(std::stoull(line.substr(number + 5)), next) << line;
      ++next;
    }
  }
  EXPECT_EQ(next, count);
}

// A pipe that nobody reads takes 64 KiB: whoever adds lines goes on, and the end comes.
TEST(LogOutput, R10_APipeThatNobodyReadsHoldsNobodyUp) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  constexpr int kLines = 20'000;
  auto output = std::make_unique<LogOutput>(ends[1], false);
  output->start();
  for (int i = 0; i < kLines; ++i) output->add(Level::kInfo, 0, "line " + std::to_string(i));
  // Somebody reads again: what is missing is said where it is missing.
  std::string rest;
  std::thread reader([&] { rest = read_all(ends[0]); });
  for (int i = 0; i < 100'000 && output->waiting() != 0; ++i) ::usleep(1'000);
  output->add(Level::kInfo, 0, "the last one");
  output.reset();
  ::close(ends[1]);
  reader.join();
  ::close(ends[0]);
  EXPECT_NE(rest.find("lines are missing here"), std::string::npos);
  EXPECT_NE(rest.find("the last one\n"), std::string::npos);
  expect_in_order(rest, kLines);
}

// While the thread writes what it has taken, others add lines: those come behind what is missing.
TEST(LogOutput, R10_KeepsTheOrderOfWhatIsMissing) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  ASSERT_GT(::fcntl(ends[1], F_SETPIPE_SZ, 65'536), 0);
  uint64_t count = 0;
  auto output = std::make_unique<LogOutput>(ends[1], false);
  const std::string padding(400, '.');
  const auto add = [&] {
    output->add(Level::kInfo, 0, "line " + std::to_string(count++) + padding);
  };
  const auto wait_for_fewer = [&](size_t than) {
    for (int i = 0; i < 60'000 && output->waiting() >= than; ++i) ::usleep(1'000);
    ASSERT_LT(output->waiting(), than);
  };
  // The thread takes them all at once, and the pipe has room for a third.
  while (count < LogOutput::kMostLines) add();
  output->start();
  pollfd room{ends[1], POLLOUT, 0};
  for (int i = 0; i < 60'000 && ::poll(&room, 1, 0) != 0; ++i) ::usleep(1'000);
  while (count < 2 * LogOutput::kMostLines) add();
  const size_t waiting = output->waiting();
  ASSERT_GT(waiting, LogOutput::kMostLines - 2) << "the others are missing";
  std::string rest(16'384, ' ');
  for (size_t done = 0; done < rest.size();) {
    const ssize_t size = ::read(ends[0], rest.data() + done, rest.size() - done);
    ASSERT_GT(size, 0);
    done += static_cast<size_t>(size);
  }
  // What is in its hands has become less, so there is room; but not before what is missing.
  wait_for_fewer(waiting - 10);
  for (int i = 0; i < 10; ++i) add();
  std::thread reader([&] { rest += read_all(ends[0]); });
  output.reset();
  ::close(ends[1]);
  reader.join();
  ::close(ends[0]);
  expect_in_order(rest, count);
}

TEST(LogOutput, R10_EndsWhenNobodyReads) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  {
    LogOutput output(ends[1], false);
    output.start();
    for (int i = 0; i < 5'000; ++i) output.add(Level::kInfo, 0, std::string(100, 'x'));
  }
  for (const int end : ends) ::close(end);
}

TEST(LogOutput, R10_AFullDiskAndAClosedOneHoldNobodyUp) {
  for (const char* path : {"/dev/full", ""}) {
    const int descriptor = *path != '\0' ? ::open(path, O_WRONLY | O_CLOEXEC) : -1;
    {
      LogOutput output(descriptor, false);
      output.start();
      for (int i = 0; i < 100; ++i) output.add(Level::kInfo, 0, "line");
    }
    if (descriptor >= 0) ::close(descriptor);
  }
}

TEST(LogOutput, R10_KnowsTheJournalByDeviceAndInode) {
  int ends[2];
  ASSERT_EQ(::pipe2(ends, O_CLOEXEC), 0);
  struct stat info {};
  ASSERT_EQ(::fstat(ends[1], &info), 0);
  const std::string own = std::to_string(info.st_dev) + ":" + std::to_string(info.st_ino);
  EXPECT_TRUE(LogOutput::is_journal(ends[1], own.c_str()));
  EXPECT_FALSE(LogOutput::is_journal(ends[1], (own + "1").c_str()));
  EXPECT_FALSE(LogOutput::is_journal(ends[1], nullptr));
  EXPECT_FALSE(LogOutput::is_journal(-1, own.c_str()));
  for (const int end : ends) ::close(end);
}

// --- who asks ------------------------------------------------------------------------

// A controller that never comes to an end of its events, or goes back to those of before.
class Endless : public vm::Transport {
 public:
  Endless(uint64_t step, int& pages) : step_(step), pages_(pages) {}
  base::Result<base::Bytes> exchange(base::ByteSpan) override {
    ++pages_;
    base::Bytes page;
    for (int i = 0; i < 1000; ++i) {
      JournalEntry entry = event(Event::kSet);
      entry.sequence = number_ += step_;
      const base::Bytes sector = online_change::encode(entry);
      page.insert(page.end(), sector.begin(), sector.end());
    }
    if (step_ == 0) number_ = 0;
    return vm::encode_answer(page);
  }

 private:
  uint64_t step_;
  int& pages_;
  uint64_t number_ = 7;
};

TEST(EventClient, R10_EventsWithoutEndAreNotUnderstood) {
  for (const uint64_t step : {1, 0}) {
    for (const bool journal : {false, true}) {
      int pages = 0;
      ControllerClient client(std::make_unique<Endless>(step, pages));
      const auto events = journal ? client.journal() : client.events(0);
      ASSERT_FALSE(events.ok());
      EXPECT_EQ(events.error().refusal, base::Refusal::kProtocol);
      EXPECT_EQ(pages, step == 0 ? 2 : 67) << "a page that goes back is the last one";
    }
  }
}

// --- texts ---------------------------------------------------------------------------

TEST(EventText, R10_ALineSpeaksToNoTerminal) {
  JournalEntry entry = event(Event::kPeerWrote, "a\nb\x1b[2J", "device d");
  entry.who = "x\ry";
  EXPECT_EQ(event_text(entry), "peer wrote by x\\x0dy: device d: a\\x0ab\\x1b[2J");
  EXPECT_EQ(log_line(Level::kError, 1'500'000'000, "t", false),
            "1970-01-01T00:00:01.500Z error t\n");
  EXPECT_EQ(log_line(Level::kError, 0, "t", true), "<3>t\n");
}

TEST(EventText, R10_JsonEscapesTexts) {
  const std::string json = event_json_line(event(Event::kSet, "s='\"\\\n\x01'"));
  EXPECT_NE(json.find(R"("text":"s='\"\\\n\u0001'")"), std::string::npos) << json;
  EXPECT_NE(json.find(R"("event":"set","level":"info","durable":false)"), std::string::npos)
      << json;
  EXPECT_EQ(json.find('\n'), json.size() - 1) << "one line";
}

TEST(EventText, R10_AgesAreRound) {
  EXPECT_EQ(age_text(0), "0 s");
  EXPECT_EQ(age_text(119 * kSecond), "119 s");
  EXPECT_EQ(age_text(120 * kSecond), "2 min");
  EXPECT_EQ(age_text(3 * 3'600 * kSecond), "3 h");
  EXPECT_EQ(age_text(50 * 3'600 * kSecond), "2 d");
}

// --- who wants to see what -----------------------------------------------------------

TEST(EventFilter, R10_SinceIsATimeOrHowLongAgo) {
  EXPECT_EQ(parse_time("1970-01-02"), 86'400 * kSecond);
  EXPECT_EQ(parse_time("1970-01-01T01:02"), 3'720 * kSecond);
  EXPECT_EQ(parse_time("1970-01-01T00:00:01.5Z"), 1'500'000'000);
  for (const char* bad :
       {"", "x", "1970", "1970-13-01", "1970-01-01T", "1970-01-01T00:00:01.",
        "1970-01-01T00:00:01.0123456789", "9999-01-01", "1969-01-01", "1970-01-01 x"}) {
    EXPECT_FALSE(parse_time(bad)) << bad;
  }
  EXPECT_EQ(parse_age("90s"), 90 * kSecond);
  EXPECT_EQ(parse_age("1h30m"), 5'400 * kSecond);
  EXPECT_EQ(parse_age("2d"), 172'800 * kSecond);
  for (const char* bad :
       {"", "s", "5", "5x", "-5s", "1h30", "99999999999999999999s", "999999999d"}) {
    EXPECT_FALSE(parse_age(bad)) << bad;
  }
  EXPECT_EQ(EventFilter::parse("10s", "", 15 * kSecond)->since_ns, 5 * kSecond);
  EXPECT_EQ(EventFilter::parse("soon", "", 0).error().refusal, base::Refusal::kUsage);
}

TEST(EventFilter, R10_LevelsAreThatOneAndAbove) {
  const EventFilter filter = *EventFilter::parse("", "warning", 0);
  EXPECT_TRUE(filter.shows(event(Event::kTrap)));
  EXPECT_TRUE(filter.shows(event(Event::kOverrun)));
  EXPECT_FALSE(filter.shows(event(Event::kStarted)));
  EXPECT_TRUE(EventFilter::parse("", "", 0)->shows(event(Event::kSet)));
}

// A controller that sends an image a byte at a time.
class Dripping : public vm::Transport {
 public:
  explicit Dripping(int& parts) : parts_(parts) {}
  base::Result<base::Bytes> exchange(base::ByteSpan) override {
    ++parts_;
    return vm::encode_answer(encode(vm::ImagePart{{}, uint64_t{1} << 29, {1}}));
  }

 private:
  int& parts_;
};

TEST(ImageClient, PartsOfAByteAreNotUnderstood) {
  int parts = 0;
  ControllerClient client(std::make_unique<Dripping>(parts));
  const auto image = client.image_before();
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kProtocol);
  EXPECT_EQ(parts, 1);
}

}  // namespace
}  // namespace stvm
