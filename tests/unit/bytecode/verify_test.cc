// Every rule of the verifier (V1 to V20) has images that only it rejects:
// each is the accepted sample with one thing changed. Here the tables of an image; its code is in
// verify_code_test.cc.
#include "base/limits.h"
#include "tests/unit/bytecode/verify_outcome.h"

namespace {

using namespace sample;
using namespace verify_outcome;
using base::Refusal;
using ir::Image;

TEST(Verify, TheSampleIsAccepted) { EXPECT_EQ(outcome(busy_image()), "accepted"); }

TEST(Verify, V1_FormOfTables) {
  expect_refused(Refusal::kBadFormat, "a layout is missing",
                 [](Image& i) { i.layouts.own().of.pop_back(); });
  expect_refused(Refusal::kBadFormat, "a type contains itself", [](Image& i) {
    i.types.own().edit(types_of(i).pair).members[0].type = types_of(i).pair;
  });
  expect_refused(Refusal::kBadFormat, "members overlap", [](Image& i) {
    i.layouts.own().of[types_of(i).pair.index].member_offsets[1] = 1;
  });
  expect_refused(Refusal::kBadFormat, "a member behind the end", [](Image& i) {
    i.layouts.own().of[types_of(i).pair.index].member_offsets[1] = 4;
  });
  // Whoever follows a reference goes by what an area uses.
  expect_refused(Refusal::kBadFormat, "an area that uses more than it has", [](Image& i) {
    i.layouts.own().of[types_of(i).counter.index].used = 0xfffffff0;
  });
  expect_refused(Refusal::kBadFormat, "a member behind what its area uses", [](Image& i) {
    i.layouts.own().of[types_of(i).counter.index].used = kIo;
  });
  expect_refused(Refusal::kBadFormat, "a structure that uses more than it has",
                 [](Image& i) { i.layouts.own().of[types_of(i).pair.index].used = 9; });
  for (const uint32_t packing : {3u, 16u}) {
    expect_refused(Refusal::kBadFormat, "a structure that is packed by no power of two up to 8",
                   [&](Image& i) { i.types.own().edit(types_of(i).pair).capacity = packing; });
  }
  // Process images go by the address, memory by the layout.
  expect_refused(Refusal::kBadFormat, "a member of a union with two places", [](Image& i) {
    i.types.own().edit(types_of(i).pair).kind = ir::Kind::kUnion;
  });
  expect_refused(Refusal::kBadFormat, "a size that the type does not have",
                 [](Image& i) { i.layouts.own().of[types_of(i).numbers.index].size = 10; });
  expect_refused(Refusal::kBadFormat, "array bounds the wrong way round", [](Image& i) {
    i.types.own().edit(types_of(i).numbers).dims = {{4, 1}};
  });
  expect_refused(Refusal::kBadFormat, "a subrange of a structure",
                 [](Image& i) { i.types.own().edit(types_of(i).level).base = types_of(i).pair; });
  // Whoever describes a type follows its base.
  expect_refused(Refusal::kBadFormat, "a structure with a base",
                 [](Image& i) { i.types.own().edit(types_of(i).pair).base = types_of(i).pair; });
  expect_refused(Refusal::kBadFormat, "a program with a base that does not exist",
                 [](Image& i) { i.types.own().edit(types_of(i).main).base = ir::TypeId(1u << 30); });
  expect_refused(Refusal::kBadFormat, "a member type that does not exist", [](Image& i) {
    i.types.own().edit(types_of(i).main).members[0].type = ir::TypeId(999);
  });
  expect_refused(Refusal::kBadFormat, "the globals are something else",
                 [](Image& i) { i.globals = types_of(i).pair; });
  expect_refused(Refusal::kBadFormat, "initial data out of order",
                 [](Image& i) { std::swap(i.data[0], i.data[2]); });
  expect_refused(Refusal::kBadFormat, "initial data behind the end", [](Image& i) {
    i.data.push_back({1020, base::Bytes(8)});
  });
  expect_refused(Refusal::kBadFormat, "a string that is too large", [](Image& i) {
    i.types.own().edit(types_of(i).text).capacity = base::kMaxStringCapacity + 1;
  });
}

TEST(Verify, V2_HashBeforeAnythingElse) {
  base::Bytes bytes = ir::encode(busy_image());
  bytes[bytes.size() / 2] ^= 4;
  EXPECT_EQ(ir::verify(bytes).error().refusal, Refusal::kBadHash);
}

TEST(Verify, V8_Frames) {
  expect_refused(Refusal::kBadFrame, "no multiple of 8",
                 [](Image& i) { i.pous[kAddPou].frame_size = 9; });
  expect_refused(Refusal::kBadFrame, "a slot behind the end",
                 [](Image& i) { i.pous[kAddPou].slots[2].offset = 7; });
  expect_refused(Refusal::kBadFrame, "slots overlap",
                 [](Image& i) { i.pous[kAddPou].slots[1].offset = 1; });
  expect_refused(Refusal::kBadFrame, "the callee's frame begins elsewhere", [](Image& i) {
    for (Unit& unit : i.code) {
      if (unit.opcode() == Opcode::CALL) unit.a += 1;
    }
  });
  expect_refused(Refusal::kBadFrame, "a frame above the limit",
                 [](Image& i) { i.pous[kCounterPou].frame_size = base::kMaxFrameBytes + 8; });
  expect_refused(Refusal::kBadFrame, "an instance in a frame", [](Image& i) {
    i.pous[kMainPou].slots[12].region = {types_of(i).counters, 0};
  });
  // Whoever compares what callers see looks at the types of parameters.
  for (const ir::Region region : {ir::Region{}, ir::Region{ir::TypeId(999), 0},
                                  ir::Region{ir::TypeId(1u << 30), 0}, ir::Region{kDint, 0},
                                  ir::Region{kIntType, 1}}) {
    expect_refused(Refusal::kBadFrame, "a parameter of a type that is not of its class",
                   [&](Image& i) { i.pous[kAddPou].slots[0].region = region; });
  }
  expect_refused(Refusal::kBadFrame, "a scalar that is a structure", [](Image& i) {
    i.pous[kMainPou].slots[1].region = {types_of(i).pair, 0};
  });
  expect_refused(Refusal::kBadFrame, "a string's place of a type that is nowhere", [](Image& i) {
    i.pous[kMainPou].slots[10].region = {ir::TypeId(999), 0};
  });
}

TEST(Verify, V11_CallGraphAndStack) {
  expect_refused(Refusal::kStackUnbounded, "a function that calls itself", [](Image& i) {
    i.pous[kAddPou].slots.resize(3);
    set_code(i, kAddPou,
             op(Opcode::MOV_16, F(8), F(0)) + op(Opcode::MOV_16, F(10), F(2)) +
                 op(Opcode::CALL, F(1), {}, F(kAddPou)) + op(Opcode::MOV_16, F(4), F(12)) + kRet);
  });
  expect_refused(Refusal::kStackUnbounded, "stack too small",
                 [](Image& i) { i.stack_bytes = kNext + 7; });
  expect_refused(Refusal::kStackUnbounded, "depth too small", [](Image& i) { i.call_depth = 0; });
  Image exact = busy_image();
  exact.stack_bytes = kNext + 8;
  exact.call_depth = 1;
  EXPECT_EQ(outcome(exact), "accepted");
  // A task of another priority may lie on top.
  expect_refused(Refusal::kStackUnbounded, "two priorities need both", [](Image& i) {
    i.stack_bytes = kNext + 8 + 8;
    i.instances[6] = i.instances[1];
    i.instances[6].name = "Main2";
    i.instances[6].data = 640;
    i.free = {{768, 256}};
    i.instances.push_back(i.instances[2]);
    i.instances.push_back(i.instances[2]);
    i.instances.push_back(i.instances[2]);
    for (uint32_t n = 0; n < 3; ++n) {
      i.instances[7 + n].parent = 6;
      i.instances[7 + n].data = 448 + 16 * n;
    }
    i.data.push_back({640 + kFb, {7, 0, 0, 0, 8, 0, 0, 0, 9, 0, 0, 0}});
    i.tasks.push_back({"Slow", 20'000'000, 100'000'000, 2, 0, {6}});
    set_code(i, kMainPou, kRet);
  });
}

TEST(Verify, V13_Instances) {
  expect_refused(Refusal::kBadInstance, "outside data memory",
                 [](Image& i) { i.instances[2].data = 1016; });
  expect_refused(Refusal::kBadInstance, "in the first bytes",
                 [](Image& i) { i.instances[2].data = 0; });
  expect_refused(Refusal::kBadInstance, "misaligned", [](Image& i) { i.instances[5].data = 436; });
  expect_refused(Refusal::kBadInstance, "overlapping", [](Image& i) { i.instances[3].data = 392; });
  expect_refused(Refusal::kBadInstance, "in free space",
                 [](Image& i) { i.instances[5].data = 512; });
  expect_refused(Refusal::kBadInstance, "free space outside",
                 [](Image& i) { i.free[0].size = 513; });
  expect_refused(Refusal::kBadInstance, "a slot that names no instance",
                 [](Image& i) { i.data[1].bytes[0] = 0; });
  expect_refused(Refusal::kBadInstance, "a slot that names a free ID",
                 [](Image& i) { i.data[1].bytes[0] = 6; });
  expect_refused(Refusal::kBadInstance, "a slot that names one of another type",
                 [](Image& i) { i.data[1].bytes[0] = 1; });
  expect_refused(Refusal::kBadInstance, "an instance named twice",
                 [](Image& i) { i.data[3].bytes[4] = 2; });
  expect_refused(Refusal::kBadInstance, "another parent",
                 [](Image& i) { i.instances[2].parent = 0; });
  // Whoever looks for the root of an instance goes up until there is no parent.
  expect_refused(Refusal::kBadInstance, "globals below an instance",
                 [](Image& i) { i.instances[0].parent = 4; });
  expect_refused(Refusal::kBadInstance, "globals below what is not there",
                 [](Image& i) { i.instances[0].parent = 1u << 30; });
  expect_refused(Refusal::kBadInstance, "globals that are free",
                 [](Image& i) { i.instances[0].live = false; });
  expect_refused(Refusal::kBadInstance, "globals with code",
                 [](Image& i) { i.instances[0].pou = kMainPou; });
  // What was prepared for a change looks at rows before it asks whether they are live.
  expect_refused(Refusal::kBadInstance, "a free ID without a type",
                 [](Image& i) { i.instances[6].type = {}; });
  expect_refused(Refusal::kBadInstance, "a free ID with an area",
                 [](Image& i) { i.instances[6].data = 448; });
  expect_refused(Refusal::kBadInstance, "a free ID with code",
                 [](Image& i) { i.instances[6].pou = 1u << 30; });
  expect_refused(Refusal::kBadInstance, "a free ID with a parent",
                 [](Image& i) { i.instances[6].parent = 1u << 30; });
  expect_refused(Refusal::kBadInstance, "a program below an instance",
                 [](Image& i) { i.instances[kMainInstance].parent = 5; });
  expect_refused(Refusal::kBadInstance, "an instance that no slot names", [](Image& i) {
    i.instances[6] = i.instances[2];
    i.instances[6].data = 448;
  });
  expect_refused(Refusal::kBadInstance, "the code of another type",
                 [](Image& i) { i.instances[2].pou = kMainPou; });
  expect_refused(Refusal::kBadInstance, "an in-out that starts bound", [](Image& i) {
    i.data.push_back({384 + kIo, {0, 1, 0, 0}});
  });
  expect_refused(Refusal::kBadInstance, "no globals", [](Image& i) { i.instances.clear(); });
}

TEST(Verify, V15_Tasks) {
  expect_refused(Refusal::kBadTask, "none", [](Image& i) { i.tasks.clear(); });
  expect_refused(Refusal::kBadTask, "no period", [](Image& i) { i.tasks[0].period_ns = 0; });
  expect_refused(Refusal::kBadTask, "no watchdog", [](Image& i) { i.tasks[0].watchdog_ns = 0; });
  expect_refused(Refusal::kBadTask, "no program", [](Image& i) { i.tasks[0].programs = {999}; });
  expect_refused(Refusal::kBadTask, "the globals", [](Image& i) { i.tasks[0].programs = {0}; });
  expect_refused(Refusal::kBadTask, "a program in two tasks",
                 [](Image& i) { i.tasks.push_back(i.tasks[0]); });
  expect_refused(Refusal::kBadTask, "a cycle of 1 us", [](Image& i) {
    i.tasks.push_back({"Slow", 10'001'000, 100'000'000, 1, 0, {}});
  });
  expect_refused(Refusal::kBadTask, "a cycle that is shorter than the least",
                 [](Image& i) { i.tasks[0].period_ns = base::kMinBaseCycleNs - 1; });
  Image least = sample::busy_image();
  least.tasks[0].period_ns = base::kMinBaseCycleNs;
  EXPECT_TRUE(ir::verify(ir::encode(least)).ok());
  expect_refused(Refusal::kBadTask, "a freewheeling task with a period",
                 [](Image& i) { i.tasks[0].policy.freewheeling = true; });
  expect_refused(Refusal::kBadTask, "synchronous without a period", [](Image& i) {
    i.tasks[0].period_ns = 0;
    i.tasks[0].policy.freewheeling = true;
    i.tasks[0].policy.io = ir::TaskIo::kSynchronous;
  });
  expect_refused(Refusal::kBadTask, "a freewheeling task that is late", [](Image& i) {
    i.tasks[0].period_ns = 0;
    i.tasks[0].policy.freewheeling = true;
    i.tasks[0].policy.overrun = ir::Overrun::kAtOnce;
  });
  expect_refused(Refusal::kBadTask, "a freewheeling task that lengthens cycles", [](Image& i) {
    i.tasks[0].period_ns = 0;
    i.tasks[0].policy.freewheeling = true;
    i.tasks[0].policy.overrun = ir::Overrun::kLengthen;
  });
  expect_refused(Refusal::kBadTask, "at once with inputs of its period", [](Image& i) {
    i.tasks[0].policy.io = ir::TaskIo::kSynchronous;
    i.tasks[0].policy.overrun = ir::Overrun::kAtOnce;
  });
  expect_refused(Refusal::kBadTask, "an exchange of its own with inputs of its period",
                 [](Image& i) {
                   i.tasks[0].policy.io = ir::TaskIo::kSynchronous;
                   i.tasks[0].policy.exchange = ir::TaskExchange::kOwn;
                 });
  expect_refused(Refusal::kBadTask, "first inputs of its own exchange", [](Image& i) {
    i.tasks[0].policy.input_buffer = ir::IoBuffer::kFirstUnseen;
    i.tasks[0].policy.exchange = ir::TaskExchange::kOwn;
  });
  expect_refused(Refusal::kBadTask, "first outputs of its own exchange", [](Image& i) {
    i.tasks[0].policy.output_buffer = ir::IoBuffer::kFirstUnseen;
    i.tasks[0].policy.exchange = ir::TaskExchange::kOwn;
  });
  Image fine = sample::busy_image();
  fine.tasks[0].policy = {.exchange = ir::TaskExchange::kOwn,
                          .input_buffer = ir::IoBuffer::kThree,
                          .output_buffer = ir::IoBuffer::kLocked};
  EXPECT_TRUE(ir::verify(ir::encode(fine)).ok());
  fine.tasks[0].policy = {};
  fine.tasks[0].policy.overrun = ir::Overrun::kAtOnce;
  EXPECT_TRUE(ir::verify(ir::encode(fine)).ok());
  fine.tasks[0].policy = {.io = ir::TaskIo::kSynchronous, .overrun = ir::Overrun::kLengthen};
  EXPECT_TRUE(ir::verify(ir::encode(fine)).ok());
}

TEST(Verify, V14_SafeOutputs) {
  const auto refuse = [](const char* what, std::vector<ir::SafeOutput> rows) {
    expect_refused(Refusal::kBadIoAccess, what, [&](Image& i) { i.safe = std::move(rows); });
  };
  constexpr auto kValue = ir::SafeKind::kValue;
  refuse("behind the outputs", {{8, 1, kValue, 1, 0}});
  refuse("no bits", {{0, 0, kValue, 0, 0}});
  refuse("two bits", {{0, 2, kValue, 0, 0}});
  refuse("a byte across two", {{1, 8, kValue, 0, 0}});
  refuse("more bytes than there are", {{0, 64, kValue, 0, 0}});
  refuse("a value that is too large", {{0, 1, kValue, 2, 0}});
  refuse("a negative hold", {{0, 1, ir::SafeKind::kHoldThenValue, 1, -1}});
  refuse("twice the same", {{0, 1, kValue, 1, 0}, {0, 1, kValue, 1, 0}});
  refuse("not sorted", {{1, 1, kValue, 1, 0}, {0, 1, kValue, 1, 0}});
}

TEST(Verify, V16_Retain) {
  expect_refused(Refusal::kBadRetain, "outside", [](Image& i) { i.retain[0].data = 2000; });
  expect_refused(Refusal::kBadRetain, "in free space", [](Image& i) { i.retain[0].data = 600; });
  expect_refused(Refusal::kBadRetain, "beyond its area", [](Image& i) { i.retain[0].size = 65; });
}

TEST(Verify, ContentsAreOfAllPousOrOfNone) {
  const auto refuse = [](const char* what, int difference) {
    expect_refused(Refusal::kBadFormat, what, [&](Image& i) {
      i.contents.assign(i.pous.size() + static_cast<size_t>(difference), ir::PouContent{});
    });
  };
  refuse("one is missing", -1);
  refuse("one is too many", 1);
}

// What is exchanged with other resources is a plain variable, once.
TEST(Verify, SharedGlobals) {
  const auto refuse = [](const char* what, std::vector<ir::SharedGlobal> rows) {
    expect_refused(Refusal::kBadSharedGlobal, what, [&](Image& i) { i.shared = rows; });
  };
  refuse("there are five globals", {{5, false}});
  refuse("far outside", {{UINT32_MAX, false}});
  refuse("an input", {{1, false}});
  refuse("an output", {{2, true}});
  refuse("a constant", {{3, false}});
  refuse("a function block", {{4, true}});
  refuse("twice the same", {{0, true}, {0, true}});
}

TEST(Verify, V18_Memory) {
  expect_refused(Refusal::kTooLarge, "data memory",
                 [](Image& i) { i.data_capacity = base::kMaxDataBytes + 1; });
  expect_refused(Refusal::kTooLarge, "stack",
                 [](Image& i) { i.stack_bytes = ir::kStackLimit + 1; });
  expect_refused(Refusal::kTooLarge, "depth",
                 [](Image& i) { i.call_depth = base::kMaxCallDepth + 1; });
  expect_refused(Refusal::kTooLarge, "constants",
                 [](Image& i) { i.pool.resize(ir::kConstPoolLimit + 1); });
  expect_refused(Refusal::kTooLarge, "tasks",
                 [](Image& i) { i.tasks.resize(base::kMaxTasks + 1, i.tasks[0]); });
  // Each task has copies of the process image.
  expect_refused(Refusal::kTooLarge, "inputs",
                 [](Image& i) { i.input_bytes = base::kMaxDeviceBytes + 1; });
  expect_refused(Refusal::kTooLarge, "outputs",
                 [](Image& i) { i.output_bytes = base::kMaxDeviceBytes + 1; });
}

}  // namespace
