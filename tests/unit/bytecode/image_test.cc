// The stored form of images: what is written is read, and nothing else is.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "ir/bytecode/image_sections.h"
#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_image.h"

namespace {

using base::Refusal;

TEST(Image, IsTheSameAfterDecoding) {
  const base::Bytes bytes = ir::encode(sample::busy_image());
  const auto decoded = ir::decode(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().text;
  EXPECT_EQ(ir::encode(*decoded), bytes);
  EXPECT_EQ(decoded->pous[sample::kMainPou].file, "main.st");
  EXPECT_EQ(decoded->instances[3].name, "fbs[0]");
}

TEST(Image, AnonymousTypesAreFoundByContentAfterDecoding) {
  auto decoded = ir::decode(ir::encode(sample::busy_image()));
  ASSERT_TRUE(decoded.ok());
  const uint32_t before = decoded->types.size();
  decoded->types.own().string(10);
  decoded->types.own().array(decoded->types.elementary(ir::Kind::kInt), {{1, 4}});
  EXPECT_EQ(decoded->types.size(), before);
}

TEST(Image, DigestIsTheOneInTheHeader) {
  const base::Bytes bytes = ir::encode(sample::busy_image());
  const base::Digest digest = ir::digest(bytes);
  EXPECT_EQ(digest, base::sha256(base::ByteSpan(bytes).subspan(48)));
  EXPECT_EQ(ir::verify(bytes)->digest(), digest);
}

TEST(Image, EveryTruncationIsRefused) {
  const base::Bytes bytes = ir::encode(sample::busy_image());
  for (size_t length = 0; length < bytes.size(); ++length) {
    ASSERT_FALSE(ir::decode(base::ByteSpan(bytes).first(length)).ok()) << length;
  }
}

TEST(Image, EverySingleBitFlipIsRefused) {
  base::Bytes bytes = ir::encode(sample::busy_image());
#ifdef NDEBUG
  constexpr size_t kStep = 1;
#else
  constexpr size_t kStep = 13;  // hashing without optimiser is slow; odd, so every bit of a byte
#endif
  for (size_t bit = 0; bit < bytes.size() * 8; bit += kStep) {
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
    ASSERT_FALSE(ir::decode(bytes).ok()) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
  }
  EXPECT_TRUE(ir::decode(bytes).ok());
}

TEST(Image, RefusalsOfTheForm) {
  base::Bytes bytes = ir::encode(sample::busy_image());
  base::Bytes longer = bytes;
  longer.push_back(0);
  EXPECT_EQ(ir::decode(longer).error().refusal, Refusal::kBadFormat);
  bytes.back() ^= 1;
  EXPECT_EQ(ir::decode(bytes).error().refusal, Refusal::kBadHash);
  EXPECT_EQ(ir::decode({}).error().refusal, Refusal::kBadFormat);
}

// An image whose resource sends first is what it was before there were schedules; the other one
// says that older controllers cannot run it. One image has one stored form.
TEST(Image, ScheduleIsStoredWhereItIsNotTheFirst) {
  constexpr size_t kVersionAt = 8;
  ir::Image image = sample::busy_image();
  const base::Bytes usual = ir::encode(image);
  EXPECT_EQ(usual[kVersionAt], 7);
  image.schedule = ir::Schedule::kRunFirst;
  base::Bytes other = ir::encode(image);
  EXPECT_EQ(other[kVersionAt], 8);
  EXPECT_EQ(other.size(), usual.size() + 1);
  EXPECT_NE(ir::digest(other), ir::digest(usual));
  const auto decoded = ir::decode(other);
  ASSERT_TRUE(decoded.ok()) << decoded.error().text;
  EXPECT_EQ(decoded->schedule, ir::Schedule::kRunFirst);
  EXPECT_EQ(ir::encode(*decoded), other);
  EXPECT_EQ(ir::decode(usual)->schedule, ir::Schedule::kSendFirst);
  for (const uint8_t version : {6, 7, 9}) {
    other[kVersionAt] = version;
    EXPECT_EQ(ir::decode(other).error().refusal, Refusal::kBadFormat);
  }
  // The first one, said in a byte of its own.
  other[kVersionAt] = 8;
  const size_t at = 48 + 8 + ir::section_of(other, ir::ImageSection::kProgram).size() - 1;
  ASSERT_EQ(other[at], 1);
  for (const uint8_t schedule : {0, 2}) {
    other[at] = schedule;
    const base::Digest sum = base::sha256(base::ByteSpan(other).subspan(48));
    std::copy(sum.begin(), sum.end(), other.begin() + 16);
    EXPECT_EQ(ir::decode(other).error().refusal, Refusal::kBadFormat) << int{schedule};
  }
}

// Buffers of outputs and exchanges of tasks stand in bytes that there were before, so all other
// images are what they were; those that have some say that older controllers cannot run them.
TEST(Image, B5_B12_TaskExchangeIsStoredWhereThereIsSome) {
  constexpr size_t kVersionAt = 8;
  const ir::Image usual = sample::busy_image();
  const base::Bytes before = ir::encode(usual);
  const auto set = [&](ir::IoBuffer buffer, ir::TaskExchange exchange) {
    ir::Image image = usual;
    image.tasks[0].policy.input_buffer = ir::IoBuffer::kThree;
    image.tasks[0].policy.output_buffer = buffer;
    image.tasks[0].policy.exchange = exchange;
    return image;
  };
  EXPECT_EQ(ir::encode(set(ir::IoBuffer::kCopied, ir::TaskExchange::kOfCycle))[kVersionAt], 7);
  const ir::Image images[] = {set(ir::IoBuffer::kFirstUnseen, ir::TaskExchange::kOfCycle),
                              set(ir::IoBuffer::kCopied, ir::TaskExchange::kOwn),
                              set(ir::IoBuffer::kLocked, ir::TaskExchange::kOwn)};
  for (const ir::Image& image : images) {
    base::Bytes bytes = ir::encode(image);
    EXPECT_EQ(bytes[kVersionAt], 15);
    EXPECT_EQ(bytes.size(), before.size());
    const auto decoded = ir::decode(bytes);
    ASSERT_TRUE(decoded.ok()) << decoded.error().text;
    EXPECT_EQ(decoded->tasks[0].policy, image.tasks[0].policy);
    EXPECT_EQ(ir::encode(*decoded), bytes);
    for (const uint8_t version : {7, 8, 11, 13, 16, 17}) {
      bytes[kVersionAt] = version;
      EXPECT_EQ(ir::decode(bytes).error().refusal, Refusal::kBadFormat) << int{version};
    }
  }
}

// What code holds of others is stored where there is some, behind the contents of POUs (E-04).
TEST(Image, E04_HeldPartsAreStoredWhereThereAreSome) {
  constexpr size_t kVersionAt = 8;
  ir::Image image = sample::busy_image();
  image.contents.assign(image.pous.size(), ir::PouContent{});
  image.contents[0].identity[3] = 1;
  EXPECT_EQ(ir::encode(image)[kVersionAt], 11);
  image.held.push_back({0, {ir::HeldKind::kFunction, "Add"}});
  image.held.push_back({0, {ir::HeldKind::kGlobal, "limit"}});
  image.held.push_back({1, {ir::HeldKind::kType, "Mode"}});
  const base::Bytes bytes = ir::encode(image);
  EXPECT_EQ(bytes[kVersionAt], 13);
  const auto decoded = ir::decode(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().text;
  EXPECT_EQ(decoded->held.all(), image.held.all());
  EXPECT_EQ(ir::encode(*decoded), bytes);
  EXPECT_TRUE(ir::verify(bytes).ok());
  // Rows in another order, twice, of a POU that is not there, or without contents.
  for (int wrong = 0; wrong < 4; ++wrong) {
    ir::Image bad = image;
    if (wrong == 0) std::swap(bad.held.own()[0], bad.held.own()[1]);
    if (wrong == 1) bad.held.push_back(bad.held.back());
    if (wrong == 2) bad.held.own().back().pou = static_cast<uint32_t>(bad.pous.size());
    if (wrong == 3) bad.contents.clear();
    EXPECT_FALSE(ir::verify(ir::encode(bad)).ok()) << wrong;
  }
}

// Units that are not those of POUs are stored where there are some, behind the POUs (E-01).
TEST(Image, E01_UnitMembersAreStoredWhereThereAreSome) {
  constexpr size_t kVersionAt = 8;
  ir::Image image = sample::busy_image();
  image.unit_members = {{"Line.Fill", "Filling"}, {"pump", "Pumping"}};
  base::Bytes bytes = ir::encode(image);
  EXPECT_EQ(bytes[kVersionAt], 19);
  const auto decoded = ir::decode(bytes);
  ASSERT_TRUE(decoded.ok()) << decoded.error().text;
  EXPECT_EQ(decoded->unit_members, image.unit_members);
  EXPECT_EQ(ir::encode(*decoded), bytes);
  EXPECT_TRUE(ir::verify(bytes).ok());
  for (const uint8_t version : {7, 11, 13, 17, 18, 20, 21}) {
    bytes[kVersionAt] = version;
    EXPECT_EQ(ir::decode(bytes).error().refusal, Refusal::kBadFormat) << int{version};
  }
  // Rows in another order, and one name twice.
  ir::Image bad = image;
  std::swap(bad.unit_members[0], bad.unit_members[1]);
  EXPECT_EQ(ir::verify(ir::encode(bad)).error().refusal, Refusal::kBadFormat);
  bad = image;
  bad.unit_members[0].name = "PUMP";
  EXPECT_EQ(ir::verify(ir::encode(bad)).error().refusal, Refusal::kBadFormat);
}

// The header says a length that the limit allows, and one byte more.
TEST(Image, LargestImage) {
  constexpr size_t kLengthAt = 12;
  base::Bytes bytes = ir::encode(sample::busy_image());
  auto refusal_of = [&](uint32_t length) {
    for (size_t i = 0; i < 4; ++i) bytes[kLengthAt + i] = static_cast<uint8_t>(length >> (8 * i));
    return ir::decode(bytes).error().refusal;
  };
  EXPECT_EQ(refusal_of(base::kMaxImageBytes), Refusal::kBadFormat);  // there are fewer
  EXPECT_EQ(refusal_of(base::kMaxImageBytes + 1), Refusal::kTooLarge);
}

TEST(Image, InitialBytesBetweenRunsAreZero) {
  ir::Image image;
  image.data = {{100, {1, 2}}, {104, {3}}};
  uint8_t bytes[8];
  ir::read_initial(image, 99, bytes);
  const uint8_t expected[8] = {0, 1, 2, 0, 0, 3, 0, 0};
  EXPECT_EQ(std::memcmp(bytes, expected, 8), 0);
}

TEST(Image, PathsOfInstances) {
  const ir::Image image = sample::busy_image();
  EXPECT_EQ(image.instance_path(0), "");
  EXPECT_EQ(image.instance_path(3), "Main.fbs[0]");
  EXPECT_EQ(image.program_ids(), std::vector<uint32_t>{1});
}

TEST(Image, DisassemblyNamesWhatItShows) {
  const ir::Image image = sample::busy_image();
  const std::string text = ir::disassemble(image, image.pous[sample::kMainPou]);
  EXPECT_NE(text.find("CALL"), std::string::npos);
  EXPECT_NE(text.find("Add"), std::string::npos);
  EXPECT_NE(text.find("numbers[1..+4 by 2]"), std::string::npos);
  EXPECT_NE(text.find("; line 7"), std::string::npos);
}

}  // namespace
