#include "base/bytes.h"

#include <gtest/gtest.h>

#include "base/crc32c.h"
#include "base/hash.h"
#include "base/sha256.h"

namespace base {
namespace {

TEST(Bytes, WrittenValuesComeBack) {
  ByteWriter writer;
  writer.u8(1);
  writer.u16(0x0203);
  writer.u32(0x04050607);
  writer.u64(0x08090A0B0C0D0E0F);
  writer.i64(-2);
  writer.boolean(true);
  writer.text("abc");
  ByteReader reader(writer.bytes());
  EXPECT_EQ(reader.u8(), 1);
  EXPECT_EQ(reader.u16(), 0x0203);
  EXPECT_EQ(reader.u32(), 0x04050607u);
  EXPECT_EQ(reader.u64(), 0x08090A0B0C0D0E0Fu);
  EXPECT_EQ(reader.i64(), -2);
  EXPECT_TRUE(reader.boolean());
  EXPECT_EQ(reader.text(), "abc");
  EXPECT_TRUE(reader.done());
}

TEST(Bytes, LittleEndian) {
  ByteWriter writer;
  writer.u32(0x04030201);
  EXPECT_EQ(writer.take(), (Bytes{1, 2, 3, 4}));
}

TEST(Bytes, ReadingPastTheEndLatches) {
  Bytes bytes{1, 2, 3};
  ByteReader reader(bytes);
  EXPECT_EQ(reader.u32(), 0u);
  EXPECT_TRUE(reader.failed());
  EXPECT_EQ(reader.u8(), 0);
  EXPECT_EQ(reader.left(), 0u);
  EXPECT_FALSE(reader.done());
}

TEST(Bytes, HostileCountsAndLengths) {
  ByteWriter writer;
  writer.u32(0xffffffff);
  ByteReader as_count(writer.bytes());
  EXPECT_EQ(as_count.count(8), 0u);
  EXPECT_TRUE(as_count.failed());
  ByteReader as_text(writer.bytes());
  EXPECT_EQ(as_text.text(), "");
  EXPECT_TRUE(as_text.failed());
  Bytes two{2};
  ByteReader as_bool(two);
  as_bool.boolean();
  EXPECT_TRUE(as_bool.failed());
}

TEST(Hash, Sha256KnownAnswers) {
  EXPECT_EQ(to_hex(sha256({})), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(to_hex(sha256(as_bytes("abc"))),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(to_hex(sha256(as_bytes("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"))),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  std::string million(1'000'000, 'a');
  EXPECT_EQ(to_hex(sha256(as_bytes(million))),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

// Whatever two texts have in common, and whatever is said of it that is true.
TEST(Hash, Sha256GoesOnWhereAnotherBegan) {
  constexpr size_t kStep = Sha256Trail::kStep;
  Bytes first(3 * kStep + 100);
  for (size_t i = 0; i < first.size(); ++i) first[i] = static_cast<uint8_t>(i * 7 + i / 251);
  Sha256Trail known;
  EXPECT_EQ(sha256(first, {}, 0, known), sha256(first));
  EXPECT_EQ(known.states.size(), 3u);
  for (const size_t at :
       {size_t{0}, kStep - 1, kStep, 2 * kStep + 5, 3 * kStep, first.size() - 1}) {
    for (const size_t size : {at + 1, kStep, 3 * kStep, first.size(), 5 * kStep + 1}) {
      Bytes other = first;
      other.resize(size, 3);
      if (at < size) other[at] ^= 1;
      Sha256Trail alone;
      EXPECT_EQ(sha256(other, {}, 0, alone), sha256(other));
      for (const size_t same : {std::min(at, size), std::min(at, size) / 2}) {
        Sha256Trail trail;
        EXPECT_EQ(sha256(other, known, same, trail), sha256(other));
        EXPECT_EQ(trail.states, alone.states);
      }
    }
  }
}

TEST(Hash, HexRoundTrip) {
  Digest digest = sha256(as_bytes("abc"));
  Digest back{};
  EXPECT_TRUE(digest_from_hex(to_hex(digest), back));
  EXPECT_EQ(back, digest);
  EXPECT_EQ(short_hex(digest), "ba7816bf8f01");
  EXPECT_FALSE(digest_from_hex("ba78", back));
  EXPECT_FALSE(digest_from_hex(std::string(64, 'g'), back));
}

TEST(Sha256, TwoPiecesAreAsOneWhereverTheyMeet) {
  Bytes data(300);
  for (size_t i = 0; i < data.size(); ++i) data[i] = static_cast<uint8_t>(i * 31 + 7);
  for (size_t size : {0, 1, 55, 56, 63, 64, 65, 119, 128, 300}) {
    const ByteSpan all = ByteSpan(data).first(size);
    for (size_t at = 0; at <= size; ++at) {
      EXPECT_EQ(sha256(all.first(at), all.subspan(at)), sha256(all)) << size << " " << at;
    }
  }
}

TEST(Sha256, WithAndWithoutProcessorInstructions) {
  std::array<uint8_t, 64 * 5> data{};
  for (size_t i = 0; i < data.size(); ++i) data[i] = static_cast<uint8_t>(i * 37 + i / 64);
  Sha256State portable{1, 2, 3, 4, 5, 6, 7, 0xffffffff};
  Sha256State fast = portable;
  sha256_blocks_portable(portable, data.data(), 5);
  if (!sha256_blocks_x86(fast, data.data(), 5)) GTEST_SKIP() << "not on this processor";
  EXPECT_EQ(portable, fast);
}

TEST(Crc32c, WithAndWithoutProcessorInstructions) {
  EXPECT_EQ(crc32c(as_bytes("123456789")), 0xe3069283u);
  std::array<uint8_t, 70> data{};
  for (size_t i = 0; i < data.size(); ++i) data[i] = static_cast<uint8_t>(i * 37 + 11);
  for (size_t size = 0; size <= data.size(); ++size) {
    const ByteSpan part = ByteSpan(data).first(size);
    EXPECT_EQ(crc32c(part), crc32c_portable(part)) << size;
  }
}

}  // namespace
}  // namespace base
