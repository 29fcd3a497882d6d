// Functions, function blocks, programs, global variables and tasks.
#include "tests/differential/builder.h"

namespace differential {

VarBlock& Builder::section(Pou& pou, Section kind) {
  for (VarBlock& block : pou.blocks) {
    if (block.section == kind) return block;
  }
  pou.blocks.push_back({kind, {}});
  return pou.blocks.back();
}

Variable& Builder::declare(Pou& pou, Section kind, TypeRef type, bool with_initial) {
  Variable variable{fresh("v"), type, std::nullopt, {}, {}};
  if ((with_initial && one_in(3)) || kind == Section::kConstant) variable.initial = initial(type);
  bool named = with_initial && kind != Section::kConstant && kind != Section::kInput && one_in(6);
  if (named) name_initial(variable);
  bool lasting = kind == Section::kLocal || kind == Section::kConstant;
  if (lasting) nameable_.push_back(variable);
  bool writable = kind != Section::kInput && kind != Section::kConstant;
  see(variable, writable, kind == Section::kConstant);
  if (kind == Section::kLocal) variable.arguments = construction_arguments(type);
  if (kind != Section::kTemp && kind != Section::kInOut) {
    own_.push_back({variable, writable, kind == Section::kConstant});
  }
  VarBlock& block = section(pou, kind);
  block.variables.push_back(std::move(variable));
  return block.variables.back();
}

// By another variable of its type.
void Builder::name_initial(Variable& variable) {
  std::vector<Variable> fitting;
  for (const Variable& one : nameable_) {
    if (one.type == variable.type) fitting.push_back(one);
  }
  if (fitting.empty()) return;
  variable.initial = node(variable.type, fitting[below(count(fitting))].name, {});
}

void Builder::parameters(Pou& pou, Interface& face) {
  for (uint32_t n = 1 + below(3); n > 0; --n) {
    if (kind_ != PouKind::kProgram && one_in(8)) {
      Variable input{fresh("v"), pointer_to(any_data()), std::nullopt, {}, {}};
      section(pou, Section::kInput).variables.push_back(input);
      own_target(pou, input);
      face.inputs.push_back(std::move(input));
      continue;
    }
    bool open = kind_ == PouKind::kFunction && one_in(6);
    TypeRef type = open ? open_array(program_[any_of(arrays_)].base, 1) : any_data();
    Variable& input = declare(pou, Section::kInput, type, !open);
    bool edge = input.type == elementary(ir::Kind::kBool) && kind_ == PouKind::kFunctionBlock;
    if (edge && !input.initial && one_in(2)) input.edge = one_in(2) ? "R_EDGE" : "F_EDGE";
    face.inputs.push_back(input);
  }
  for (uint32_t n = below(3); n > 0; --n) {
    face.outputs.push_back(declare(pou, Section::kOutput, any_data(), false));
  }
  if (kind_ == PouKind::kProgram) return;
  for (uint32_t n = one_in(2) ? 1 + below(2) : 0; n > 0; --n) {
    TypeRef type = any_data();
    if (one_in(4)) type = any_block();
    const Type& list = program_[any_of(arrays_)];
    if (kind_ == PouKind::kFunction && one_in(4)) {
      type = open_array(list.base, static_cast<uint32_t>(list.dims.size()));
    }
    face.in_outs.push_back(declare(pou, Section::kInOut, type, false));
  }
}

// Counters are written by their FOR only; a trap in between would otherwise never come out.
void Builder::loop_variables(Pou& pou) {
  for (int level = 0; level < 3; ++level) {
    TypeRef type = elementary(static_cast<ir::Kind>(1 + below(8)));
    Variable variable{fresh("loop"), type, std::nullopt, {}, {}};
    loops_.emplace_back(variable.name, type);
    section(pou, Section::kLocal).variables.push_back(std::move(variable));
  }
  Variable guard{"guard", elementary(ir::Kind::kDint), std::nullopt, {}, {}};
  places_[guard.type].push_back({"guard", {}, guard.type, false, false});
  own_.push_back({guard, false, false});
  section(pou, Section::kLocal).variables.push_back(std::move(guard));
  Variable spare{"spare", elementary(ir::Kind::kDint), std::nullopt, {}, {}};
  see(spare, true);
  own_.push_back({spare, true, false});
  section(pou, Section::kLocal).variables.push_back(std::move(spare));
}

void Builder::locals(Pou& pou, uint32_t count) {
  const bool extends = !loops_.empty();
  if (!extends) loop_variables(pou);
  for (uint32_t i = 0; i < count; ++i) declare(pou, Section::kLocal, any_data());
  if (!has_frame()) {
    for (uint32_t n = below(2); n > 0; --n) declare(pou, Section::kTemp, any_data());
    for (uint32_t n = below(2); n > 0; --n) declare(pou, Section::kRetain, any_data());
  }
  if (one_in(3) && !iec_) declare(pou, Section::kStatic, any_data());
  for (uint32_t n = below(3); n > 0; --n) declare(pou, Section::kConstant, any_elementary());
  if (!has_frame()) {
    for (const Variable& global : global_variables_) nameable_.push_back(global);
  }
  if (!extends && one_in(4)) external(pou);
  for (const Variable& global : global_variables_) see(global, true);
  for (const Variable& constant : global_constants_) see(constant, false, true);
}

// What is visible anyway, once more by name.
void Builder::external(Pou& pou) {
  for (const Variable& global : global_variables_) {
    bool plain = global.name.find('.') == std::string::npos && global.arguments.empty();
    if (!plain || !one_in(3)) continue;
    section(pou, Section::kExternal).variables.push_back({global.name, global.type});
  }
}

TypeRef Builder::any_block() {
  const std::vector<Interface>& from = !blocks_.empty() && one_in(2) ? blocks_ : library_;
  return from[below(count(from))].block;
}

void Builder::instances(Pou& pou) {
  for (uint32_t n = below(3); n > 0; --n) {
    TypeRef type = any_block();
    if (one_in(4)) type = array_of(type, {{0, 1 + static_cast<int>(below(2))}});
    declare(pou, Section::kLocal, type, false);
  }
}

void Builder::body(Pou& pou, uint32_t count, int depth) {
  pou.body = std::move(prologue_);
  for (Stmt& one : statements(count, depth)) pou.body.push_back(std::move(one));
  if (one_in(6)) {
    pou.body.insert(pou.body.begin() + below(static_cast<uint32_t>(pou.body.size())),
                    leave("RETURN"));
  }
}

void Builder::function(uint32_t index) {
  forget();
  kind_ = PouKind::kFunction;
  rounds_ = 8;  // it may be called in loops
  Pou pou;
  pou.kind = kind_;
  pou.name = "Fun" + std::to_string(index);
  Interface face;
  face.name = place_in_space(pou);
  if (!one_in(8)) pou.result = any_data();
  face.result = pou.result;
  parameters(pou, face);
  locals(pou, 2 + below(3));
  if (one_in(5)) {
    instruction_list(pou, 1 + below(3));
  } else {
    references(pou);
    body(pou, 2 + below(3), 2);
    if (pou.result != kNoType && possible(pou.result)) {
      pou.body.push_back(simple(pou.name + " := @0;", {expression(pou.result, 3)}));
    }
  }
  program_.pous.push_back(std::move(pou));
  functions_.push_back(std::move(face));
}

void Builder::block(uint32_t index) {
  forget();
  kind_ = PouKind::kFunctionBlock;
  rounds_ = 4;
  Pou pou;
  pou.kind = kind_;
  pou.name = "Block" + std::to_string(index);
  Interface face;
  face.name = place_in_space(pou);
  parameters(pou, face);
  locals(pou, 3 + below(3));
  instances(pou);
  block_body(pou);
  if (construction_ && one_in(4)) construct(pou, face, nullptr);
  Type type;
  type.form = Form::kBlock;
  type.name = face.name;
  face.block = add_type(std::move(type));
  faces_[face.block] = face;
  program_.pous.push_back(std::move(pou));
  blocks_.push_back(std::move(face));
  // Structures and arrays that hold instances.
  if (one_in(2) && blocks_.back().construction.empty()) {
    Type holder;
    holder.form = Form::kStruct;
    holder.name = fresh("Holder");
    holder.members.push_back({fresh("m"), any_scalar(), std::nullopt, {}, {}});
    holder.members.push_back({fresh("m"), blocks_.back().block, std::nullopt, {}, {}});
    holders_.push_back(declared(std::move(holder)));
  }
}

// Its whole name: what others call it.
std::string Builder::place_in_space(Pou& pou) {
  static constexpr const char* kSpaces[] = {"Space0", "Space1", "Space0.Deep"};
  if (!one_in(4)) return pou.name;
  pou.space = kSpaces[below(3)];
  spaces_.push_back(pou.space);
  return pou.space + "." + pou.name;
}

// Statements, a chart or a list.
void Builder::block_body(Pou& pou) {
  if (one_in(6)) return instruction_list(pou, 2 + below(4));
  if (one_in(4)) return chart(pou);
  objects(pou);
  references(pou);
  body(pou, 3 + below(4), 2);
}

void Builder::globals() {
  static constexpr Section kSections[] = {Section::kGlobal, Section::kGlobalRetain,
                                          Section::kGlobalConstant};
  Variable event{"event", elementary(ir::Kind::kBool), std::nullopt, {}, {}};
  program_.globals.push_back({Section::kGlobal, {event}});
  global_variables_.push_back(std::move(event));
  for (Section kind : kSections) {
    VarBlock block{kind, {}};
    if (one_in(4)) block.list = fresh("List");
    bool constant = kind == Section::kGlobalConstant;
    for (uint32_t n = below(4); n > 0; --n) {
      Variable variable{fresh("g"), constant ? any_elementary() : any_data(), std::nullopt, {}, {}};
      if (constant || one_in(3)) variable.initial = initial(variable.type);
      Variable seen = variable;
      if (!block.list.empty()) seen.name = block.list + "." + seen.name;
      (constant ? global_constants_ : global_variables_).push_back(std::move(seen));
      block.variables.push_back(std::move(variable));
    }
    program_.globals.push_back(std::move(block));
  }
}

// At overlapping addresses, far behind those that VAR_CONFIG gives: they share bytes.
void Builder::shared_globals() {
  struct Row {
    ir::Kind kind;
    char letter;
    uint32_t size;
  };
  static constexpr Row kRows[] = {
      {ir::Kind::kByte, 'B', 1},  {ir::Kind::kSint, 'B', 1}, {ir::Kind::kWord, 'W', 2},
      {ir::Kind::kInt, 'W', 2},   {ir::Kind::kUint, 'W', 2}, {ir::Kind::kDword, 'D', 4},
      {ir::Kind::kDint, 'D', 4},  {ir::Kind::kReal, 'D', 4}, {ir::Kind::kLword, 'L', 8},
      {ir::Kind::kLreal, 'L', 8}, {ir::Kind::kTime, 'L', 8}};
  constexpr uint32_t kFirst = 4096;
  VarBlock block{one_in(3) ? Section::kGlobalRetain : Section::kGlobal, {}};
  for (uint32_t n = 2 + below(4); n > 0; --n) {
    const Row& row = kRows[below(std::size(kRows))];
    Variable one{fresh("g"), elementary(row.kind), std::nullopt, {}, {}};
    one.address = std::string("%M") + row.letter +
                  std::to_string(kFirst / row.size + below(16 / row.size));
    global_variables_.push_back(one);
    block.variables.push_back(std::move(one));
  }
  program_.globals.push_back(std::move(block));
}

void Builder::program(uint32_t index, uint32_t count) {
  forget();
  kind_ = PouKind::kProgram;
  Pou pou;
  pou.kind = kind_;
  pou.name = "Main" + std::to_string(index);
  Interface face;
  if (one_in(2)) parameters(pou, face);
  locals(pou, 16 + below(8));
  instances(pou);
  instances(pou);
  if (!holders_.empty()) {
    declare(pou, Section::kLocal, holders_[below(static_cast<uint32_t>(holders_.size()))], false);
  }
  if (!spaces_.empty() && one_in(2))
    pou.uses = spaces_[below(static_cast<uint32_t>(spaces_.size()))];
  if (index == 0) {
    Variable& output = declare(pou, Section::kLocal, elementary(ir::Kind::kBool));
    output.address = "%QX" + std::to_string(below(4)) + "." + std::to_string(below(8));
  }
  if (configured_) configure(pou);
  if (index > 0 && one_in(3)) {
    chart(pou);
  } else if (index > 0 && one_in(3)) {
    instruction_list(pou, 4 + below(4));
  } else {
    objects(pou);
    references(pou);
    call_side();
    body(pou, (10 + below(10)) / count, 3);
    if (!passes_addresses(pou) && one_in(3)) program_action(pou);
  }
  // Blocks that a task of their own may run.
  for (const VarBlock& list : pou.blocks) {
    for (const Variable& one : list.variables) {
      bool fits = list.section == Section::kLocal && is(one.type, Form::kBlock) &&
                  faces_[one.type].in_outs.empty();
      if (fits) face.in_outs.push_back(one);
    }
  }
  programs_.push_back(std::move(face));
  program_.pous.push_back(std::move(pou));
}

// Instances that every program sees.
void Builder::global_instances() {
  VarBlock block{Section::kGlobal, {}};
  for (uint32_t n = below(3); n > 0; --n) {
    Variable one{fresh("g"), any_block()};
    one.arguments = construction_arguments(one.type);
    global_variables_.push_back(one);
    block.variables.push_back(std::move(one));
  }
  program_.globals.push_back(std::move(block));
}

// It has no task of its own.
void Builder::side_program() {
  forget();
  kind_ = PouKind::kProgram;
  rounds_ = 8;
  Pou pou;
  pou.kind = kind_;
  Interface face;
  face.name = pou.name = "Side";
  parameters(pou, face);
  locals(pou, 3 + below(3));
  instances(pou);
  references(pou);
  body(pou, 3 + below(3), 2);
  program_.pous.push_back(std::move(pou));
  side_ = std::move(face);
}

void Builder::call_side() {
  if (!side_) return;
  for (const Variable& one : side_->outputs) see({"Side." + one.name, one.type}, false);
  std::optional<std::vector<Expr>> args = arguments(*side_, true, 2);
  if (!args) args.emplace();
  prologue_.push_back(simple("Side(@0);", {node(kNoType, "@*", std::move(*args))}));
}

// One that the next program may call.
void Builder::program_action(Pou& pou) {
  std::vector<Seen> seen = own_;
  std::string name = fresh("Act");
  pou.members.push_back(action(seen, name));
  if (one_in(2)) pou.body.push_back(simple(name + "();", {}));
}

Program Builder::run() {
  risky_ = one_in(4);
  read_library();
  declare_types();
  globals();
  if (one_in(3)) shared_globals();
  if (one_in(2)) declare_generics();
  uint32_t functions = 1 + below(3);
  for (uint32_t i = 0; i < functions; ++i) function(i);
  if (one_in(3)) recursive_functions();
  uint32_t blocks = 1 + below(3);
  for (uint32_t i = 0; i < blocks; ++i) block(i);
  for (uint32_t n = below(3); n > 0; --n) family();
  if (one_in(2)) block(blocks);
  global_instances();
  if (one_in(4)) side_program();
  uint32_t programs = one_in(3) ? 2 : 1;
  configured_ = programs > 1 || one_in(2);
  for (uint32_t i = 0; i < programs; ++i) program(i, programs);
  tasks(programs);
  return std::move(program_);
}

Program random_program(uint64_t seed, bool construction, bool iec) {
  return Builder(seed, construction, iec).run();
}

}  // namespace differential
