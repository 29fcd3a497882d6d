// Recordings: what is written is read, whatever is damaged is found, and a replay comes to the same
// bytes in every cycle (invariant 5).
#include "vm/runtime/recording.h"

#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include "tests/unit/runtime/plant.h"
#include "vm/runtime/process_image.h"
#include "vm/runtime/recorder.h"
#include "vm/runtime/replay.h"

namespace runtime_test {
namespace {

// A clock that is never the same: every look at it takes a little, at random.
class RestlessClock : public vm::Clock {
 public:
  explicit RestlessClock(uint32_t seed) : random_(seed) {}
  int64_t now_ns() override { return now_ += random_() % 400'000; }
  void wait_until(int64_t deadline_ns) override { now_ = std::max(now_, deadline_ns); }
  void consumed(uint64_t) override {}
  void worked(int64_t) override {}

 private:
  std::mt19937 random_;
  int64_t now_ = 0;
};

class NoisyDevices : public vm::IoPort {
 public:
  void receive(std::span<uint8_t> inputs) override {
    for (uint8_t& byte : inputs) {
      if (random_() % 3 == 0) byte = static_cast<uint8_t>(random_());
    }
  }
  void lost_tasks(std::span<uint8_t> tasks) override {
    for (uint8_t& task : tasks) {
      if (random_() % 16 == 0) task = 1;
    }
  }
  void send(std::span<const uint8_t>) override {}
  // As others do through a server.
  void at_boundary(const vm::ProcessImage& image, uint8_t* memory) override {
    base::Bytes outputs(image.output_bytes());
    image.variables_to_outputs(memory, outputs);
    outputs[0] = static_cast<uint8_t>(random_());
    image.outputs_to_variables(outputs, memory);
  }

 private:
  std::mt19937 random_{7};
};

// Suspended in the middle of its loop at other places in each run.
constexpr const char* kRacing = R"(
VAR_GLOBAL shared : DINT; order AT %QB0 : BYTE; END_VAR
PROGRAM Slow VAR i, n : DINT; seen : DINT; inp AT %IW1 : WORD; END_VAR
  FOR i := 1 TO 3000 DO n := n + shared; seen := seen + WORD_TO_DINT(inp) MOD 7; END_FOR
END_PROGRAM
PROGRAM Fast VAR inp AT %IB0 : BYTE; END_VAR shared := shared + BYTE_TO_DINT(inp) + BYTE_TO_DINT(order); END_PROGRAM
CONFIGURATION c RESOURCE r ON cpu
  TASK Quick (INTERVAL := T#1ms, PRIORITY := 0); TASK Lazy (INTERVAL := T#7ms, PRIORITY := 1);
  PROGRAM F WITH Quick : Fast; PROGRAM S WITH Lazy : Slow;
END_RESOURCE END_CONFIGURATION
)";

// The same, with exchanges behind what is due, and starts at once in the middle of a cycle.
std::string racing_first() {
  std::string source = kRacing;
  source.insert(source.find("RESOURCE"), "{attribute 'schedule' := 'run_first'} ");
  source.insert(source.find("TASK Lazy"), "{attribute 'overrun' := 'at_once'} ");
  return source.replace(source.find("T#7ms"), 5, "T#3ms");
}

// The same, with tasks that exchange by themselves, so that a cycle has several receptions.
std::string racing_by_themselves() {
  std::string source = racing_first();
  const std::string own = "{attribute 'exchange' := 'own'} ";
  source.insert(source.find("TASK Lazy"), own);
  return source.insert(source.find("TASK Quick"), own);
}

class RecordingTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("recording" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  base::Bytes recorded(uint32_t seed, int cycles, const std::string& source = kRacing) {
    auto image = build(source);
    if (!image) return {};
    RestlessClock clock(seed);
    NoisyDevices devices;
    vm::RecordedStart start;
    start.image = image->encoded();
    start.fuel_slice = options().fuel_slice;
    start.fuel_budget = options().fuel_budget;
    auto recorder = vm::Recorder::create((folder_ / "run").string(), clock, devices, start);
    EXPECT_TRUE(recorder.ok());
    (*recorder)->begin();
    auto controller = vm::Controller::start(*image, options(), **recorder, **recorder);
    (*recorder)->end(**controller);
    for (int i = 0; i < cycles; ++i) {
      (*recorder)->begin();
      (*controller)->cycle();
      (*recorder)->end(**controller);
    }
    final_ = (*controller)->get("S.n").value() + " " + (*controller)->get("S.seen").value();
    overruns_ = (*controller)->tasks()[1].overruns;
    losses_ = (*controller)->trap_count();
    EXPECT_TRUE((*recorder)->close().ok());
    std::ifstream file(folder_ / "run", std::ios::binary);
    return base::Bytes(std::istreambuf_iterator<char>(file), {});
  }

  static vm::ControllerOptions options() {
    vm::ControllerOptions options;
    options.fuel_slice = 10;
    options.on_trap = ir::OnTrap::kGoOn;
    return options;
  }

  std::filesystem::path folder_;
  std::string final_;
  uint64_t losses_ = 0;
  uint64_t overruns_ = 0;
  size_t most_receptions_ = 0;  // in one cycle

  void expect_identical_replays(const std::string& source);
};

void RecordingTest::expect_identical_replays(const std::string& source) {
  std::string first;
  for (uint32_t seed : {1u, 2u, 3u}) {
    const base::Bytes bytes = recorded(seed, 200, source);
    EXPECT_NE(final_, first) << "the clock makes no difference, so this shows nothing";
    first = final_;
    base::Result<vm::Recording> recording = vm::decode_recording(bytes);
    ASSERT_TRUE(recording.ok());
    ASSERT_EQ(recording->cycles.size(), 201u);
    EXPECT_FALSE(recording->cut_off);
    most_receptions_ = 0;
    for (const vm::RecordedCycle& cycle : recording->cycles) {
      most_receptions_ = std::max(most_receptions_, cycle.observed.receptions.size());
    }
    vm::Replay replay;
    vm::StateSum sum;
    auto image = ir::verify(recording->start.image);
    ASSERT_TRUE(image.ok());
    replay.see(recording->cycles[0].observed);
    auto controller = vm::Controller::start(*image, options(), replay, replay);
    ASSERT_TRUE(controller.ok());
    for (size_t i = 1; i < recording->cycles.size(); ++i) {
      replay.see(recording->cycles[i].observed);
      (*controller)->cycle();
      ASSERT_EQ(sum.of(**controller), recording->cycles[i].state) << "cycle " << i;
      ASSERT_TRUE(replay.exact()) << "cycle " << i;
    }
    EXPECT_EQ((*controller)->get("S.n").value() + " " + (*controller)->get("S.seen").value(),
              final_);
    EXPECT_GT(losses_, 0u) << "no device was lost, so this shows nothing of it";
    EXPECT_EQ((*controller)->trap_count(), losses_);
  }
}

TEST_F(RecordingTest, ReplayIsBitIdentical) { expect_identical_replays(kRacing); }

TEST_F(RecordingTest, B2_B7_ReplayOfOtherSchedulesIsBitIdentical) {
  expect_identical_replays(racing_first());
  EXPECT_GT(overruns_, 10u) << "no task was late, so this shows nothing of it";
}

TEST_F(RecordingTest, B12_ReplayOfFurtherReceptionsIsBitIdentical) {
  expect_identical_replays(racing_by_themselves());
  EXPECT_GT(most_receptions_, 2u) << "no cycle received more than twice";
}

TEST_F(RecordingTest, EveryCutIsFoundAndTheRestIsWhole) {
  const base::Bytes bytes = recorded(1, 3);
  const base::Result<vm::Recording> whole = vm::decode_recording(bytes);
  ASSERT_TRUE(whole.ok());
  size_t usable = 0;
  for (size_t size = 0; size < bytes.size(); ++size) {
    base::Result<vm::Recording> cut = vm::decode_recording(base::ByteSpan(bytes).first(size));
    if (!cut.ok()) {
      EXPECT_EQ(cut.error().refusal, base::Refusal::kBadRecording);
      continue;
    }
    ++usable;
    ASSERT_TRUE(cut->cut_off) << size;  // also between two records
    ASSERT_LE(cut->cycles.size(), whole->cycles.size());
    for (size_t i = 0; i < cut->cycles.size(); ++i) {
      ASSERT_EQ(cut->cycles[i].state, whole->cycles[i].state);
    }
  }
  EXPECT_GT(usable, 10u);
}

// What a request did is in the cycles behind it; whoever noted it was slow.
TEST_F(RecordingTest, NoCutLosesARequestThatAnEarlierCycleNeeds) {
  auto image = build(kRacing);
  ASSERT_TRUE(image);
  vm::VirtualClock clock;
  vm::NullIo devices;
  vm::RecordedStart start;
  start.image = {1};
  auto recorder = vm::Recorder::create((folder_ / "run").string(), clock, devices, start);
  ASSERT_TRUE(recorder.ok());
  auto controller = vm::Controller::start(*image, options(), **recorder, **recorder);
  ASSERT_TRUE(controller.ok());
  const auto cycles = [&](int count) {
    for (int i = 0; i < count; ++i) {
      (*recorder)->begin();
      (*controller)->cycle();
      (*recorder)->end(**controller);
    }
  };
  const auto job = [&] {
    (*recorder)->begin_job(**controller);
    (*recorder)->end_job(**controller);
  };
  cycles(3);
  for (int request = 0; request < 3; ++request) {
    job();
    cycles(20);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // for the thread that writes
    if (request == 1) {
      (*recorder)->forget_jobs();  // it changed nothing
    } else {
      (*recorder)->note(base::Bytes{static_cast<uint8_t>(request)});
    }
    cycles(20);
  }
  ASSERT_TRUE((*recorder)->close().ok());
  std::ifstream file(folder_ / "run", std::ios::binary);
  const base::Bytes bytes(std::istreambuf_iterator<char>(file), {});
  const base::Result<vm::Recording> whole = vm::decode_recording(bytes);
  ASSERT_TRUE(whole.ok());
  EXPECT_FALSE(whole->cut_off);
  EXPECT_EQ(whole->cycles.size(), 3u + 3 * 40);
  ASSERT_EQ(whole->requests.size(), 2u);
  for (size_t size = 0; size < bytes.size(); ++size) {
    base::Result<vm::Recording> cut = vm::decode_recording(base::ByteSpan(bytes).first(size));
    if (!cut.ok() || cut->cycles.empty()) continue;
    for (size_t i = cut->requests.size(); i < 2; ++i) {
      ASSERT_LE(cut->cycles.back().number, whole->requests[i].cycle) << "request " << i;
    }
  }
}

TEST_F(RecordingTest, FlippedBitsAreFound) {
  const base::Bytes bytes = recorded(1, 3);
  const size_t cycles = vm::decode_recording(bytes)->cycles.size();
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    base::Bytes mutant = bytes;
    mutant[random() % mutant.size()] ^= static_cast<uint8_t>(1u << (random() % 8));
    base::Result<vm::Recording> read = vm::decode_recording(mutant);
    EXPECT_TRUE(!read.ok() || read->cut_off || read->cycles.size() < cycles);
  }
}

// Numbers and requests as long as they can be, and a request that names an earlier cycle.
TEST(Recording, RoundTripOfRecords) {
  base::Bytes bytes = vm::encode_record(vm::RecordedStart{.image = {1, 2, 3}, .retained = {4}});
  const auto add = [&](const base::Bytes& more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  };
  vm::RecordedCycle cycle{UINT64_MAX, {}, 0xdeadbeef};
  cycle.observed = {
      {0, 1, int64_t{1} << 62}, {{0, 9}, {70'000, 255}}, {{3, 1}}, {{0, 2}}, {{7, 4}}, {{2, 1}}};
  add(vm::encode_record(cycle));
  add(vm::encode_record(vm::RecordedRequest{9, {5}, base::Bytes(100'000, 7)}));
  add(vm::encode_record(vm::RecordedRequest{3, {}, {}}));
  add(vm::encode_end());
  base::Result<vm::Recording> back = vm::decode_recording(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_FALSE(back->cut_off);
  EXPECT_EQ(back->start.image, (base::Bytes{1, 2, 3}));
  ASSERT_EQ(back->cycles.size(), 1u);
  EXPECT_EQ(back->cycles[0].number, UINT64_MAX);
  EXPECT_EQ(back->cycles[0].observed.clock, cycle.observed.clock);
  EXPECT_EQ(back->cycles[0].observed.changed, cycle.observed.changed);
  EXPECT_EQ(back->cycles[0].observed.outputs, cycle.observed.outputs);
  EXPECT_EQ(back->cycles[0].observed.markers, cycle.observed.markers);
  EXPECT_EQ(back->cycles[0].observed.globals, cycle.observed.globals);
  EXPECT_EQ(back->cycles[0].observed.lost, cycle.observed.lost);
  EXPECT_EQ(back->cycles[0].state, 0xdeadbeefu);
  ASSERT_EQ(back->requests.size(), 2u);
  EXPECT_EQ(back->requests[0].cycle, 3u);
  EXPECT_EQ(back->requests[1].bytes.size(), 100'000u);
}

// Each reception of a cycle with what it has brought; one without any is one too.
TEST(Recording, B12_RoundTripOfSeveralReceptions) {
  base::Bytes bytes = vm::encode_record(vm::RecordedStart{.image = {1, 2, 3}, .retained = {}});
  vm::RecordedCycle cycle{1, {}, 5};
  cycle.observed.changed = {{4, 1}, {9, 2}, {0, 3}};
  cycle.observed.lost = {{1, 1}, {0, 1}};
  cycle.observed.receptions = {{2, 0}, {2, 1}, {3, 2}};
  for (const base::Bytes& more : {vm::encode_record(cycle), vm::encode_end()}) {
    bytes.insert(bytes.end(), more.begin(), more.end());
  }
  base::Result<vm::Recording> back = vm::decode_recording(bytes);
  ASSERT_TRUE(back.ok());
  ASSERT_EQ(back->cycles.size(), 1u);
  const vm::Observed& seen = back->cycles[0].observed;
  EXPECT_EQ(seen.changed, cycle.observed.changed);
  EXPECT_EQ(seen.lost, cycle.observed.lost);
  ASSERT_EQ(seen.receptions.size(), 3u);
  vm::Replay replay;
  replay.see(seen);
  base::Bytes inputs(10);
  base::Bytes tasks(2);
  const auto receive = [&] {
    replay.receive(inputs);
    std::fill(tasks.begin(), tasks.end(), uint8_t{0});
    replay.lost_tasks(tasks);
  };
  receive();
  EXPECT_EQ(inputs, (base::Bytes{0, 0, 0, 0, 1, 0, 0, 0, 0, 2}));
  EXPECT_EQ(tasks, (base::Bytes{0, 0}));
  receive();
  EXPECT_EQ(inputs, (base::Bytes{0, 0, 0, 0, 1, 0, 0, 0, 0, 2}));
  EXPECT_EQ(tasks, (base::Bytes{0, 1}));
  receive();
  EXPECT_EQ(inputs[0], 3);
  EXPECT_EQ(tasks, (base::Bytes{1, 0}));
}

TEST(Recording, UnwritableFileIsOneClearError) {
  vm::VirtualClock clock;
  vm::NullIo io;
  auto recorder = vm::Recorder::create("/nowhere/file", clock, io, {});
  ASSERT_FALSE(recorder.ok());
  EXPECT_EQ(recorder.error().refusal, base::Refusal::kFileUnwritable);
}

}  // namespace
}  // namespace runtime_test
