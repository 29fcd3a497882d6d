#include "tests/unit/bytecode/sample_objects.h"

namespace sample {
namespace {

using ir::FrameSlot;
using ir::Image;
using ir::Kind;
using ir::LocalKind;
using ir::PouKind;
using ir::SlotKind;
using ir::TypeId;

constexpr uint32_t kMainData2 = 128;

ir::Member member(const char* name, TypeId type) {
  ir::Member made;
  made.name = name;
  made.type = type;
  return made;
}

TypeId declare(Image& image, ir::Type type, std::vector<uint32_t> offsets, uint32_t capacity) {
  ir::TypeLayout layout;
  const bool interface = type.kind == Kind::kInterface;
  layout.size = interface || type.kind == Kind::kGlobals ? 0 : 4;
  layout.align = 4;
  layout.member_offsets = std::move(offsets);
  layout.used = layout.area_capacity = capacity;
  if (interface) layout = {};
  const TypeId id = image.types.own().declare(std::move(type));
  image.layouts.own().of.resize(image.types.size());
  image.layouts.own().of[id.index] = layout;
  return id;
}

ir::Type type_of(Kind kind, const char* name) {
  ir::Type type;
  type.kind = kind;
  type.name = name;
  return type;
}

void add_types(Image& image) {
  const TypeId integer = image.types.elementary(Kind::kInt);
  image.layouts.own().of.resize(image.types.size());
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    image.layouts.own().of[i].size = ir::scalar_size(image.types.scalar(TypeId(i)));
  }
  const TypeId adder = declare(image, type_of(Kind::kInterface, "Adder"), {}, 0);
  ir::Type base = type_of(Kind::kFunctionBlock, "Base");
  base.members = {member("n", integer)};
  const TypeId base_id = declare(image, base, {0}, 8);
  ir::Type derived = type_of(Kind::kFunctionBlock, "Derived");
  derived.base = base_id;
  derived.interfaces = {adder};
  derived.members = {member("n", integer), member("extra", integer)};
  const TypeId derived_id = declare(image, derived, {0, 8}, 16);
  ir::Type main = type_of(Kind::kProgram, "Main");
  main.members = {member("base", base_id),
                  member("derived", derived_id),
                  member("x", integer),
                  member("ref", image.types.elementary(Kind::kUlint)),
                  member("kind", image.types.elementary(Kind::kUdint)),
                  member("is", image.types.elementary(Kind::kBool))};
  declare(image, main, {kBaseSlot, kDerivedSlot, kObjectX, kObjectRef, kObjectKind, kObjectIs}, 64);
  ir::Type globals = type_of(Kind::kGlobals, "");
  image.globals = declare(image, globals, {}, 8);
}

FrameSlot slot(uint32_t offset, Class cls, TypeId type = {}) {
  FrameSlot made;
  made.offset = offset;
  made.cls = cls;
  made.region = {type, 0};
  return made;
}

ir::LinkedPou pou(const char* name, PouKind kind, TypeId self, uint32_t frame) {
  ir::LinkedPou made;
  made.name = name;
  made.kind = kind;
  made.self = self;
  made.frame_size = frame;
  return made;
}

ir::LinkedPou add_method(const Image& image, const char* name, TypeId self) {
  const TypeId integer = image.types.elementary(Kind::kInt);
  ir::LinkedPou made = pou(name, PouKind::kMethod, self, 8);
  made.slots = {slot(0, Class::k16, integer), slot(2, Class::k16, integer)};
  made.slots[0].kind = made.slots[1].kind = SlotKind::kParam;
  made.slots[0].local = LocalKind::kInput;
  made.slots[1].local = LocalKind::kReturn;
  return made;
}

void add_pous(Image& image, const ObjectTypes& t) {
  const TypeId integer = image.types.elementary(Kind::kInt);
  image.pous = {add_method(image, "Adder.add", t.adder),
                pou("Base", PouKind::kFunctionBlock, t.base, 0),
                add_method(image, "Base.add", t.base),
                pou("Derived", PouKind::kFunctionBlock, t.derived, 0),
                add_method(image, "Derived.add", t.derived),
                pou("Main", PouKind::kProgram, t.main, kObjectNext)};
  image.pous[kObjectMain].slots = {slot(kW, Class::k16),
                                   slot(kB, Class::kB),
                                   slot(kD, Class::k32),
                                   slot(kH, Class::k64),
                                   slot(kAddr, Class::kA, integer),
                                   slot(kAddrOther, Class::kA, integer)};
  set_code(image, kAdderAdd, op(Opcode::TRAP, F(8)));
  set_code(image, kBaseBody, op(Opcode::ADD_16, S(0), S(0), C(kOne16)) + op(Opcode::RET));
  set_code(image, kBaseAdd,
           op(Opcode::ADD_16, S(0), S(0), F(0)) + op(Opcode::MOV_16, F(2), S(0)) + op(Opcode::RET));
  set_code(image, kDerivedBody, op(Opcode::CALL_OWN, {}, {}, F(kBaseBody)) + op(Opcode::RET));
  set_code(image, kDerivedAdd,
           op(Opcode::MOV_16, F(8), F(0)) + op(Opcode::CALL_OWN, F(1), {}, F(kBaseAdd)) +
               op(Opcode::MOV_16, F(2), F(8 + 2)) + op(Opcode::ADD_16, S(8), S(8), C(kOne16)) +
               op(Opcode::RET));
}

ir::Instance row(TypeId type, uint32_t data, uint32_t pou, uint32_t parent, const char* name) {
  ir::Instance made;
  made.type = type;
  made.data = data;
  made.pou = pou;
  made.parent = parent;
  made.live = true;
  made.name = name;
  return made;
}

}  // namespace

Code argument() { return op(Opcode::MOV_16, F(kParamX), C(kFour16)); }

ObjectTypes object_types(const Image& image) {
  ObjectTypes t;
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    const std::string& name = image.types[TypeId(i)].name;
    if (name == "Adder") t.adder = TypeId(i);
    if (name == "Base") t.base = TypeId(i);
    if (name == "Derived") t.derived = TypeId(i);
    if (name == "Main") t.main = TypeId(i);
  }
  return t;
}

Image object_image(const Code& code, std::vector<ir::Merge> merges) {
  Image image;
  image.name = "objects";
  add_types(image);
  const ObjectTypes t = object_types(image);
  add_pous(image, t);
  set_code(image, kObjectMain, code, std::move(merges));
  image.pool.assign(8, 0);
  image.pool[kOne16] = 1;
  image.pool[kFour16] = 4;
  image.overrides = {{t.base, kBaseAdd, kBaseAdd},
                     {t.derived, kAdderAdd, kDerivedAdd},
                     {t.derived, kBaseAdd, kDerivedAdd}};
  image.instances = {
      row(image.globals, 64, 0, 0, ""), row(t.main, kMainData2, kObjectMain, 0, "Main"),
      row(t.base, 192, kBaseBody, 1, "base"), row(t.derived, 200, kDerivedBody, 1, "derived")};
  image.data = {{kMainData2, {2, 0, 0, 0, 3, 0, 0, 0}}};
  image.free = {{216, 40}};
  image.data_capacity = 256;
  image.tasks = {{"T", 1'000'000, 100'000'000, 0, 0, {1}}};
  image.stack_bytes = 1024;
  image.call_depth = 8;
  return image;
}

Code call_slot(Opcode opcode, Operand slot, uint32_t x) {
  Unit unit = wide(opcode, F(kObjectNext / 8), slot)[0];
  return {unit, Unit::extension(x, 0)};
}

Code call_handle(Opcode opcode, uint32_t x) {
  return ext(opcode, F(kObjectNext / 8), S(kObjectRef), {}, x, 0);
}

Image busy_object_image() {
  const ObjectTypes t = object_types(object_image(op(Opcode::RET)));
  Code code = wide(Opcode::CALL_INST, F(kObjectNext / 8), S(kDerivedSlot)) + argument() +
              call_slot(Opcode::CALL_METHOD, S(kDerivedSlot), kBaseAdd) +
              op(Opcode::MOV_16, S(kObjectX), F(kParamR)) + argument() +
              call_slot(Opcode::CALL_METHOD, S(kBaseSlot), kBaseAdd) +
              wide(Opcode::HANDLE_INST, F(kH), S(kDerivedSlot)) +
              op(Opcode::MOV_64, S(kObjectRef), F(kH)) + argument() +
              call_handle(Opcode::CALL_VIRTUAL, kAdderAdd) + argument() +
              call_handle(Opcode::CALL_METHOD_REF, kBaseAdd) +
              ext(Opcode::IS_TYPE, F(kB), S(kObjectRef), {}, t.adder.index, 0) +
              op(Opcode::MOV_B, S(kObjectIs), F(kB)) + op(Opcode::MOV_16, F(kW), C(kFour16));
  // TRY w := w / 0; CATCH kind := the trap
  const auto handler = static_cast<uint32_t>(code.size()) + 4;
  code = code + jump(Opcode::TRY, 3) + op(Opcode::DIV_I16, F(kW), F(kW), C(kZero16)) +
         op(Opcode::END_TRY) + jump(Opcode::JMP, 2) + op(Opcode::TRAP_KIND, F(kD)) +
         op(Opcode::MOV_32, S(kObjectKind), F(kD)) + op(Opcode::RET);
  return object_image(code, {{handler, {}}, {handler + 2, {}}});
}

}  // namespace sample
