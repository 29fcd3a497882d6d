// The file by which an edit goes to many controllers (E-07).
#include <gtest/gtest.h>

#include "base/sha256.h"
#include "base/tool_limits.h"
#include "online_change/package/fleet_file.h"

namespace online_change {
namespace {

FleetFile sample_file() {
  FleetFile file;
  file.author = "ann";
  file.text = "twice as fast";
  for (int i = 0; i < 3000; ++i) file.original.push_back(static_cast<uint8_t>(i * i >> 3));
  file.edited = file.original;
  file.edited[1500] ^= 1;
  file.edited.push_back(7);
  return file;
}

TEST(FleetFiles, E07_ComeBackAsTheyWere) {
  const FleetFile file = sample_file();
  const base::Bytes bytes = encode(file);
  EXPECT_EQ(bytes, encode(sample_file()));
  EXPECT_TRUE(has_fleet_magic(bytes));
  const base::Result<FleetFile> again = decode_fleet_file(bytes);
  ASSERT_TRUE(again.ok()) << again.error().text;
  EXPECT_EQ(again->author, file.author);
  EXPECT_EQ(again->text, file.text);
  EXPECT_EQ(again->original, file.original);
  EXPECT_EQ(again->edited, file.edited);
  // The second version is mostly the first one.
  EXPECT_LT(bytes.size(), file.original.size() + 400);
}

TEST(FleetFiles, E07_EveryTruncationAndBitFlipIsRefused) {
  base::Bytes bytes = encode(sample_file());
  for (size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_FALSE(decode_fleet_file(base::ByteSpan(bytes).first(length)).ok()) << length;
  }
  for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    const base::Result<FleetFile> file = decode_fleet_file(bytes);
    ASSERT_FALSE(file.ok()) << "bit " << bit;
    ASSERT_FALSE(file.error().text.empty());
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
  }
  bytes.push_back(0);
  EXPECT_FALSE(decode_fleet_file(bytes).ok());
}

TEST(FleetFiles, E07_AChecksumNamesItsPart) {
  const base::Bytes good = encode(sample_file());
  base::Bytes bytes = good;
  bytes[16 + 36 + 5] ^= 1;  // behind magic, version, length, and the part's length and checksum
  EXPECT_EQ(decode_fleet_file(bytes).error().refusal, base::Refusal::kBadHash);
  EXPECT_NE(decode_fleet_file(bytes).error().text.find("texts"), std::string::npos);
  bytes = good;
  bytes.back() ^= 1;
  EXPECT_NE(decode_fleet_file(bytes).error().text.find("versions"), std::string::npos);
}

TEST(FleetFiles, E17_TheFileSaysWhetherItsTableIsFree) {
  FleetFile file = sample_file();
  EXPECT_FALSE(decode_fleet_file(encode(file))->free_table);
  file.free_table = true;
  EXPECT_TRUE(decode_fleet_file(encode(file))->free_table);
}

TEST(FleetFiles, E25_HowTheUnitsStartIsInTheFile) {
  FleetFile file = sample_file();
  EXPECT_TRUE(decode_fleet_file(encode(file))->steps.empty());
  file.steps = {"", "B", "A"};
  file.steps_if_needed = true;
  const FleetFile back = *decode_fleet_file(encode(file));
  EXPECT_EQ(back.steps, file.steps);
  EXPECT_TRUE(back.steps_if_needed);
  file.steps.assign(base::kMostEditsOnTrial, "A");
  EXPECT_TRUE(decode_fleet_file(encode(file)).ok());
  file.steps.emplace_back("B");
  EXPECT_EQ(decode_fleet_file(encode(file)).error().refusal, base::Refusal::kBadFormat);
}

// The first version does not say whether its table is free, and the second one not how its units
// start: these bytes are missing at the end of its texts.
base::Bytes of_version(const FleetFile& file, uint32_t version) {
  const uint32_t missing = version == 1 ? 6 : 5;
  const base::Bytes now = encode(file);
  base::ByteReader in(now);
  base::ByteWriter out;
  out.raw(in.raw(kFleetMagic.size()));
  (void)in.u64();
  const uint32_t size = in.u32();
  (void)in.raw(sizeof(base::Digest));
  const base::ByteSpan texts = in.raw(size).first(size - missing);
  out.u32(version);
  out.u32(static_cast<uint32_t>(now.size() - missing));
  out.u32(size - missing);
  out.raw(base::sha256(texts));
  out.raw(texts);
  out.raw(in.raw(in.left()));
  return out.take();
}

TEST(FleetFiles, E17_AFileOfTheFirstVersionIsRestricted) {
  const base::Result<FleetFile> file = decode_fleet_file(of_version(sample_file(), 1));
  ASSERT_TRUE(file.ok()) << file.error().text;
  EXPECT_EQ(file->text, "twice as fast");
  EXPECT_FALSE(file->free_table);
}

TEST(FleetFiles, E25_InAFileOfTheSecondVersionAllStartTogether) {
  FleetFile free = sample_file();
  free.free_table = true;
  const base::Result<FleetFile> file = decode_fleet_file(of_version(free, 2));
  ASSERT_TRUE(file.ok()) << file.error().text;
  EXPECT_TRUE(file->free_table);
  EXPECT_TRUE(file->steps.empty());
}

// Few bytes that say they become very many.
TEST(FleetFiles, BoundedByTheLengthsThatItSays) {
  FleetFile file = sample_file();
  file.original.assign(1 << 20, 0);
  const base::Bytes bytes = encode(file);
  EXPECT_LT(bytes.size(), size_t{20000});
  EXPECT_TRUE(decode_fleet_file(bytes).ok());
}

}  // namespace
}  // namespace online_change
