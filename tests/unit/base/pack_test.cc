// X9: bytes that are packed come back, and what is no packed form is told without unpacking it.
#include <gtest/gtest.h>

#include <random>

#include "base/pack.h"

namespace {

using base::Bytes;

constexpr uint64_t kLimit = 1 << 26;

Bytes bytes_of(std::string_view text) { return {text.begin(), text.end()}; }

void expect_back(const Bytes& bytes) {
  const Bytes packed = base::pack(bytes);
  EXPECT_LE(packed.size(), bytes.size() + bytes.size() / 1000 + 8);
  EXPECT_EQ(base::unpacked_size(packed, bytes.size()), bytes.size());
  const auto back = base::unpack(packed, bytes.size());
  ASSERT_TRUE(back.has_value());
  EXPECT_EQ(*back, bytes);
  EXPECT_EQ(base::pack(bytes), packed);
  if (!bytes.empty()) {
    EXPECT_FALSE(base::unpacked_size(packed, bytes.size() - 1).has_value());
    EXPECT_FALSE(base::unpack(packed, bytes.size() - 1).has_value());
  }
}

TEST(Pack, X9_WhatIsPackedComesBack) {
  expect_back({});
  std::string text;
  for (int i = 0; i < 3000; ++i) text += "  x" + std::to_string(i % 97) + " := x + 1;\n";
  const Bytes bytes = bytes_of(text);
  for (size_t length = 0; length < 300; ++length) {
    expect_back(Bytes(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(length)));
  }
  expect_back(bytes);
  EXPECT_LT(base::pack(bytes).size(), bytes.size() / 10);
  expect_back(Bytes(1 << 20, 'x'));
  EXPECT_LT(base::pack(Bytes(1 << 20, 'x')).size(), 200u);
}

TEST(Pack, X9_AnyBytesComeBack) {
  std::mt19937 random(1);
  for (uint32_t letters : {1u, 2u, 4u, 256u}) {
    for (size_t length : {1u, 7u, 100u, 5000u, 70000u}) {
      Bytes bytes(length);
      for (uint8_t& byte : bytes) byte = static_cast<uint8_t>(random() % letters);
      expect_back(bytes);
    }
  }
}

TEST(Pack, X9_HostileBytesAreTold) {
  const auto refused = [](const Bytes& packed) {
    EXPECT_FALSE(base::unpacked_size(packed, kLimit).has_value());
    EXPECT_FALSE(base::unpack(packed, kLimit).has_value());
  };
  refused({0x00});                                      // a piece of nothing
  refused({0x10});                                      // a byte that is not there
  refused({0x10, 'a', 0x00});                           // the same behind a good one
  refused({0x01, 0x01});                                // a copy from before the beginning
  refused({0x11, 'a', 0x02});                           // likewise
  refused({0x11, 'a', 0x00});                           // a copy of what is not made yet
  refused({0x11, 'a'});                                 // a distance that is not there
  refused({0x11, 'a', 0x80});                           // a number without an end
  refused({0x1f, 'a', 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 1});  // a number of more than 35 bits
  refused({0xf0, 0xff, 0xff, 0xff, 0xff, 0x7f});        // more bytes than there are
  // A bomb: seven bytes that would become 16 GiB.
  const Bytes bomb = {0x1f, 'a', 0xff, 0xff, 0xff, 0xff, 0x3f, 0x01};
  refused(bomb);
  EXPECT_EQ(base::unpacked_size(bomb, uint64_t{1} << 40), (uint64_t{0x3ffffffff} + 15 + 3 + 1));
}

// Each is told, or becomes at most what it may; both functions say the same.
TEST(Pack, X9_DamagedBytesAreBounded) {
  Bytes packed = base::pack(bytes_of("IF a THEN b := 1; END_IF IF b THEN a := 1; END_IF IF a"));
  for (size_t bit = 0; bit < packed.size() * 8; ++bit) {
    packed[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    const auto size = base::unpacked_size(packed, 1000);
    const auto back = base::unpack(packed, 1000);
    ASSERT_EQ(size.has_value(), back.has_value());
    if (back) {
      EXPECT_EQ(back->size(), *size);
      EXPECT_LE(*size, 1000u);
    }
    packed[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
  }
}

}  // namespace
