// Two resources and their control threads, without programs: what one publishes the other sees
// whole, while versions of both come and go. Under ThreadSanitizer too (docs/TESTING.md).
#include "vm/io/global_exchange.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "vm/runtime/clocks.h"
#include "vm/runtime/io.h"
#include "vm/runtime/shared_globals.h"

namespace vm {
namespace {

constexpr uint32_t kData = 64;
constexpr uint32_t kFirst = 4000;  // elements of the first variable
constexpr uint32_t kSecond = 3;

// Globals `head` and `tail`, arrays of LWORD, and an idle task; `padding` bytes between them, so
// that versions differ in where their variables are.
ir::VerifiedImage image_of(const std::string& name, bool writes, uint32_t padding,
                           ir::Kind element = ir::Kind::kLword) {
  ir::Image image;
  image.name = name;
  ir::Type globals;
  globals.kind = ir::Kind::kGlobals;
  const ir::TypeId arrays[] = {
      image.types.own().array(image.types.elementary(ir::Kind::kLword), {{1, kFirst}}),
      image.types.own().array(image.types.elementary(element), {{1, kSecond}})};
  for (uint32_t i = 0; i < 2; ++i) {
    ir::Member member;
    member.name = i == 0 ? "head" : "tail";
    member.type = arrays[i];
    globals.members.push_back(member);
  }
  image.globals = image.types.own().declare(globals);
  image.layouts.own().of.resize(image.types.size());
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const ir::TypeId id(i);
    ir::TypeLayout& layout = image.layouts.own().of[i];
    layout.align = 8;
    if (image.types.is_scalar(id)) layout.size = ir::scalar_size(image.types.scalar(id));
  }
  for (uint32_t i = 0; i < 2; ++i) {
    image.layouts.own().of[arrays[i].index].size = (i == 0 ? kFirst : kSecond) * 8;
  }
  ir::TypeLayout& layout = image.layouts.own().of[image.globals.index];
  layout.member_offsets = {padding, 2 * padding + kFirst * 8};
  layout.used = 2 * padding + (kFirst + kSecond) * 8;
  layout.area_capacity = layout.size = layout.used;
  image.data_capacity = kData + layout.area_capacity;
  ir::Instance row;
  row.type = image.globals;
  row.data = kData;
  row.live = true;
  image.instances = {row};
  ir::ImageTask task;
  task.name = "t";
  task.period_ns = 1'000'000;
  task.watchdog_ns = 1'000'000;
  image.tasks = {task};
  image.shared = {{0, writes}, {1, writes}};
  auto verified = ir::verify(ir::encode(image));
  EXPECT_TRUE(verified.ok()) << base::to_string(verified.error());
  return *verified;
}

// Data memory and the control side of one resource.
struct Side {
  Side(GlobalExchange& exchange, size_t number, const ir::VerifiedImage& image)
      : port(exchange, number, clock, io) {
    run(image);
  }
  void run(const ir::VerifiedImage& image) {
    globals = std::make_unique<SharedGlobals>(image.image());
    memory.assign(kData + image.image().data_capacity, 0);
    version = image.digest();
  }
  uint64_t word(size_t variable, uint32_t number) const {
    uint64_t value = 0;
    std::memcpy(&value, &memory[globals->variables()[variable].runs[0].offset + number * 8], 8);
    return value;
  }
  void fill(uint64_t value) {
    for (const SharedVariable& variable : globals->variables()) {
      for (uint32_t at = 0; at < variable.bytes; at += 8) {
        std::memcpy(&memory[variable.runs[0].offset + at], &value, 8);
      }
    }
  }

  VirtualClock clock;
  NullIo io;
  ResourcePort port;
  std::unique_ptr<SharedGlobals> globals;
  base::Bytes memory;
  base::Digest version{};
};

struct Pair {
  explicit Pair(uint32_t padding = 0)
      : first(image_of("P.W", true, padding)), second(image_of("P.R", false, padding)) {
    auto made = GlobalExchange::make({{"W", first}, {"R", second}});
    EXPECT_TRUE(made.ok());
    exchange = std::move(*made);
    writer.emplace(*exchange, 0, first);
    reader.emplace(*exchange, 1, second);
  }
  void publish(uint64_t value) {
    writer->fill(value);
    writer->port.publish_globals(*writer->globals, writer->memory.data());
  }
  uint64_t take() {
    reader->port.take_globals(*reader->globals, reader->memory.data());
    return reader->word(0, 0);
  }

  ir::VerifiedImage first, second;
  std::unique_ptr<GlobalExchange> exchange;
  std::optional<Side> writer, reader;
};

TEST(GlobalExchange, TheNewestBlockIsTaken) {
  Pair pair;
  EXPECT_EQ(pair.take(), 0u);
  pair.publish(1);
  pair.publish(2);
  EXPECT_EQ(pair.take(), 2u);
  pair.reader->fill(77);  // nothing new: the reader's memory is left alone
  EXPECT_EQ(pair.take(), 77u);
  pair.publish(3);
  EXPECT_EQ(pair.take(), 3u);
  EXPECT_EQ(pair.reader->word(1, kSecond - 1), 3u);
  EXPECT_EQ(pair.reader->port.status()[0].exchanges, 2u);
  EXPECT_TRUE(pair.writer->port.status().empty());
}

TEST(GlobalExchange, AChangeAndItsUndoGoOnWithTheNewest) {
  Pair pair;
  pair.publish(1);
  const ir::VerifiedImage next = image_of("P.W", true, 16);
  ASSERT_TRUE(pair.writer->port.prepare(next).ok());
  pair.publish(2);  // waits in the buffer of the first version
  pair.writer->port.use(next.digest());
  pair.writer->run(next);
  pair.publish(3);
  EXPECT_EQ(pair.take(), 3u);
  pair.writer->port.use(pair.first.digest());  // undo: 2 is older than 3
  pair.writer->run(pair.first);
  EXPECT_EQ(pair.take(), 3u);
  pair.publish(4);
  EXPECT_EQ(pair.take(), 4u);
}

TEST(GlobalExchange, AnotherTypeIsLeftAloneAndSaid) {
  Pair pair;
  pair.publish(1);
  EXPECT_EQ(pair.take(), 1u);
  const ir::VerifiedImage next = image_of("P.W", true, 0, ir::Kind::kLint);
  ASSERT_TRUE(pair.writer->port.prepare(next).ok());
  EXPECT_EQ(pair.reader->port.status()[0].error, "");
  // Known beforehand where the change is made.
  ASSERT_EQ(pair.writer->port.status().size(), 1u);
  EXPECT_EQ(pair.writer->port.status()[0].state, kStagedState);
  EXPECT_EQ(pair.writer->port.status()[0].error,
            "`tail` is ARRAY[1..3] OF LINT here and ARRAY[1..3] OF LWORD in RESOURCE `R`, which "
            "reads it: not exchanged until both are the same");
  pair.writer->port.use(next.digest());
  pair.writer->run(next);
  pair.publish(2);
  EXPECT_EQ(pair.take(), 2u);
  EXPECT_EQ(pair.reader->word(1, 0), 1u);
  EXPECT_EQ(pair.reader->port.status()[0].error,
            "`tail` is ARRAY[1..3] OF LWORD here and ARRAY[1..3] OF LINT in RESOURCE `W`: not "
            "exchanged until both are the same");
  const ir::VerifiedImage also = image_of("P.R", false, 0, ir::Kind::kLint);
  ASSERT_TRUE(pair.reader->port.prepare(also).ok());
  pair.reader->port.use(also.digest());
  pair.reader->run(also);
  pair.publish(3);
  EXPECT_EQ(pair.take(), 3u);
  EXPECT_EQ(pair.reader->word(1, 0), 3u);
  EXPECT_EQ(pair.reader->port.status()[0].error, "");
  EXPECT_TRUE(pair.writer->port.status().empty());
}

TEST(GlobalExchange, ASecondWriterIsRefused) {
  Pair pair;
  const ir::VerifiedImage writes_too = image_of("P.R", true, 0);
  base::Status prepared = pair.reader->port.prepare(writes_too);
  ASSERT_FALSE(prepared.ok());
  EXPECT_EQ(prepared.error().refusal, base::Refusal::kTwoWriters);
  auto both = GlobalExchange::make({{"W", pair.first}, {"R", writes_too}});
  EXPECT_FALSE(both.ok());
  // It can begin to write when the other one has stopped, and can no longer go back.
  const ir::VerifiedImage reads = image_of("P.W", false, 0);
  ASSERT_TRUE(pair.writer->port.prepare(reads).ok());
  pair.writer->port.use(reads.digest());
  EXPECT_FALSE(pair.reader->port.prepare(writes_too).ok());
  pair.writer->port.settle();
  EXPECT_TRUE(pair.reader->port.prepare(writes_too).ok());
}

// Both control threads at full speed, and two others that prepare, switch, undo and settle.
TEST(GlobalExchange, NothingIsTornWhileVersionsComeAndGo) {
  Pair pair;
  std::atomic<bool> stop{false};
  // One switch of a resource at a time: asked for here, done by its control thread.
  struct Order {
    std::atomic<const ir::VerifiedImage*> next{nullptr};
  };
  Order orders[2];
  const auto obey = [](Order& order, Side& side) {
    const ir::VerifiedImage* next = order.next.load(std::memory_order_acquire);
    if (next == nullptr) return;
    side.port.use(next->digest());
    side.run(*next);
    order.next.store(nullptr, std::memory_order_release);
  };
  uint64_t torn = 0, back = 0, published = 0;
  std::atomic<uint64_t> seen{0};
  std::thread writing([&] {
    while (!stop) {
      obey(orders[0], *pair.writer);
      pair.publish(++published);
    }
  });
  std::thread reading([&] {
    uint64_t last = 0;
    while (!stop) {
      obey(orders[1], *pair.reader);
      const uint64_t now = pair.take();
      if (now == 0) continue;  // another version, whose memory nothing has come to yet
      for (uint32_t i = 0; i < kFirst; ++i) torn += pair.reader->word(0, i) != now;
      for (uint32_t i = 0; i < kSecond; ++i) torn += pair.reader->word(1, i) != now;
      back += now < last;
      seen += now != last;
      last = now;
    }
  });
  const std::vector<ir::VerifiedImage> versions[] = {
      {pair.first, image_of("v", true, 8), image_of("v", true, 24)},
      {pair.second, image_of("v", false, 8), image_of("v", false, 24)}};
  std::thread changing[2];
  std::atomic<uint32_t> changes{0};
  for (size_t side = 0; side < 2; ++side) {
    changing[side] = std::thread([&, side] {
      ResourcePort& port = side == 0 ? pair.writer->port : pair.reader->port;
      for (uint32_t round = 1; !stop; ++round) {
        const ir::VerifiedImage& next = versions[side][round % 3];
        EXPECT_TRUE(port.prepare(next).ok());
        orders[side].next.store(&next, std::memory_order_release);
        while (orders[side].next.load(std::memory_order_acquire) != nullptr && !stop) {
          std::this_thread::yield();
        }
        if (stop) break;
        port.settle();
        EXPECT_LE(port.status().size(), 1u);
        ++changes;
      }
    });
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  // A busy machine may need longer for as much.
  for (int i = 0; i < 600 && (seen <= 50 || changes <= 20); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  stop = true;
  for (std::thread* thread : {&writing, &reading, &changing[0], &changing[1]}) thread->join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(back, 0u);
  EXPECT_GT(seen, 50u);
  EXPECT_GT(changes, 20u);
}

}  // namespace
}  // namespace vm
