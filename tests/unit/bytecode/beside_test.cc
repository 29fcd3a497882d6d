// What is decoded or encoded beside another version is what it is alone.
#include "ir/bytecode/image_beside.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/fuzz/image_changes.h"
#include "tests/unit/bytecode/sample_objects.h"

namespace ir {
namespace {

bool same_place(const ImagePlaces::Table& a, const ImagePlaces::Table& b) {
  return a.begin == b.begin && a.end == b.end;
}

void expect_same(const ImagePlaces& a, const ImagePlaces& b) {
  EXPECT_TRUE(std::equal(a.pous.begin(), a.pous.end(), b.pous.begin(), b.pous.end(),
                         [](const ImagePlaces::Pou& x, const ImagePlaces::Pou& y) {
                           return x.slots == y.slots && x.merges == y.merges &&
                                  x.lines == y.lines && x.end == y.end;
                         }));
  EXPECT_TRUE(same_place(a.bounds, b.bounds));
  EXPECT_TRUE(same_place(a.ranges, b.ranges));
  EXPECT_TRUE(same_place(a.instances, b.instances));
  EXPECT_EQ(a.trail.states, b.trail.states);
}

void expect_same(const base::Result<DecodedImage>& alone,
                 const base::Result<DecodedImage>& beside) {
  ASSERT_EQ(alone.ok(), beside.ok());
  if (!alone.ok()) {
    EXPECT_EQ(base::to_string(alone.error()), base::to_string(beside.error()));
    return;
  }
  EXPECT_EQ(encode(alone->image), encode(beside->image));
  expect_same(alone->places, beside->places);
}

Image changed(Image image, std::mt19937& random) {
  for (uint32_t changes = random() % 4; changes != 0; --changes) {
    fuzz::apply(image, {static_cast<uint8_t>(random()), static_cast<uint16_t>(random()),
                        static_cast<uint16_t>(random()), static_cast<uint8_t>(random())});
  }
  return image;
}

void expect_same_of_changes(const Image& first, uint32_t seed) {
  constexpr int kImages = 4000;
  std::mt19937 random(seed);
  Image image = first;
  for (int i = 0; i < kImages && !testing::Test::HasFailure(); ++i) {
    const WrittenImage written = encode(image, nullptr);
    const KnownImage made{image, written.bytes, written.places};
    const Image next = changed(i % 8 == 0 ? first : image, random);
    const WrittenImage alone = encode(next, nullptr);
    const WrittenImage beside = encode(next, &made);
    EXPECT_EQ(alone.bytes, beside.bytes);
    expect_same(alone.places, beside.places);
    image = next;
    const base::Result<DecodedImage> before = decode(written.bytes, nullptr);
    if (!before.ok()) continue;
    const KnownImage known{before->image, written.bytes, before->places};
    expect_same(decode(alone.bytes, nullptr), decode(alone.bytes, &known));
    base::Bytes damaged = alone.bytes;
    damaged[random() % damaged.size()] ^= static_cast<uint8_t>(1 + random() % 255);
    expect_same(decode(damaged, nullptr), decode(damaged, &known));
  }
}

TEST(Beside, ASampleImageAndChangesOfIt) { expect_same_of_changes(sample::busy_image(), 1); }

TEST(Beside, ObjectsAndChangesOfThem) { expect_same_of_changes(sample::busy_object_image(), 2); }

// The damage is found although the sum of the part before it is known.
TEST(Beside, DamageInWhatIsKnownIsFound) {
  Image image = sample::busy_image();
  image.pool.assign(size_t{5} << 20, 7);
  const WrittenImage made = encode(image, nullptr);
  const KnownImage known{image, made.bytes, made.places};
  EXPECT_GT(made.places.trail.states.size(), 64u);
  for (const size_t at : {size_t{100}, made.bytes.size() / 2, made.bytes.size() - 1}) {
    base::Bytes damaged = made.bytes;
    damaged[at] ^= 1;
    const auto decoded = decode(damaged, &known);
    ASSERT_FALSE(decoded.ok());
    EXPECT_EQ(decoded.error().refusal, base::Refusal::kBadHash);
  }
  base::Bytes longer = made.bytes;
  longer[20] ^= 1;  // another digest in the header
  EXPECT_FALSE(decode(longer, &known).ok());
}

TEST(Beside, WhatIsTheSameIsShared) {
  const Image first = sample::busy_image();
  const WrittenImage made = encode(first, nullptr);
  const KnownImage known{first, made.bytes, made.places};
  Image edited = first;
  edited.pous[0].frame_size += 8;
  edited.pous[1].lines.push_back({1, 999});
  EXPECT_FALSE(first.pous[1].lines.is_one_with(edited.pous[1].lines));
  const auto decoded = decode(encode(edited), &known);
  ASSERT_TRUE(decoded.ok());
  const Image& next = decoded->image;
  EXPECT_TRUE(next.types.is_one_with(first.types));
  EXPECT_TRUE(next.layouts.is_one_with(first.layouts));
  EXPECT_TRUE(next.constants.is_one_with(first.constants));
  EXPECT_TRUE(next.instances.is_one_with(first.instances));
  EXPECT_TRUE(next.data.is_one_with(first.data));
  EXPECT_TRUE(next.pous[0].slots.is_one_with(first.pous[0].slots));
  EXPECT_FALSE(next.pous[1].lines.is_one_with(first.pous[1].lines));
  EXPECT_EQ(next.pous[1].lines.back().line, 999u);
}

// Whoever changes a copy leaves the original as it was.
TEST(Beside, CopiesAreOneUntilTheyAreChanged) {
  const Image first = sample::busy_image();
  const base::Bytes before = encode(first);
  Image copy = first;
  copy.types.own().declare(ir::Type());
  copy.layouts.own().of.emplace_back();
  copy.instances[0].data += 8;
  copy.pous[0].slots.clear();
  for (ir::LinkedPou& pou : copy.pous) pou.lines.resize(9);
  EXPECT_EQ(encode(first), before);
  EXPECT_NE(encode(copy), before);
}

}  // namespace
}  // namespace ir
