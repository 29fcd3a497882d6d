// What is verified with the help of an earlier version gets the answer that it gets alone.
#include "ir/bytecode/proof.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/fuzz/image_changes.h"
#include "tests/unit/bytecode/sample_objects.h"

namespace ir::verification {
namespace {

using Proven = base::Result<std::shared_ptr<const Proof>>;

std::shared_ptr<const base::Bytes> shared(base::Bytes bytes) {
  return std::make_shared<const base::Bytes>(std::move(bytes));
}

bool same_facts(const std::shared_ptr<const CodeFacts>& x,
                const std::shared_ptr<const CodeFacts>& y) {
  if (x == nullptr || y == nullptr) return x == y;
  const CodeFacts& a = *x;
  const CodeFacts& b = *y;
  return a.callees == b.callees && a.written_outputs == b.written_outputs &&
         a.native_bytes == b.native_bytes && a.parameters_of == b.parameters_of &&
         a.constants == b.constants && a.bounds_end == b.bounds_end && a.ranges_end == b.ranges_end;
}

bool same_writer(const OutputWriter& a, const OutputWriter& b) {
  return a.data == b.data && a.size == b.size && a.task == b.task;
}

void expect_same(const Proven& alone, const Proven& helped) {
  ASSERT_EQ(alone.ok(), helped.ok()) << base::to_string((alone.ok() ? helped : alone).error());
  if (!alone.ok()) {
    EXPECT_EQ(base::to_string(alone.error()), base::to_string(helped.error()));
    return;
  }
  const Proof& a = **alone;
  const Proof& b = **helped;
  EXPECT_EQ(encode(b.image), encode(a.image));
  EXPECT_TRUE(std::equal(a.code.begin(), a.code.end(), b.code.begin(), b.code.end(), same_facts));
  EXPECT_TRUE(std::ranges::equal(a.calls.writers, b.calls.writers, same_writer));
  EXPECT_EQ(a.calls.running, b.calls.running);
  EXPECT_TRUE(std::equal(a.types->begin(), a.types->end(), b.types->begin(), b.types->end(),
                         [](const TypeFacts& x, const TypeFacts& y) {
                           return x.has_slots == y.has_slots && x.depth == y.depth;
                         }));
}

// POUs that need no look.
uint32_t left_out(const Proof& like, const Image& image) {
  const base::Bytes bytes = encode(image);
  const Likeness likeness(&like, bytes, image);
  uint32_t count = 0;
  for (uint32_t pou = 0; pou < image.pous.size(); ++pou) {
    count += likeness.code(pou) != nullptr ? 1 : 0;
  }
  return count;
}

// What was accepted is what the next ones are compared with.
void expect_same_of_changes(const Image& first, uint32_t seed) {
  constexpr int kImages = 6000;
  Proven like = prove(shared(encode(first)), nullptr);
  ASSERT_TRUE(like.ok());
  std::mt19937 random(seed);
  int accepted = 0;
  uint32_t helped = 0;
  for (int i = 0; i < kImages; ++i) {
    Image image = i % 4 == 3 ? (*like)->image : first;
    for (uint32_t changes = random() % 3; changes != 0; --changes) {
      fuzz::apply(image, {static_cast<uint8_t>(random()), static_cast<uint16_t>(random()),
                          static_cast<uint16_t>(random()), static_cast<uint8_t>(random())});
    }
    const base::Bytes bytes = encode(image);
    const Proven alone = prove(shared(bytes), nullptr);
    expect_same(alone, prove(shared(bytes), like->get()));
    if (testing::Test::HasFailure()) return;
    if (!alone.ok()) continue;
    ++accepted;
    helped += left_out(**like, image);
    like = alone;
  }
  // Both answers were compared, and of both kinds of images.
  EXPECT_GT(accepted, kImages / 10);
  EXPECT_LT(accepted, kImages * 9 / 10);
  EXPECT_GT(helped, static_cast<uint32_t>(accepted));
}

TEST(Proof, ChangedImagesGetTheAnswerThatTheyGetAlone) {
  for (uint32_t seed = 1; seed <= 3; ++seed) expect_same_of_changes(sample::busy_image(), seed);
}

TEST(Proof, ChangedImagesWithMethodsGetTheAnswerThatTheyGetAlone) {
  for (uint32_t seed = 1; seed <= 3; ++seed) {
    expect_same_of_changes(sample::busy_object_image(), seed);
  }
}

TEST(Proof, OnlyThePouThatDiffersIsLookedAt) {
  const Proven first = prove(shared(encode(sample::busy_image())), nullptr);
  ASSERT_TRUE(first.ok());
  Image image = sample::busy_image();
  const auto pous = static_cast<uint32_t>(image.pous.size());
  EXPECT_EQ(left_out(**first, image), pous);
  image.pous[sample::kCounterPou].frame_size += 8;
  EXPECT_EQ(left_out(**first, image), pous - 1);
  image.pous[sample::kAddPou].slots[0].local = LocalKind::kOutput;  // its caller finds another one
  EXPECT_EQ(left_out(**first, image), pous - 3);
  image = sample::busy_image();
  image.instances[0].data += 8;  // all code names globals by their place
  EXPECT_EQ(left_out(**first, image), 0u);
}

// The linker gives the place of a constant that nobody names any more to another one: it is no
// concern of POUs that name others, in front of it or behind.
TEST(Proof, AConstantConcernsWhoNamesIt) {
  const Proven first = prove(shared(encode(sample::busy_image())), nullptr);
  ASSERT_TRUE(first.ok());
  const Image image = sample::busy_image();
  const auto names = [](const CodeFacts& facts, size_t byte) {
    return std::any_of(facts.constants.begin(), facts.constants.end(), [&](const Extent& one) {
      return one.offset <= byte && byte < one.offset + one.size;
    });
  };
  uint32_t concerned = 0;
  for (size_t byte = 0; byte < image.pool.size(); ++byte) {
    Image other = image;
    other.pool[byte] ^= 1;
    const auto count = static_cast<uint32_t>(
        std::count_if((*first)->code.begin(), (*first)->code.end(),
                      [&](const auto& facts) { return facts != nullptr && names(*facts, byte); }));
    EXPECT_EQ(left_out(**first, other), image.pous.size() - count) << byte;
    concerned += count;
  }
  EXPECT_GT(concerned, 0u);
  Image shorter = image;
  shorter.pool.clear();
  EXPECT_LT(left_out(**first, shorter), image.pous.size());
  Image longer = image;
  longer.pool.resize(image.pool.size() + 8, 7);
  EXPECT_EQ(left_out(**first, longer), image.pous.size());
}

// The graph of calls goes by what the code of POUs calls and what their frames take.
TEST(Proof, CallsAreMeasuredWhereTheyDiffer) {
  const Proven first = prove(shared(encode(sample::busy_image())), nullptr);
  ASSERT_TRUE(first.ok());
  const auto knows_calls = [&](const Image& image) {
    const base::Bytes bytes = encode(image);
    const KnownImage known{(*first)->image, *(*first)->encoded, (*first)->places};
    const Image beside = decode(bytes, &known)->image;
    return Likeness(first->get(), bytes, beside).calls((*first)->code);
  };
  Image image = sample::busy_image();
  EXPECT_TRUE(knows_calls(image));
  image.pous[sample::kCounterPou].frame_size += 8;
  EXPECT_FALSE(knows_calls(image));
  image = sample::busy_image();
  image.stack_bytes -= 8;
  EXPECT_FALSE(knows_calls(image));
  image = sample::busy_image();
  image.tasks[0].priority += 1;
  EXPECT_FALSE(knows_calls(image));
  image = sample::busy_image();
  image.call_depth += 1;
  EXPECT_FALSE(knows_calls(image));
}

TEST(Proof, WhatLookupsGoByIsShared) {
  const Proven first = prove(shared(encode(sample::busy_image())), nullptr);
  ASSERT_TRUE(first.ok());
  const Proven same = prove(shared(encode(sample::busy_image())), first->get());
  ASSERT_TRUE(same.ok());
  EXPECT_EQ((*same)->regions, (*first)->regions);
  EXPECT_EQ((*same)->areas, (*first)->areas);
}

// verify() finds what is held by itself.
TEST(Proof, VersionsThatAreHeldAnswerAsTheyDoAlone) {
  const auto held = verify(encode(sample::busy_image()));
  ASSERT_TRUE(held.ok());
  Image image = sample::busy_image();
  image.code[image.pous[sample::kMainPou].first_unit].a ^= 1;
  const base::Bytes bytes = encode(image);
  const Proven alone = prove(shared(bytes), nullptr);
  const auto beside = verify(bytes);
  ASSERT_EQ(alone.ok(), beside.ok());
  if (!alone.ok()) {
    EXPECT_EQ(base::to_string(alone.error()), base::to_string(beside.error()));
  }
}

}  // namespace
}  // namespace ir::verification
