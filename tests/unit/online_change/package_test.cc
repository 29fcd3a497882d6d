// The change package: its form (C4), and V17: a plan that does not fit the two
// images is refused, whatever is wrong with it.
#include "online_change/package/package.h"
#include "online_change/package/stored_step.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

#include "base/limits.h"
#include "ir/bytecode/symbols.h"
#include "online_change/diff/areas.h"

#include "tests/unit/online_change/hand_made.h"

namespace online_change {
namespace {

using hand_made::Version;
using ir::Kind;

struct Pair {
  Version a;
  Version b;
  Package package;
};

// Every kind of step: conversion of an array, copy, early and late initialisation.
std::unique_ptr<Pair> make_pair() {
  auto pair = std::make_unique<Pair>();
  auto make = [](Version& v, bool edited) {
    ir::TypeId integer = v.elementary(Kind::kInt);
    ir::TypeId inner = v.block("Inner", {{"n", integer, 2}});
    std::vector<hand_made::Var> vars = {
        {"i", inner}, {"k", integer}, {"s", v.image.types.own().string(8)}};
    if (edited) vars.push_back({"big", v.array(integer, {{0, 99}})});
    ir::TypeId outer = v.block("Outer", vars);
    ir::TypeId element = edited ? v.elementary(Kind::kLint) : integer;
    v.program("Main", {{"o", outer},
                       {"v", v.array(element, {{0, 4}})},
                       {"w", edited ? v.image.types.own().string(4) : integer},
                       {"x", integer},
                       {"c", integer, edited ? 2u : 1u, true}});
  };
  make(pair->a, false);
  pair->a.link(nullptr, 64);  // Main stays in its area, Outer outgrows it
  make(pair->b, true);
  pair->b.link(&pair->a, 64);
  pair->package.forward = *plan(pair->a.image, pair->b.image);
  pair->package.inverse = *inverse_plan(pair->a.image, pair->b.image);
  pair->package.image = {1, 2, 3};
  return pair;
}

base::Status check(const Pair& pair) {
  return check_package(pair.package, pair.a.image, pair.b.image);
}

UpdateStep& first_step(Package& package, StepKind kind) {
  for (UpdateStep& step : package.forward.steps) {
    if (step.kind() == kind) return step;
  }
  ADD_FAILURE() << "no such step";
  return package.forward.steps[0];
}

TEST(Package, C4_survives_encoding) {
  auto pair = make_pair();
  base::Bytes bytes = encode(pair->package);
  base::Result<Package> again = decode(bytes);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(encode(*again), bytes);
  EXPECT_EQ(again->forward.steps.size(), pair->package.forward.steps.size());
  EXPECT_EQ(again->forward.counts.total(), pair->package.forward.counts.total());
  EXPECT_TRUE(check_package(*again, pair->a.image, pair->b.image).ok());
}

TEST(Package, C4_every_truncation_and_bit_flip_is_refused) {
  auto pair = make_pair();
  base::Bytes bytes = encode(pair->package);
  for (size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_FALSE(decode(base::ByteSpan(bytes).first(length)).ok()) << length;
  }
  for (size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
    EXPECT_FALSE(decode(bytes).ok()) << bit;
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << (bit % 8));
  }
}

// magic and version; then for each part its length and checksum.
constexpr size_t kPartRow = 4 + 32;
size_t part_length(const base::Bytes& bytes, size_t part) {
  return base::ByteReader(base::ByteSpan(bytes).subspan(8 + part * kPartRow)).u32();
}

// With the images' own bytes.
std::unique_ptr<Pair> make_whole_pair() {
  auto pair = make_pair();
  pair->package.base = ir::digest(ir::encode(pair->a.image));
  pair->package.image = ir::encode(pair->b.image);
  return pair;
}

TEST(Package, C4_the_damaged_part_is_named) {
  const base::Bytes bytes = encode(make_whole_pair()->package);
  const char* const kNames[] = {"layout", "program", "commands"};
  size_t at = 8 + 3 * kPartRow;
  for (size_t part = 0; part < 3; ++part) {
    ASSERT_GT(part_length(bytes, part), 0u);
    base::Bytes damaged = bytes;
    at += part_length(bytes, part);
    damaged[at - 1] ^= 0x10;
    const base::Result<Package> decoded = decode(damaged);
    ASSERT_FALSE(decoded.ok());
    EXPECT_EQ(decoded.error().refusal, base::Refusal::kBadHash);
    EXPECT_NE(decoded.error().text.find(kNames[part]), std::string::npos) << decoded.error().text;
  }
  EXPECT_EQ(at, bytes.size());
}

// Parts of two packages, each with the right checksum, are no package.
TEST(Package, C4_parts_of_different_packages_do_not_mix) {
  const auto pair = make_whole_pair();
  Package back;
  back.base = ir::digest(pair->package.image);
  back.image = ir::encode(pair->a.image);
  back.forward = pair->package.inverse;
  back.inverse = pair->package.forward;
  const base::Bytes one = encode(pair->package);
  const base::Bytes other = encode(back);
  for (size_t foreign = 0; foreign < 3; ++foreign) {
    base::Bytes mixed(one.begin(), one.begin() + 8);
    base::Bytes content;
    size_t one_at = 8 + 3 * kPartRow;
    size_t other_at = one_at;
    for (size_t part = 0; part < 3; ++part) {
      const base::Bytes& from = part == foreign ? other : one;
      const size_t at = part == foreign ? other_at : one_at;
      const base::ByteSpan row = base::ByteSpan(from).subspan(8 + part * kPartRow, kPartRow);
      const base::ByteSpan bytes = base::ByteSpan(from).subspan(at, part_length(from, part));
      mixed.insert(mixed.end(), row.begin(), row.end());
      content.insert(content.end(), bytes.begin(), bytes.end());
      one_at += part_length(one, part);
      other_at += part_length(other, part);
    }
    mixed.insert(mixed.end(), content.begin(), content.end());
    const base::Result<Package> decoded = decode(mixed);
    if (!decoded.ok()) continue;
    const base::Result<ir::Image> image = ir::decode(decoded->image);
    const bool sound = image.ok() && decoded->base == pair->package.base &&
                       check_package(*decoded, pair->a.image, *image).ok();
    EXPECT_FALSE(sound) << foreign;
  }
}

// The header says a length that the limit allows, and one byte more.
TEST(Package, LargestPackage) {
  constexpr size_t kLengthAt = 8;
  base::Bytes bytes = encode(make_pair()->package);
  auto refusal_of = [&](uint32_t length) {
    for (size_t i = 0; i < 4; ++i) bytes[kLengthAt + i] = static_cast<uint8_t>(length >> (8 * i));
    return decode(bytes).error().refusal;
  };
  // The first part's, and what it leaves the others.
  const auto others = static_cast<uint32_t>(part_length(bytes, 1) + part_length(bytes, 2));
  const uint32_t most = base::kMaxImageBytes - others;
  EXPECT_EQ(refusal_of(most), base::Refusal::kBadFormat);  // there are fewer
  EXPECT_EQ(refusal_of(most + 1), base::Refusal::kTooLarge);
}

void expect_refused(const Pair& pair, const char* what) {
  base::Status status = check(pair);
  ASSERT_FALSE(status.ok()) << what;
  EXPECT_EQ(status.error().refusal, base::Refusal::kBadPackage);
  EXPECT_NE(status.error().text.find(what), std::string::npos) << status.error().text;
}

TEST(Package, V17_sound_plan_passes) { EXPECT_TRUE(check(*make_pair()).ok()); }

TEST(Package, V17_missing_step) {
  size_t steps = make_pair()->package.forward.steps.size();
  for (size_t i = 0; i < steps; ++i) {
    auto pair = make_pair();
    // A constant that keeps its old value is wrong, but no other variable's bytes.
    const UpdateStep& step = pair->package.forward.steps[i];
    if (step.fate != kNoFate &&
        pair->package.forward.fates[step.fate].reason == "constant changed") {
      continue;
    }
    pair->package.forward.steps.erase(pair->package.forward.steps.begin() +
                                      static_cast<ptrdiff_t>(i));
    EXPECT_FALSE(check(*pair).ok()) << i;
  }
}

TEST(Package, V17_double_target) {
  auto pair = make_pair();
  pair->package.forward.steps.push_back(pair->package.forward.steps[0]);
  expect_refused(*pair, "is written twice");
}

CopiedValues& first_copy(Package& package) {
  return *first_step(package, StepKind::kCopy).as<CopiedValues>();
}

TEST(Package, V17_copy_from_elsewhere) {
  auto pair = make_pair();
  first_copy(pair->package).from += 2;
  EXPECT_FALSE(check(*pair).ok());
  first_copy(pair->package).from = 1u << 19;
  expect_refused(*pair, "is read from outside of any area");
  first_copy(pair->package).from = 0xfffffff0u;
  expect_refused(*pair, "is read outside of memory");
}

TEST(Package, V17_target_elsewhere) {
  auto pair = make_pair();
  first_step(pair->package, StepKind::kCopy).to = 1u << 19;
  expect_refused(*pair, "is written outside of any area");
  first_step(pair->package, StepKind::kCopy).to = 0xfffffff0u;
  expect_refused(*pair, "ends outside of memory");
}

TEST(Package, V17_wrong_types) {
  auto pair = make_pair();
  auto& how = *first_step(pair->package, StepKind::kConvert).as<ConvertedValues>();
  how.old_type = pair->a.elementary(Kind::kUint);
  expect_refused(*pair, "is converted between other types than its own");
  how.old_type = ir::TypeId(100000);
  expect_refused(*pair, "has no known type");
}

TEST(Package, V17_wrong_initial_value_or_slot) {
  auto pair = make_pair();
  for (UpdateStep& step : pair->package.forward.steps) {
    if (auto* initial = step.as<InitialValues>()) initial->bytes.assign(step.total(), 0x55);
  }
  expect_refused(*pair, "is initialised with something else than its initial value");
}

TEST(Package, V17_early_step_on_bytes_in_use) {
  auto pair = make_pair();
  bool changed = false;
  for (UpdateStep& step : pair->package.forward.steps) {
    auto* const initial = step.as<InitialValues>();
    if (initial == nullptr || initial->early) continue;
    initial->early = true;  // the constant, which version 1 still reads
    changed = true;
  }
  ASSERT_TRUE(changed);
  expect_refused(*pair, "is initialised early, but the running version uses these bytes");
}

// Case 75: bytes and bits that stay at their address.
TEST(Package, V17_gathered_bytes) {
  auto pair = make_pair();
  Plan& plan = pair->package.forward;
  UpdateStep& step = first_step(pair->package, StepKind::kInitialise);
  const uint32_t from = ir::find_symbol(pair->a.image, "Main.x")->data;
  step.how = GatheredBits{0, step.as<InitialValues>()->bytes};
  auto& gathered = *step.as<GatheredBits>();
  plan.gathers = {{{from, 0, 2}, {from, 1, 0, 1, 8}}};
  ASSERT_TRUE(check(*pair).ok()) << check(*pair).error().text;
  plan.gathers[0][0].within = step.size - 1;
  expect_refused(*pair, "is written outside of it");
  plan.gathers[0][0] = {1u << 19, 0, 2};
  expect_refused(*pair, "is read from outside of any area");
  plan.gathers[0][0] = {0xfffffff0u, 0, 0xffu};
  EXPECT_FALSE(check(*pair).ok());
  plan.gathers[0][0] = {from, 0, 2};
  gathered.row = 1;
  expect_refused(*pair, "has a step of another form that gathers bytes");
  gathered.row = 0;
  gathered.rest.assign(step.total(), 0x55);
  expect_refused(*pair, "is initialised with something else than its initial value");
}

TEST(Package, V17_gathered_bytes_are_in_no_slot) {
  auto pair = make_pair();
  UpdateStep& step = first_step(pair->package, StepKind::kCopy);  // an instance's variables or slot
  step.how = GatheredBits{0, {}};
  pair->package.forward.gathers = {{{ir::find_symbol(pair->a.image, "Main.x")->data, 0, 1}}};
  EXPECT_FALSE(check(*pair).ok());
}

TEST(Package, C4_gathered_bytes_survive_and_every_truncation_is_refused) {
  auto pair = make_pair();
  pair->package.inverse.gathers = {{{40, 2, 3}, {41, 7, 0, 4, 0}}, {}};
  const base::Bytes bytes = encode(pair->package);
  const base::Result<Package> read = decode(bytes, {});
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(read->inverse.gathers.size(), 2u);
  ASSERT_EQ(read->inverse.gathers[0].size(), 2u);
  const GatheredPart& bit = read->inverse.gathers[0][1];
  EXPECT_EQ(bit.from, 41u);
  EXPECT_EQ(bit.within, 7u);
  EXPECT_EQ(bit.size, 0u);
  EXPECT_EQ(bit.from_mask, 4u);
  EXPECT_EQ(bit.to_mask, GatheredPart::kBool);
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(decode(base::ByteSpan(bytes).first(size), {}).ok()) << size;
  }
}

// What a package with other bytes says; false: it cannot be read.
bool mutate(UpdateStep& changed, std::mt19937& random) {
  StoredStep step = stored(changed);
  base::Bytes bytes = changed.bytes() == nullptr ? base::Bytes() : *changed.bytes();
  uint32_t* const kFields[] = {
      &step.from,        &step.to,        &step.size,           &step.count,
      &step.from_stride, &step.to_stride, &step.old_type.index, &step.new_type.index};
  uint32_t& field = *kFields[random() % std::size(kFields)];
  switch (random() % 5) {
    case 0:
      field += static_cast<uint32_t>(random() % 9) - 4;
      break;
    case 1:
      field = static_cast<uint32_t>(random() % 400);
      break;
    case 2:
      field ^= 1u << (random() % 32);
      break;
    case 3:
      step.kind = static_cast<StepKind>(random() % 3);
      break;
    default:
      step.early = !step.early;
      if (!bytes.empty()) bytes[random() % bytes.size()] ^= 1;
  }
  auto read = from_stored(step, std::move(bytes));
  if (read) changed = std::move(*read);
  return read.has_value();
}

// Whatever passes the check keeps every instance slot right and stays inside memory (the latter is
// what the sanitizers watch here).
TEST(Package, V17_what_passes_is_harmless) {
  auto pair = make_pair();
  std::mt19937 random(1);
  uint32_t passed = 0;
  for (int round = 0; round < 3000; ++round) {
    Package package = pair->package;
    std::vector<UpdateStep>& steps = package.forward.steps;
    uint32_t changes = 1 + random() % 2;
    bool read = true;
    for (uint32_t i = 0; i < changes; ++i) read &= mutate(steps[random() % steps.size()], random);
    if (!read || !check_package(package, pair->a.image, pair->b.image).ok()) continue;
    ++passed;
    hand_made::Running running(pair->a);
    std::vector<uint8_t>& memory = running.memory();
    Transfer transfer(package.forward, pair->a.image, pair->b.image, Transfer::Steps::kAll);
    auto ignore = [](const Loss&) { return true; };
    ASSERT_TRUE(transfer.read(memory.data(), ignore, nullptr));
    ASSERT_TRUE(transfer.save(memory.data(), nullptr));
    ASSERT_TRUE(transfer.write(memory.data(), nullptr));
    const ir::Image& image = pair->b.image;
    for (uint32_t id = 1; id < image.instances.size(); ++id) {
      if (image.instances[id].parent == 0) continue;
      auto symbol = ir::find_symbol(image, image.instance_path(id));
      ASSERT_TRUE(symbol.ok());
      // The owner's slot names this instance.
      const ir::Instance& owner = image.instances[image.instances[id].parent];
      auto member = image.types.find_member(owner.type, image.instances[id].name);
      uint32_t slot = 0;
      std::memcpy(&slot,
                  &memory[owner.data +
                          image.layouts[owner.type].member_offsets[static_cast<size_t>(member)]],
                  4);
      EXPECT_EQ(slot, id) << round;
    }
  }
  EXPECT_GT(passed, 0u);
  EXPECT_LT(passed, 1500u);
}

// A conversion whose value no variable takes would read what nobody has looked at.
TEST(Package, V17_values_made_for_no_variable) {
  for (const StepKind kind : {StepKind::kConvert, StepKind::kEnter}) {
    auto pair = make_pair();
    const Areas areas(pair->b.image);
    const uint32_t main = pair->b.image.program_ids().front();
    ASSERT_LE(areas.used(main) + 16, areas.capacity(main));
    UpdateStep step = first_step(pair->package, StepKind::kConvert);
    const auto& like = *step.as<ConvertedValues>();
    if (kind == StepKind::kEnter) {
      step.how = EnteredStep{like.from, 0xfffffff0u};
    } else {
      step.how = ConvertedValues{like.from, 0xfffffff0u, like.old_type, like.new_type, {}};
    }
    step.count = 1;
    step.to = areas.begin(main) + areas.used(main) + 8;  // in the slack
    step.fate = kNoFate;
    pair->package.forward.steps.push_back(step);
    expect_refused(*pair, "is made, but no variable is there");
  }
}

TEST(Package, V17_absurd_counts) {
  auto pair = make_pair();
  UpdateStep& step = first_step(pair->package, StepKind::kCopy);
  step.count = 0xffffffffu;
  step.to_stride = 0xffffffffu;
  EXPECT_FALSE(check(*pair).ok());
  step.count = 0;
  expect_refused(*pair, "is written by an empty step");
  step.count = 2;
  step.to_stride = 1;
  expect_refused(*pair, "is written twice");
}

// Early bytes, or any, where a step has no place for them.
TEST(Package, V17_a_step_that_mixes_copying_and_initialising_is_damage) {
  auto pair = make_pair();
  for (const UpdateStep& step : pair->package.forward.steps) {
    StoredStep mixed = stored(step);
    EXPECT_TRUE(from_stored(mixed, {}));
    const bool initial = step.kind() == StepKind::kInitialise;
    EXPECT_EQ(from_stored(mixed, {1}).has_value(), initial || step.kind() == StepKind::kGather);
    mixed.early = true;
    EXPECT_EQ(from_stored(mixed, {}).has_value(), initial);
  }
  UpdateStep& convert = first_step(pair->package, StepKind::kConvert);
  convert.as<ConvertedValues>()->known.assign(convert.total(), 1);
  expect_refused(*pair, "is converted to what only a controller knows");
}

TEST(Package, V17_fate_without_row) {
  auto pair = make_pair();
  const auto rows = static_cast<uint32_t>(pair->package.forward.fates.size());
  for (const uint32_t fate : {rows, 12345u}) {
    pair->package.forward.steps[0].fate = fate;
    expect_refused(*pair, "has no row in the fate report");
  }
}

// Two instances have exchanged their IDs, and no step writes their slots.
TEST(Package, V17_a_slot_that_would_keep_the_ID_of_another_instance) {
  const auto make = [](Version& v) {
    const ir::TypeId inner = v.block("Inner", {{"n", v.elementary(Kind::kInt)}});
    v.program("Main", {{"x", inner}, {"y", inner}});
  };
  Pair pair;
  make(pair.a);
  pair.a.link();
  make(pair.b);
  pair.b.link(&pair.a);
  EXPECT_TRUE(check(pair).ok());
  ir::Image& image = pair.b.image;
  const ir::Instance& main = image.instances[image.program_ids().front()];
  const std::vector<uint32_t>& offsets = image.layouts[main.type].member_offsets;
  const auto byte_at = [&](uint32_t at) -> uint8_t& {
    for (ir::DataRun& run : image.data) {
      if (at >= run.offset && at - run.offset < run.bytes.size()) return run.bytes[at - run.offset];
    }
    ADD_FAILURE() << "no initial value at " << at;
    return image.data[0].bytes[0];
  };
  std::swap(byte_at(main.data + offsets[0]), byte_at(main.data + offsets[1]));
  expect_refused(pair, "would keep the ID of another instance");
}

}  // namespace
}  // namespace online_change
