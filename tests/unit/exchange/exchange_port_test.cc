// B8, B9: the exchange of one device beside the control thread, under ThreadSanitizer too
// (docs/TESTING.md). What the control side calls allocates nothing and waits for nobody.
#include "vm/io/exchange_port.h"

#include <gtest/gtest.h>

#include <chrono>
#include <mutex>

#include "tests/unit/allocations.h"
#include "tests/unit/locks.h"

namespace vm {
namespace {

using namespace std::chrono_literals;

struct Seen {
  std::atomic<int> hang_ms{0};
  std::atomic<int> exchanges{0};
  std::atomic<int> torn{0};
  std::atomic<int> zeros{0};  // written to points that are left
  std::atomic<int> last{0};   // written byte
};

// Inputs count exchanges; outputs must be bytes of one value.
class Counter : public IoDriver {
 public:
  explicit Counter(std::shared_ptr<Seen> seen) : seen_(std::move(seen)) {}
  base::Status exchange(const Exchange& exchange) override {
    const int number = ++seen_->exchanges;
    if (const int ms = seen_->hang_ms) std::this_thread::sleep_for(1ms * ms);
    for (uint8_t byte : exchange.outputs) seen_->torn += byte != exchange.outputs[0];
    if (!exchange.outputs.empty()) seen_->last = exchange.outputs[0];
    if (!exchange.outputs.empty() && exchange.outputs[0] == 0) ++seen_->zeros;
    for (uint8_t& byte : exchange.inputs) byte = static_cast<uint8_t>(number);
    return base::Ok{};
  }

 private:
  std::shared_ptr<Seen> seen_;
};

ir::Device device(const char* period_ms) {
  return {"d", "simulated", {{"period_ms", period_ms}, {"timeout_ms", "20"}}, {}, {}};
}

DevicePoints points(uint32_t first, uint32_t count) {
  DevicePoints out;
  out.inputs = {{ir::PointTable::kByte, first, count, 0, {ir::DirectArea::kInput, 0, 8}}};
  out.outputs = {{ir::PointTable::kByte, first, count, 0, {ir::DirectArea::kOutput, 0, 8}}};
  out.input_bytes = out.output_bytes = count;
  return out;
}

LeftOutputs zeros(uint32_t count) { return {base::Bytes(count), base::Bytes(count)}; }

void send(ExchangeSet& set, uint8_t value) {
  std::span<uint8_t> work = set.outputs.work();
  std::fill(work.begin(), work.end(), value);
  set.outputs.publish();
}

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 5000; ++i, std::this_thread::sleep_for(1ms)) {
    if (holds()) return true;
  }
  return false;
}

TEST(ExchangePort, B8_TheControlSideNeitherWaitsNorAllocates) {
  auto seen = std::make_shared<Seen>();
  seen->hang_ms = 2000;
  auto port = std::make_unique<ExchangePort>(device("1"), std::make_unique<Counter>(seen), true);
  const auto set = port->add(points(0, 64), zeros(64));
  port->use(set.get());
  ASSERT_TRUE(eventually([&] { return seen->exchanges > 0; }));
  const uint64_t before = tests::allocations();
  const uint64_t locks_before = tests::locks();
  const int64_t begin = ExchangePort::now_ns();
  int fresh = 0;
  uint64_t rounds = 0;
  for (; ExchangePort::now_ns() - begin < 1'500'000'000; ++rounds) {
    send(*set, static_cast<uint8_t>(rounds | 1));
    fresh += port->fresh(ExchangePort::now_ns());
    if (set->inputs.take()) ++fresh;
    port->use(set.get());
  }
  EXPECT_EQ(tests::allocations(), before);
  EXPECT_EQ(tests::locks(), locks_before);
  EXPECT_EQ(fresh, 0);          // it hung all the time
  EXPECT_GT(rounds, 100'000u);  // and nobody waited for it
  seen->hang_ms = 0;
  EXPECT_TRUE(eventually([&] { return port->fresh(ExchangePort::now_ns()); }));
}

TEST(ExchangePort, B8_NothingIsTornWhileVersionsComeAndGo) {
  auto seen = std::make_shared<Seen>();
  ExchangePort port(device("1"), std::make_unique<Counter>(seen), true);
  const auto first = port.add(points(0, 64), zeros(64));
  port.use(first.get());
  std::atomic<bool> ending{false};
  std::atomic<ExchangeSet*> wanted{first.get()};
  int torn = 0;
  std::thread control([&] {
    for (uint8_t value = 1; !ending; value = static_cast<uint8_t>(value + 2)) {
      ExchangeSet* const set = wanted;
      port.use(set);
      send(*set, value);
      if (set->inputs.take()) {
        const auto now = set->inputs.newest();
        for (uint8_t byte : now) torn += byte != now[0];
      }
    }
  });
  std::vector<std::shared_ptr<ExchangeSet>> kept;  // the thread may look at one a little longer
  for (int round = 0; round < 50; ++round) {
    const auto next = kept.emplace_back(port.add(points(32, 64), zeros(64)));
    wanted = next.get();
    std::this_thread::sleep_for(2ms);
    EXPECT_EQ(port.status().name, "d");
    wanted = first.get();  // undo
    std::this_thread::sleep_for(2ms);
    port.drop(next);
  }
  ending = true;
  control.join();
  EXPECT_EQ(torn, 0);
  EXPECT_EQ(seen->torn, 0);
  EXPECT_GT(seen->zeros, 0);  // points that only the other version wrote
}

TEST(ExchangePort, SilenceIsLossEvenWhenTheDriverSaysNothing) {
  auto seen = std::make_shared<Seen>();
  ExchangePort port(device("1"), std::make_unique<Counter>(seen), true);
  const auto set = port.add(points(0, 1), zeros(1));
  port.use(set.get());
  ASSERT_TRUE(eventually([&] { return port.fresh(ExchangePort::now_ns()); }));
  EXPECT_EQ(port.status().state, "online");
  seen->hang_ms = 300;
  EXPECT_TRUE(eventually([&] { return !port.fresh(ExchangePort::now_ns()); }));
  EXPECT_EQ(port.status().state, "lost");
  seen->hang_ms = 0;
  EXPECT_TRUE(eventually([&] { return port.fresh(ExchangePort::now_ns()); }));
}

TEST(ExchangePort, ASetThatIsOnlyPreparedIsReadAndNotWritten) {
  auto seen = std::make_shared<Seen>();
  ExchangePort port(device("1"), std::make_unique<Counter>(seen), true);
  const auto set = port.add(points(0, 4), zeros(4));
  send(*set, 9);
  EXPECT_TRUE(eventually([&] { return set->inputs.take(); }));
  EXPECT_EQ(seen->last, 0);
  port.use(set.get());
  EXPECT_TRUE(eventually([&] { return seen->last == 9; }));
  port.use(nullptr);
  EXPECT_TRUE(eventually([&] { return seen->last == 0; }));
}

// Fails as the test says; each exchange is one write of somebody.
class Faulty : public IoDriver {
 public:
  explicit Faulty(std::shared_ptr<std::atomic<int>> how) : how_(std::move(how)) {}
  base::Status exchange(const Exchange& exchange) override {
    ++exchanges;
    if (exchange.events != nullptr) exchange.events->written("somebody", "coil 0");
    if (*how_ == 0) return base::Ok{};
    return exchange_failed(*how_ == 1 ? "nobody asks" : "port in use");
  }
  bool idle() const override { return *how_ == 1; }
  inline static std::atomic<uint64_t> exchanges{0};

 private:
  std::shared_ptr<std::atomic<int>> how_;
};

TEST(ExchangePort, WhatHappensIsSaidOnceAndIdleIsNoError) {
  auto how = std::make_shared<std::atomic<int>>(1);
  std::mutex mutex;
  std::vector<std::string> lines;
  ir::Device server = device("1");
  server.driver = "modbus-tcp-server";  // which does not wait longer when it fails
  const auto log = [&](DeviceEvent event, const std::string& device, const std::string& text) {
    std::lock_guard lock(mutex);
    if (event == DeviceEvent::kWritten) return;
    const bool back = event == DeviceEvent::kBack;
    lines.push_back(device + (back ? " back " : " lost ") +
                    text.substr(0, text.find_first_of(";0123456789")));
  };
  ExchangePort port(server, std::make_unique<Faulty>(how), true, log);
  const auto set = port.add(points(0, 1), zeros(1));
  port.use(set.get());
  const auto goes_on = [&] {
    const uint64_t begin = Faulty::exchanges;
    return eventually([&] { return Faulty::exchanges > begin + 5; });
  };
  EXPECT_TRUE(goes_on());
  EXPECT_EQ(port.status().errors, 0u);
  EXPECT_EQ(port.status().state, "waiting");
  EXPECT_EQ(port.status().error, "nobody asks");
  for (const int next : {2, 0, 1, 0}) {
    *how = next;
    EXPECT_TRUE(goes_on());
  }
  EXPECT_GT(port.status().errors, 0u);
  EXPECT_GT(port.status().writes, 20u);
  EXPECT_EQ(port.status().last_writer, "somebody");
  std::lock_guard lock(mutex);
  EXPECT_EQ(lines, (std::vector<std::string>{"d lost port in use", "d back online after ",
                                             "d lost nobody asks", "d back online after "}));
}

TEST(ExchangePort, WhatIsLeftBecomesSafeOrStays) {
  auto seen = std::make_shared<Seen>();
  ExchangePort port(device("1"), std::make_unique<Counter>(seen), true);
  const auto first = port.add(points(0, 2), {{0x11, 0x11}, {0xf0, 0xf0}});
  send(*first, 0xee);
  port.use(first.get());
  ASSERT_TRUE(eventually([&] { return seen->last == 0xee; }));
  port.use(nullptr);
  EXPECT_TRUE(eventually([&] { return seen->last == 0xe1; }));
}

}  // namespace
}  // namespace vm
