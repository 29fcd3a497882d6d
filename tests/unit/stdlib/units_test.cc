// Code units by whole words against one by one, in buffers that end where they may be read to.
#include "stdlib/native/units.h"

#include <memory>
#include <random>

#include "tests/unit/stdlib/native_call.h"

namespace stdlib::testing {
namespace {

template <typename Unit>
uint32_t counted_length(const uint8_t* data, uint32_t capacity) {
  uint32_t at = 0;
  while (at < capacity && load<Unit>(data + at * sizeof(Unit)) != 0) ++at;
  return at;
}

// Of exactly `bytes` bytes, so that a sanitizer sees what is read behind them.
std::unique_ptr<uint8_t[]> random_bytes(size_t bytes, std::mt19937& random) {
  auto data = std::make_unique<uint8_t[]>(bytes);
  // Few values: bytes that a borrow changes, and halves of wide units that are zero alone.
  constexpr uint8_t kValues[] = {1, 0x80, 0xFF, 0x7F, 0x81};
  for (size_t i = 0; i < bytes; ++i) data[i] = kValues[random() % 5];
  return data;
}

template <typename Unit>
void lengths() {
  std::mt19937 random(7);
  for (uint32_t capacity = 0; capacity < 40; ++capacity) {
    for (uint32_t end = 0; end <= capacity + 1; ++end) {
      const size_t bytes = (size_t{capacity} + 1) * sizeof(Unit);
      for (size_t skew = 0; skew < 8; ++skew) {
        const auto data = random_bytes(bytes + skew, random);
        uint8_t* const text = data.get() + skew;
        if (sizeof(Unit) == 2) {
          for (uint32_t i = 0; i <= capacity; ++i) text[2 * i + random() % 2] = random() % 2;
          for (uint32_t i = 0; i <= capacity; ++i) {
            if (load<Unit>(text + 2 * i) == 0) text[2 * i + 1] = 1;
          }
        }
        if (end <= capacity) store(text + end * sizeof(Unit), Unit{0});
        ASSERT_EQ(length_of<Unit>(text, capacity), counted_length<Unit>(text, capacity));
        ASSERT_EQ(length_of<Unit>(text, capacity), std::min(end, capacity));
      }
    }
  }
}

TEST(NativeUnits, LengthIsTheFirstNulOrTheCapacity) {
  lengths<uint8_t>();
  lengths<uint16_t>();
}

template <typename Unit>
int32_t order_of(const uint8_t* a, uint32_t a_capacity, const uint8_t* b, uint32_t b_capacity) {
  const uint32_t a_length = counted_length<Unit>(a, a_capacity);
  const uint32_t b_length = counted_length<Unit>(b, b_capacity);
  for (uint32_t i = 0; i < std::min(a_length, b_length); ++i) {
    const auto x = load<Unit>(a + i * sizeof(Unit));
    const auto y = load<Unit>(b + i * sizeof(Unit));
    if (x != y) return x < y ? -1 : 1;
  }
  return a_length == b_length ? 0 : a_length < b_length ? -1 : 1;
}

template <typename Unit>
void comparisons() {
  std::mt19937 random(9);
  constexpr uint32_t kMost = 24;
  for (int round = 0; round < 20000; ++round) {
    const uint32_t a_capacity = random() % kMost;
    const uint32_t b_capacity = random() % 3 == 0 ? random() % kMost : a_capacity;
    const size_t a_bytes = (size_t{a_capacity} + 1) * sizeof(Unit);
    const size_t b_bytes = (size_t{b_capacity} + 1) * sizeof(Unit);
    const auto a = random_bytes(a_bytes, random);
    const auto b = random_bytes(b_bytes, random);
    // Mostly the same text, with another unit or an end somewhere, and anything behind that.
    if (random() % 8 != 0) std::memcpy(b.get(), a.get(), std::min(a_bytes, b_bytes));
    const auto change = [&](uint8_t* text, uint32_t capacity) {
      uint8_t* const at = text + random() % (capacity + 1) * sizeof(Unit);
      if (random() % 3 == 0) at[random() % sizeof(Unit)] = static_cast<uint8_t>(random());
      if (random() % 3 == 0) store(at, Unit{0});
    };
    change(a.get(), a_capacity);
    change(b.get(), b_capacity);
    if (random() % 4 == 0) std::memcpy(b.get(), a.get(), std::min(a_bytes, b_bytes));
    ASSERT_EQ(compare_texts<Unit>(a.get(), a_capacity, b.get(), b_capacity),
              order_of<Unit>(a.get(), a_capacity, b.get(), b_capacity));
  }
}

TEST(NativeUnits, TextsCompareAsTheirFirstUnitsThatDiffer) {
  comparisons<uint8_t>();
  comparisons<uint16_t>();
}

TEST(NativeUnits, BytesAreMovedWhateverOverlaps) {
  std::mt19937 random(8);
  for (size_t count = 0; count < 70; ++count) {
    for (size_t to = 0; to < 20; ++to) {
      for (size_t from = 0; from < 20; from += 3) {
        const auto made = random_bytes(90, random);
        const auto wanted = std::make_unique<uint8_t[]>(90);
        std::memcpy(wanted.get(), made.get(), 90);
        std::memmove(wanted.get() + to, wanted.get() + from, count);
        copy_bytes(made.get() + to, made.get() + from, count);
        ASSERT_EQ(std::memcmp(made.get(), wanted.get(), 90), 0) << count << " " << from;
      }
    }
  }
}

// Apart, as the compiler would warn of the ways that these sizes never go.
template <typename Unit>
[[gnu::noinline]] void assign(uint8_t* to, uint32_t to_capacity, const uint8_t* from,
                              uint32_t from_capacity) {
  assign_text<Unit>(to, to_capacity, from, from_capacity);
}

TEST(NativeUnits, AssignmentStopsAtTheSmallerCapacity) {
  std::vector<uint8_t> target(8, 9);
  const std::string source = "abc45678";
  uint8_t* const to = target.data();
  const auto* const full = reinterpret_cast<const uint8_t*>(source.data());
  assign<uint8_t>(to, 5, full, 2);  // 'c' stands where the NUL belongs
  EXPECT_EQ(std::memcmp(to, "ab\0\x9", 4), 0);
  assign<uint8_t>(to, 1, full, 2);
  EXPECT_EQ(std::memcmp(to, "a\0\0\x9", 4), 0);
  assign<uint8_t>(to, 0, full, 2);
  EXPECT_EQ(to[0], 0);
  const std::vector<uint8_t> wide = {0, 1, 0, 2, 0, 0, 0, 0};
  assign<uint16_t>(to, 3, wide.data(), 2);
  EXPECT_EQ(std::memcmp(to, wide.data(), 6), 0);
  EXPECT_EQ(to[6], 9);
}

TEST(NativeUnits, AssignmentOntoItself) {
  std::string chars = "abcdefghijklmnopqrstuvwxyz0123456789";
  chars.resize(40);
  auto* const text = reinterpret_cast<uint8_t*>(chars.data());
  assign<uint8_t>(text + 1, 38, text, 36);
  EXPECT_EQ(std::memcmp(text, "aabcdefghijklmnopqrstuvwxyz0123456789", 38), 0);
  assign<uint8_t>(text, 39, text + 2, 36);
  EXPECT_EQ(std::memcmp(text, "bcdefghijklmnopqrstuvwxyz0123456789", 36), 0);
}

TEST(NativeUnits, CapacitiesOfStringsAreCutAtTheLargest) {
  // No verified image has such a reference; then no more than 32767 units are looked at.
  std::vector<uint8_t> memory(40000, 'x');
  const NativeRow& row = native_row(static_cast<uint32_t>(NativeId::kLenS));
  EXPECT_EQ(row.function(memory.data(), uint64_t{0xFFFFFFFF} << 32, 0, 0, 0, 0), 32767u);
}

}  // namespace
}  // namespace stdlib::testing
