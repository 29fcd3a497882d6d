#include "tests/unit/bytecode/sample_image.h"

#include <bit>
#include <cstring>

#include "stdlib/native/natives.h"

namespace sample {
namespace {

using ir::FrameSlot;
using ir::Image;
using ir::Kind;
using ir::LocalKind;
using ir::Member;
using ir::SlotKind;
using ir::TypeId;

ir::Unit unit_of(Opcode opcode, Operand a, Operand b, Operand c) {
  Unit unit = Unit::make(opcode, a.base, b.base, c.base);
  unit.a = static_cast<uint16_t>(a.offset);
  unit.b = static_cast<uint16_t>(b.offset);
  unit.c = static_cast<uint16_t>(c.offset);
  return unit;
}

struct Placed {
  Member member;
  uint32_t offset;
};

Placed var(const char* name, TypeId type, uint32_t offset) {
  Member member;
  member.name = name;
  member.type = type;
  return {member, offset};
}

uint32_t size_of(const Image& image, const Member& member) {
  const bool slot = member.section == ir::Section::kInOut || image.types.is_instance(member.type);
  return slot ? 4 : image.layouts[member.type].size;
}

TypeId declare(Image& image, Kind kind, const char* name, const std::vector<Placed>& members,
               uint32_t size, uint32_t capacity) {
  ir::Type type;
  type.kind = kind;
  type.name = name;
  ir::TypeLayout layout;
  layout.size = size;
  layout.align = kind == Kind::kStruct ? 2 : 4;
  layout.used = size;
  layout.area_capacity = capacity;
  for (const Placed& placed : members) {
    type.members.push_back(placed.member);
    layout.member_offsets.push_back(placed.offset);
    layout.used = std::max(layout.used, placed.offset + size_of(image, placed.member));
  }
  const TypeId id = image.types.own().declare(std::move(type));
  image.layouts.own().of.resize(image.types.size());
  image.layouts.own().of[id.index] = layout;
  return id;
}

void lay_out_scalars(Image& image) {
  image.layouts.own().of.resize(image.types.size());
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    ir::TypeLayout& layout = image.layouts.own().of[i];
    const TypeId id(i);
    if (layout.size != 0) continue;
    const ir::Type& type = image.types[id];
    if (type.kind == Kind::kString) layout.size = type.capacity + 1;
    if (type.kind == Kind::kWstring) layout.size = 2 * (type.capacity + 1);
    if (image.types.is_scalar(id)) layout.size = ir::scalar_size(image.types.scalar(id));
    if (type.kind == Kind::kArray) {
      layout.size = image.layouts[type.base].size;
      for (const ir::Dimension& dim : type.dims) layout.size *= static_cast<uint32_t>(dim.count());
    }
  }
}

void add_types(Image& image) {
  ir::TypeTable& types = image.types.own();
  const TypeId bit = types.elementary(Kind::kBool);
  const TypeId integer = types.elementary(Kind::kInt);
  const TypeId text = types.string(10);
  const TypeId text5 = types.string(5);
  const TypeId wtext = types.wstring(3);
  const TypeId numbers = types.array(integer, {{1, 4}});
  const TypeId level = types.subrange(integer, 0, 100);
  lay_out_scalars(image);
  const TypeId pair =
      declare(image, Kind::kStruct, "Pair", {var("a", integer, 0), var("t", text5, 2)}, 8, 0);
  std::vector<Placed> counter = {var("run", bit, kRun), var("n", integer, kN),
                                 var("io", integer, kIo)};
  counter[0].member.section = ir::Section::kInput;
  counter[2].member.section = ir::Section::kInOut;
  const TypeId counter_id = declare(image, Kind::kFunctionBlock, "Counter", counter, 4, 16);
  const TypeId counters = types.array(counter_id, {{0, 1}});
  lay_out_scalars(image);
  declare(image, Kind::kProgram, "MainType",
          {var("x", integer, kX), var("y", integer, kY), var("flag", bit, kFlag),
           var("real", types.elementary(Kind::kReal), kReal), var("text", text, kText),
           var("numbers", numbers, kNumbers), var("pair", pair, kPair), var("fb", counter_id, kFb),
           var("fbs", counters, kFbs), var("long", types.elementary(Kind::kLint), kLong),
           var("lreal", types.elementary(Kind::kLreal), kLreal), var("wtext", wtext, kWtext),
           var("level", level, kLevel), var("word", types.elementary(Kind::kUdint), kWord)},
          4, 128);
  std::vector<Placed> globals = {var("count", types.elementary(Kind::kDint), 0), var("in", bit, 4),
                                 var("out", bit, 5), var("limit", integer, 6),
                                 var("shared", counter_id, 8)};
  globals[1].member.address = {ir::DirectArea::kInput, 0, 1};
  globals[2].member.address = {ir::DirectArea::kOutput, 0, 1};
  globals[3].member.constant = true;
  globals[0].member.retain = true;
  image.globals = declare(image, Kind::kGlobals, "", globals, 16, 64);
}

FrameSlot slot(uint32_t offset, Class cls, TypeId type = {}, uint8_t dim = 0) {
  FrameSlot s;
  s.offset = offset;
  s.cls = cls;
  s.region = {type, dim};
  return s;
}

FrameSlot param(const char* name, uint32_t offset, LocalKind kind, TypeId type) {
  FrameSlot s = slot(offset, Class::k16, type);
  s.kind = SlotKind::kParam;
  s.local = kind;
  s.name = name;
  return s;
}

ir::LinkedPou add_pou(const Image& image) {
  const TypeId integer = image.types.elementary(Kind::kInt);
  ir::LinkedPou pou;
  pou.name = "Add";
  pou.frame_size = 8;
  pou.slots = {param("a", 0, LocalKind::kInput, integer), param("b", 2, LocalKind::kInput, integer),
               param("Add", 4, LocalKind::kReturn, integer)};
  return pou;
}

ir::LinkedPou counter_pou(const Image& image, TypeId counter) {
  ir::LinkedPou pou;
  pou.name = "Counter";
  pou.kind = ir::PouKind::kFunctionBlock;
  pou.self = counter;
  pou.frame_size = 8;
  pou.slots = {slot(0, Class::kA, image.types.elementary(Kind::kInt)), slot(4, Class::k16)};
  return pou;
}

ir::LinkedPou main_pou(const Image& image, const Types& t) {
  const TypeId integer = image.types.elementary(Kind::kInt);
  ir::LinkedPou pou;
  pou.name = "Main";
  pou.kind = ir::PouKind::kProgram;
  pou.self = t.main;
  pou.file = "main.st";
  pou.frame_size = kNext;
  pou.slots = {slot(kB0, Class::kB),
               slot(kW0, Class::k16, integer),
               slot(kD0, Class::k32),
               slot(kQ0, Class::k64),
               slot(kF0, Class::kF32),
               slot(kLf0, Class::kF64),
               slot(kAddrInt, Class::kA, integer),
               slot(kAddrPair, Class::kA, t.pair),
               slot(kAddrNumbers, Class::kA, t.numbers),
               slot(kAddrCounter, Class::kA, t.counter),
               slot(kStr0, Class::kS),
               slot(kWstr0, Class::kW),
               slot(kPair0, Class::kB, t.pair),
               slot(kAddrInt2, Class::kA, integer),
               slot(kAddrSlot, Class::kA, t.counters, 1),
               slot(kStr1, Class::kS)};
  pou.slots[12].aggregate = true;
  pou.slots[12].kind = SlotKind::kLocal;
  return pou;
}

ir::Instance row(TypeId type, uint32_t data, uint32_t pou, uint32_t parent, const char* name) {
  ir::Instance instance;
  instance.type = type;
  instance.data = data;
  instance.pou = pou;
  instance.parent = parent;
  instance.live = true;
  instance.name = name;
  return instance;
}

base::Bytes id_bytes(std::initializer_list<uint32_t> ids) {
  base::ByteWriter out;
  for (uint32_t id : ids) out.u32(id);
  return out.take();
}

// Instances: 1 Main, 2 Main.fb, 3 and 4 Main.fbs, 5 the global `shared`; 6 is free.
void add_instances(Image& image, const Types& t) {
  image.instances = {row(image.globals, kGlobalsData, 0, 0, ""),
                     row(t.main, kMainData, kMainPou, 0, "Main"),
                     row(t.counter, 384, kCounterPou, kMainInstance, "fb"),
                     row(t.counter, 400, kCounterPou, kMainInstance, "fbs[0]"),
                     row(t.counter, 416, kCounterPou, kMainInstance, "fbs[1]"),
                     row(t.counter, 432, kCounterPou, 0, "shared"),
                     {}};
  image.instances[6].type = image.globals;
  image.data = {{kCount, {5, 0, 0, 0}},
                {kShared, id_bytes({5})},
                {kMainData + kX, {10, 0}},
                {kMainData + kFb, id_bytes({2, 3, 4})}};
  image.free = {{512, 512}};
  image.data_capacity = 1024;
}

void add_pool(Image& image) {
  image.pool.assign(72, 0);
  const auto put = [&](uint32_t at, const auto& value) {
    std::memcpy(&image.pool[at], &value, sizeof value);
  };
  put(kOne16, int16_t{1});
  put(kFour16, int16_t{4});
  put(kTrue, uint8_t{1});
  put(kNotBool, uint8_t{7});
  put(kOne32, int32_t{1});
  std::memcpy(&image.pool[kHello], "hello", 6);
  put(kPairValue, int16_t{7});
  std::memcpy(&image.pool[kPairValue + 2], "ab", 3);
  std::memset(&image.pool[kNoEnd], 'x', 8);
  put(kBig64, INT64_MIN);
  put(kMinusOne64, int64_t{-1});
  put(kHalf, 2.5);
  put(kHuge, 1.0e300);
}

Code counter_code() {
  return jump(Opcode::JF, 5, S(kRun)) +                 // 0
         op(Opcode::ADD_16, S(kN), S(kN), C(kOne16)) +  // 1
         wide(Opcode::LD_REF, F(0), S(kIo)) +           // 2
         op(Opcode::LD_16, F(4), F(0), F(0)) +          // 3
         op(Opcode::ADD_16, F(4), F(4), C(kOne16)) +    // 4
         op(Opcode::ST_16, F(0), F(4), F(0)) +          // 5
         op(Opcode::RET);                               // 6
}

}  // namespace

Code op(Opcode opcode, Operand a, Operand b, Operand c) { return {unit_of(opcode, a, b, c)}; }

Code wide(Opcode opcode, Operand a, Operand bc) {
  Unit unit = unit_of(opcode, a, {bc.base, 0}, {});
  unit.set_bc(bc.offset);
  return {unit};
}

Code jump(Opcode opcode, int32_t units, Operand a) {
  Unit unit = unit_of(opcode, a, {}, {});
  unit.set_bc(static_cast<uint32_t>(units));
  return {unit};
}

Code ext(Opcode opcode, Operand a, Operand b, Operand c, uint32_t x, uint32_t y) {
  return {unit_of(opcode, a, b, c), Unit::extension(x, y)};
}

Code operator+(Code left, const Code& right) {
  left.insert(left.end(), right.begin(), right.end());
  return left;
}

uint32_t native(const char* name) {
  for (uint32_t id = 0; id < stdlib::native_count(); ++id) {
    if (stdlib::native_row(id).name == name) return id;
  }
  return stdlib::native_count();
}

Types types_of(const Image& image) {
  Types t;
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const ir::Type& type = image.types[TypeId(i)];
    if (type.name == "Counter") t.counter = TypeId(i);
    if (type.name == "Pair") t.pair = TypeId(i);
    if (type.name == "MainType") t.main = TypeId(i);
    if (type.kind == Kind::kArray)
      (image.types.is_instance(type.base) ? t.counters : t.numbers) = TypeId(i);
    if (type.kind == Kind::kString) (type.capacity == 10 ? t.text : t.text5) = TypeId(i);
    if (type.kind == Kind::kWstring) t.wtext = TypeId(i);
    if (type.kind == Kind::kSubrange) t.level = TypeId(i);
  }
  return t;
}

void set_code(Image& image, uint32_t pou, const Code& code, std::vector<ir::Merge> merges) {
  Code all;
  for (uint32_t i = 0; i < image.pous.size(); ++i) {
    ir::LinkedPou& p = image.pous[i];
    const Code kept(image.code.begin() + p.first_unit,
                    image.code.begin() + p.first_unit + p.unit_count);
    const Code& now = i == pou ? code : kept;
    p.first_unit = static_cast<uint32_t>(all.size());
    p.unit_count = static_cast<uint32_t>(now.size());
    all = std::move(all) + now;
  }
  image.code = std::move(all);
  image.pous[pou].merges = std::move(merges);
}

Image image(Code code, std::vector<ir::Merge> merges) {
  Image image;
  image.name = "sample";
  add_types(image);
  const Types t = types_of(image);
  image.pous = {add_pou(image), counter_pou(image, t.counter), main_pou(image, t)};
  set_code(image, kAddPou, op(Opcode::ADD_16, F(4), F(0), F(2)) + op(Opcode::RET));
  set_code(image, kCounterPou, counter_code(), {{6, {}}});
  set_code(image, kMainPou, code, std::move(merges));
  image.pous[kMainPou].lines = {{0, 3}, {4, 7}};
  add_pool(image);
  image.bounds = {{1, 4, 2, {t.numbers, 0}, "numbers"}, {0, 2, 4, {t.counters, 0}, "fbs"}};
  image.ranges = {{0, 100, "level"}};
  add_instances(image, t);
  image.tasks = {{"Fast", 10'000'000, 100'000'000, 1, 0, {kMainInstance}}};
  image.io = {{{ir::DirectArea::kInput, 0, 1}, kIn, image.types.elementary(Kind::kBool)},
              {{ir::DirectArea::kOutput, 0, 1}, kOut, image.types.elementary(Kind::kBool)}};
  image.retain = {{kCount, 4}};
  image.shared = {{0, true}};
  image.stack_bytes = 4096;
  image.call_depth = 8;
  image.input_bytes = 1;
  image.output_bytes = 1;
  return image;
}

Code busy_code(std::vector<ir::Merge>& merges) {
  const Image shape = image(op(Opcode::RET));
  const Types t = types_of(shape);
  const uint32_t integer = static_cast<uint32_t>(Kind::kInt);
  Code code = op(Opcode::ADD_16, S(kX), S(kX), C(kOne16)) + op(Opcode::MOV_16, F(kArgA), S(kX)) +
              op(Opcode::MOV_16, F(kArgB), C(kFour16)) +
              op(Opcode::CALL, F(kNext / 8), {}, F(kAddPou)) +
              op(Opcode::MOV_16, S(kY), F(kResult)) +
              // fb(run := TRUE, io := x)
              wide(Opcode::INST, F(kAddrCounter), S(kFb)) +
              op(Opcode::ST_B, F(kAddrCounter), C(kTrue), F(kRun)) +
              ext(Opcode::LEA, F(kAddrInt), S(0), {}, kX, integer) +
              op(Opcode::ST_REF_AT, F(kAddrCounter), F(kAddrInt), F(kIo)) +
              wide(Opcode::CALL_INST, F(kNext / 8), S(kFb));
  // FOR w0 := 1 TO 4 DO numbers[w0] := w0 + x; fbs[..] run through the array of slots
  code = code + op(Opcode::MOV_16, F(kW0), C(kOne16));
  const auto head = static_cast<uint32_t>(code.size());
  code = code + ext(Opcode::INDEX_PLACE_I16, F(kAddrInt), F(kW0), S(0), 0, kNumbers) +
         op(Opcode::ADD_16, F(kW0), F(kW0), C(kZero16)) +
         op(Opcode::ST_16, F(kAddrInt), F(kW0), F(0)) +
         op(Opcode::ADD_16, F(kW0), F(kW0), C(kOne16)) +
         op(Opcode::GT_I16, F(kB0), F(kW0), C(kFour16)) + jump(Opcode::JT, 1, F(kB0));
  const auto back = static_cast<uint32_t>(code.size());
  code = code + jump(Opcode::LOOP, static_cast<int32_t>(head) - static_cast<int32_t>(back) - 1);
  const auto behind = static_cast<uint32_t>(code.size());
  code = code +
         // text := 'hello'; pair := constant; y := LEN(text)
         ext(Opcode::STR, F(kStr0), S(0), {}, kText, 10) +
         ext(Opcode::STR, F(kStr1), C(0), {}, kHello, 5) + op(Opcode::SCOPY, F(kStr0), F(kStr1)) +
         ext(Opcode::LEA, F(kAddrPair), S(0), {}, kPair, t.pair.index) +
         op(Opcode::LD_16, F(kW0), F(kAddrPair), F(0)) + op(Opcode::MOV_S, F(kNext), F(kStr0)) +
         op(Opcode::NATIVE, F(kNext / 8), {}, F(native("LEN"))) +
         op(Opcode::MOV_32, G(kCount), F(kNext)) + op(Opcode::MOV_B, G(kOut), G(kIn)) +
         op(Opcode::RET);
  merges = {{head, {kSlotW0}}, {behind, {}}};
  return code;
}

Image busy_image() {
  std::vector<ir::Merge> merges;
  Code code = busy_code(merges);
  return image(std::move(code), std::move(merges));
}

}  // namespace sample
