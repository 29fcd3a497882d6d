// A12, relocation, far operands, stack and call graph.
#include "base/limits.h"
#include "tests/unit/linker/linked.h"
#include "tests/unit/program/sample.h"

namespace linker {
namespace {

const ir::LinkedPou& pou_named(const ir::Image& image, std::string_view name) {
  for (const ir::LinkedPou& pou : image.pous) {
    if (ir::same_name(pou.name, name)) return pou;
  }
  ADD_FAILURE() << name;
  return image.pous[0];
}

std::vector<ir::Unit> code_of(const ir::Image& image, std::string_view name) {
  const ir::LinkedPou& pou = pou_named(image, name);
  const auto begin = image.code.begin() + pou.first_unit;
  return std::vector<ir::Unit>(begin, begin + pou.unit_count);
}

constexpr std::string_view kSome =
    "  member global some : LREAL\n  member global more : LREAL\n  member global yet : INT\n";

TEST(Linking, SampleWithEverythingPassesTheVerifier) {
  const ir::Image image = linked(ir::kSample);
  EXPECT_EQ(image.tasks[0].watchdog_ns, 5'000'000);
  EXPECT_EQ(image.tasks[1].watchdog_ns, 30'000'000);
  EXPECT_EQ(image.program_ids(), std::vector<uint32_t>{1});
}

std::string user_of_struct(std::string_view first) {
  return simple("", "  member local s : S\n  member local x : UINT\n",
                "type %25 = array UINT [0..9]\ntype S = struct\n  member local first : " +
                    std::string(first) + "\n  member local used : UINT\n",
                "", R"(  b0:
    v0 = load u16 self.s.used
    store u16 self.x, v0
    return
)");
}

// The POU was not edited: its object stays, its linked code follows the offset.
TEST(Linking, A12UneditedPouKeepsItsObjectAndFollowsMovedOffsets) {
  const ir::Program before = parsed(user_of_struct("UINT"));
  const ir::Program after = parsed(user_of_struct("%25"));
  const std::vector<ir::Object> old_objects = objects_of(before);
  const std::vector<ir::Object> new_objects = objects_of(after);
  EXPECT_EQ(ir::canonical_bytes(old_objects[0], before),
            ir::canonical_bytes(new_objects[0], after));
  const ir::Image old_image = *link(before, old_objects, {});
  const ir::Image new_image = *link(after, new_objects, {});
  EXPECT_EQ(old_image.pous[0].identity, new_image.pous[0].identity);
  ASSERT_EQ(code_of(old_image, "Main").size(), 2u);
  EXPECT_EQ(code_of(old_image, "Main")[0].b, 2u);
  EXPECT_EQ(code_of(new_image, "Main")[0].b, 20u);
}

TEST(Linking, A12OtherUsesMakeAnotherObject) {
  const ir::Program before = parsed(user_of_struct("UINT"));
  std::string text = user_of_struct("UINT");
  text.replace(text.find("self.s.used"), 11, "self.s.first");
  const ir::Program after = parsed(text);
  EXPECT_NE(ir::canonical_bytes(objects_of(before)[0], before),
            ir::canonical_bytes(objects_of(after)[0], after));
}

// E1: where the POU stands in its file is not its content.
TEST(Linking, E1LinesAreNoPartOfAPousIdentity) {
  const auto text = [](std::string_view line) {
    return simple("  member global g : INT\n", "", "", "",
                  "  b0:\n    v0 = const i16 1\n    store i16 global.g, v0 @" + std::string(line) +
                      "\n    return\n");
  };
  const ir::Image one = linked(text("5"));
  const ir::Image other = linked(text("9"));
  EXPECT_EQ(one.pous[0].identity, other.pous[0].identity);
  EXPECT_EQ(one.pous[0].lines[0].line, 5u);
  EXPECT_EQ(other.pous[0].lines[0].line, 9u);
}

constexpr std::string_view kFarBody = R"(  b0:
    v0 = load i64 global.far
    v1 = load i64 self.far
    v2 = add i64 v0, v1
    store i64 self.far, v2
    v3 = load bool global.flag
    branch v3, b1, b2
  b1:
    store i64 global.near, v2
    jump b2
  b2:
    v4 = load i64 global.near
    store i64 self.near, v4
    return
)";

// Arrays that count as small push `far` behind 64 KiB; no hole takes it.
std::string far_program() {
  std::string members;
  for (int i = 0; i < 400; ++i) {
    members += "  member local b" + std::to_string(i) + " : %25\n";
  }
  std::string globals = members;
  for (size_t at = 0; (at = globals.find("local", at)) != std::string::npos;) {
    globals.replace(at, 5, "global");
  }
  return simple("  member global near : LINT\n" + globals +
                    "  member global far : LINT\n  member global flag : BOOL\n",
                "  member local near : LINT\n" + members + "  member local far : LINT\n",
                "type %25 = array LREAL [0..31]\n", "", kFarBody);
}

TEST(Linking, ReachesFarOperandsThroughScratchSlots) {
  const ir::Image image = linked(far_program());
  std::string text;
  for (const ir::Unit& unit : code_of(image, "Main")) {
    text += std::string(ir::opcode_row(unit.opcode()).name) + " ";
  }
  EXPECT_EQ(text, "LDFAR_64 LDFAR_64 ADD_64 MOV_64 STFAR_64 LDFAR_B JF MOV_64 MOV_64 RET ");
}

TEST(Linking, ReachesFarMembersBehindAnAddress) {
  std::string members = "  member local near : LINT\n";
  for (int i = 0; i < 300; ++i) members += "  member local b" + std::to_string(i) + " : %25\n";
  members += "  member local far : LINT\n";
  const ir::Image image =
      linked(simple("", "  member local f : F\n  member local x : LINT\n",
                    "type %25 = array LREAL [0..31]\ntype F = function_block\n" + members,
                    empty_pou("function_block", "F"), R"(  b0:
    v0 = load i64 self.f!.far
    store i64 self.f!.near, v0
    store i64 self.f!.far, v0
    return
)"));
  std::string text;
  const std::vector<ir::Unit> code = code_of(image, "Main");
  for (size_t i = 0; i < code.size(); ++i) {
    const ir::OpcodeRow& row = ir::opcode_row(code[i].opcode());
    text += std::string(row.name) + " ";
    i += row.extended ? 1 : 0;
  }
  EXPECT_EQ(text, "INST LEA_AT LD_64 ST_64 LEA_AT ST_64 RET ");
}

// The last offset that 16 bits hold, and the next one that a LINT can have.
std::string code_with_far_at(bool own, int filling) {
  std::string members = "  member local near : LINT\n";
  for (int i = 0; i < 255; ++i) members += "  member local b" + std::to_string(i) + " : %25\n";
  members += "  member local filling : %26\n  member local far : LINT\n";
  const std::string types = "type %25 = array LREAL [0..31]\ntype %26 = array LREAL [1.." +
                            std::to_string(filling) + "]\n";
  const std::string place = own ? "self." : "self.f!.";
  const std::string body = "  b0:\n    v0 = load i64 " + place + "far\n    store i64 " + place +
                           "near, v0\n    return\n";
  const ir::Image image =
      own ? linked(simple("", members, types, "", body))
          : linked(simple("", "  member local f : F\n",
                          types + "type F = function_block\n" + members,
                          empty_pou("function_block", "F"), body));
  EXPECT_EQ(offset_of(image, own ? "Main" : "F", "far"), 8u + 255 * 256 + 8 * filling);
  std::string text;
  const std::vector<ir::Unit> code = code_of(image, "Main");
  for (size_t i = 0; i < code.size(); ++i) {
    const ir::OpcodeRow& row = ir::opcode_row(code[i].opcode());
    text += std::string(row.name) + " ";
    i += row.extended ? 1 : 0;
  }
  return text;
}

TEST(Linking, ReachesFarWhereSixteenBitsEnd) {
  EXPECT_EQ(code_with_far_at(true, 30).find("LDFAR"), std::string::npos);
  EXPECT_NE(code_with_far_at(true, 31).find("LDFAR"), std::string::npos);
  EXPECT_EQ(code_with_far_at(false, 30).find("LEA_AT"), std::string::npos);
  EXPECT_NE(code_with_far_at(false, 31).find("LEA_AT"), std::string::npos);
}

std::string caller_with_local(uint32_t bytes, std::string_view arguments) {
  return simple("  member global g : DINT\n  member global h : LREAL\n", "",
                "type %25 = array BYTE [1.." + std::to_string(bytes) + "]\n",
                "pou function Callee\n  local input low : INT\n  local in_out target : DINT\n"
                "  b0:\n    return\n"
                "pou function Plain\n  local input low : INT\n  local return Plain : INT\n"
                "  b0:\n    v0 = load i16 local.low\n    store i16 local.Plain, v0\n    return\n"
                "pou function Caller\n  local temp big : %25\n  local temp k : INT\n  b0:\n"
                "    init local.big\n    init local.k\n    v0 = load i16 local.k\n" +
                    std::string(arguments) + "    return\n",
                "  b0:\n    call Caller\n    return\n");
}

TEST(Linking, PassesScalarsBehindALargeFrame) {
  const ir::Image image =
      linked(caller_with_local(100'000,
                               "    store i16 arg(Plain).low, v0\n    call Plain\n"
                               "    v1 = load i16 arg(Plain).Plain\n    store i16 local.k, v1\n"));
  EXPECT_GE(pou_named(image, "Caller").frame_size, 100'000u);
}

TEST(Linking, RefusesReferencesBehindALargeFrameAndFramesThatAreTooLarge) {
  const std::string references =
      "    v1 = address addr global.g\n    store i16 arg(Callee).low, v0\n"
      "    store addr arg(Callee).target, v1\n    call Callee\n";
  linked(caller_with_local(60'000, references));
  for (uint32_t bytes : {100'000u, 2'000'000u}) {
    const base::Result<ir::Image> image = try_link(caller_with_local(bytes, references));
    ASSERT_FALSE(image.ok()) << bytes;
    EXPECT_EQ(image.error().refusal, base::Refusal::kTooMany);
  }
}

TEST(Linking, NumbersOfPousAreKeptAndReused) {
  const auto text = [](std::string_view functions) { return simple(kSome, "", "", functions); };
  const std::string f = "pou function F\n  b0:\n    return\n";
  const std::string g = "pou function G2\n  b0:\n    return\n";
  const std::string h = "pou function H\n  b0:\n    return\n";
  const ir::Image first = linked(text(f + g));
  EXPECT_EQ(first.pous[0].name, "F");
  const ir::Image second = relinked(first, text(g));
  EXPECT_EQ(second.pous[0].name, "");
  EXPECT_EQ(second.pous[1].name, "G2");
  const ir::Image third = relinked(second, text(g + h));
  EXPECT_EQ(third.pous[0].name, "H");
  EXPECT_EQ(third.pous[1].name, "G2");
  EXPECT_EQ(third.pous[2].name, "Main");
}

TEST(Linking, RefusesRecursionAndNamesTheCircle) {
  const base::Result<ir::Image> image =
      try_link(simple("", "", "",
                      "pou function A\n  b0:\n    call B\n    return\n"
                      "pou function B\n  b0:\n    call C\n    return\n"
                      "pou function C\n  b0:\n    call B\n    return\n"));
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kRecursion);
  EXPECT_NE(image.error().text.find("B -> C -> B"), std::string::npos) << image.error().text;
}

TEST(Linking, RefusesAMissingFunction) {
  const ir::Program program = parsed(
      simple("", "", "", "pou function A\n  b0:\n    return\n", "  b0:\n    call A\n    return\n"));
  std::vector<ir::Object> objects = objects_of(program);
  objects.erase(objects.begin());
  const base::Result<ir::Image> image = link(program, objects, {});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kUndefinedSymbol);
}

std::string function(std::string_view name, std::string_view callee) {
  std::string text = "pou function " + std::string(name) + "\n  local temp x : LREAL\n  b0:\n" +
                     "    init local.x\n";
  if (!callee.empty()) text += "    call " + std::string(callee) + "\n";
  return text + "    return\n";
}

TEST(Linking, StackIsTheDeepestChainOfEveryPriority) {
  const std::string pous = function("A", "B") + function("B", "") + function("C", "") +
                           "pou program P1 self P1\n  b0:\n    call A\n    call C\n    return\n"
                           "pou program P2 self P2\n  b0:\n    call C\n    return\n"
                           "pou program P3 self P3\n  b0:\n    call B\n    return\n";
  const ir::Image image =
      linked("program P\ntype G = globals\n" + std::string(kSome) +
             "type P1 = program\ntype P2 = program\ntype P3 = program\n"
             "globals G\ntask Fast period 1000000 priority 0\ntask Slow period 1000000 priority 7\n"
             "task Slow2 period 1000000 priority 7\ninstance a : P1 task 0\ninstance b : P2 task 1\n"
             "instance c : P3 task 2\n" +
             pous);
  EXPECT_EQ(image.stack_bytes, 16u + 8u);
  EXPECT_EQ(image.call_depth, 3u);
}

TEST(Linking, EqualConstantsShareOnePlaceInThePool) {
  const ir::Image image =
      linked(simple("  member global g : INT\n  member global h : LREAL\n", "", "",
                    "pou function A\n  b0:\n    v0 = const i16 5\n    store i16 global.g, v0\n"
                    "    return\n",
                    "  b0:\n    v0 = const i16 5\n    store i16 global.g, v0\n"
                    "    v1 = const f64 2.5\n    store f64 global.h, v1\n    return\n"));
  EXPECT_EQ(image.pool.size(), 16u);
}

TEST(Linking, RefusesMorePousThanAnImageNumbers) {
  const ir::Program program = parsed(ir::kSample);
  std::vector<ir::Object> objects(base::kMaxPous + 1, objects_of(program)[0]);
  for (size_t i = 0; i < objects.size(); ++i) objects[i].name = "pou" + std::to_string(i);
  base::Result<ir::Image> image = link(program, objects, {});
  ASSERT_FALSE(image.ok());
  EXPECT_EQ(image.error().refusal, base::Refusal::kTooMany);
}

TEST(Linking, RefusesMoreCodeUnitsThanAnImageHas) {
  EXPECT_EQ(Options().max_code_units, base::kMaxCodeUnits);
  Options options;
  options.max_code_units = static_cast<uint32_t>(linked(ir::kSample).code.size());
  EXPECT_TRUE(try_link(ir::kSample, options).ok());
  --options.max_code_units;
  base::Result<ir::Image> refused = try_link(ir::kSample, options);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().refusal, base::Refusal::kTooMany);
}

}  // namespace
}  // namespace linker
