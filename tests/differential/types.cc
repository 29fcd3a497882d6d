// Types of a random program: everything elementary, strings of several lengths, and declared
// enumerations, subranges, structures and arrays of all of them.
#include <algorithm>

#include "tests/differential/builder.h"

namespace differential {
namespace {

constexpr uint32_t kCapacities[] = {1, 5, 12, 80};
// Several arrays and their copies in calls lie in one frame, whose references are near its begin.
constexpr uint64_t kMostArrayBytes = 8192;

}  // namespace

Builder::Builder(uint64_t seed, bool construction, bool iec)
    : random_(seed), construction_(construction), iec_(iec) {
  for (uint32_t i = 0; i < ir::kElementaryCount; ++i) {
    Type type;
    type.name = std::string(ir::elementary_name(static_cast<ir::Kind>(i)));
    program_.types.push_back(std::move(type));
  }
}

TypeRef Builder::add_type(Type type) {
  program_.types.push_back(std::move(type));
  return static_cast<TypeRef>(program_.types.size() - 1);
}

TypeRef Builder::declared(Type type) {
  type.declared = true;
  TypeRef ref = add_type(std::move(type));
  program_.declared.push_back(ref);
  return ref;
}

TypeRef Builder::string_type(bool wide, uint32_t capacity) {
  auto [found, fresh] = strings_.try_emplace({wide, capacity}, kNoType);
  if (fresh) {
    Type type;
    type.form = wide ? Form::kWstring : Form::kString;
    type.capacity = capacity;
    type.name = std::string(wide ? "WSTRING[" : "STRING[") + std::to_string(capacity) + "]";
    found->second = add_type(std::move(type));
  }
  return found->second;
}

TypeRef Builder::array_of(TypeRef element, std::vector<Bounds> dims) {
  Type type;
  type.form = Form::kArray;
  type.base = element;
  type.dims = std::move(dims);
  return add_type(std::move(type));
}

TypeRef Builder::named(Form form, std::string name, TypeRef base) {
  auto [found, fresh] = named_.try_emplace(name, kNoType);
  if (fresh) {
    Type type;
    type.form = form;
    type.name = std::move(name);
    type.base = base;
    found->second = add_type(std::move(type));
  }
  return found->second;
}

TypeRef Builder::pointer_to(TypeRef target) {
  return named(Form::kPointer, (one_in(3) && !iec_ ? "REF_TO " : "POINTER TO ") + name_of(target), target);
}

TypeRef Builder::open_array(TypeRef element, uint32_t dims) {
  std::string stars = dims == 1 ? "*" : "*, *";
  TypeRef type = named(Form::kOpenArray, "ARRAY[" + stars + "] OF " + name_of(element), element);
  program_.types[type].dims.assign(dims, {-3, 6});
  return type;
}

bool Builder::holds_block(TypeRef type) const {
  const Type& row = program_[type];
  if (row.form == Form::kArray) return holds_block(row.base);
  return row.form == Form::kBlock ||
         std::any_of(row.members.begin(), row.members.end(), [this](const Variable& member) {
           return !is(member.type, Form::kPointer) && holds_block(member.type);
         });
}

std::optional<uint32_t> Builder::bytes_of(TypeRef type) const {
  const Type& row = program_[type];
  if (row.form == Form::kElementary) {
    static const ir::TypeTable kTypes;
    return ir::scalar_size(kTypes.scalar(kTypes.elementary(static_cast<ir::Kind>(type))));
  }
  if (row.form != Form::kArray) return std::nullopt;
  std::optional<uint32_t> size = bytes_of(row.base);
  for (const Bounds& dim : row.dims) {
    if (size) *size *= static_cast<uint32_t>(dim.high - dim.low + 1);
  }
  return size;
}

uint64_t Builder::most_bytes(TypeRef type) const {
  const Type& row = program_[type];
  uint64_t bytes = 0;
  switch (row.form) {
    case Form::kString:
      return row.capacity + 1;
    case Form::kWstring:
      return 2 * (uint64_t{row.capacity} + 2);
    case Form::kArray:
      bytes = most_bytes(row.base);
      for (const Bounds& dim : row.dims) bytes *= static_cast<uint64_t>(dim.high - dim.low + 1);
      return bytes;
    case Form::kStruct:
    case Form::kUnion:
      if (row.base != kNoType) bytes = most_bytes(row.base);
      for (const Variable& member : row.members) bytes += (most_bytes(member.type) + 7) / 8 * 8;
      return bytes;
    default:
      return 8;
  }
}

ir::Group Builder::group(TypeRef type) const {
  return is_elementary(type) ? ir::elementary_group(static_cast<ir::Kind>(type)) : ir::Group::kNone;
}

bool Builder::is_integer(TypeRef type) const {
  return group(type) == ir::Group::kSigned || group(type) == ir::Group::kUnsigned;
}

bool Builder::is_bits(TypeRef type) const {
  return group(type) == ir::Group::kBit && type != elementary(ir::Kind::kBool);
}

Bounds Builder::range(TypeRef type) const {
  const Type& row = program_[type];
  if (row.form == Form::kSubrange) return {row.low, row.high};
  switch (static_cast<ir::Kind>(type)) {
    case ir::Kind::kSint:
      return {-128, 127};
    case ir::Kind::kInt:
      return {-32768, 32767};
    case ir::Kind::kDint:
      return {INT32_MIN, INT32_MAX};
    case ir::Kind::kLint:
      return {INT64_MIN, INT64_MAX};
    case ir::Kind::kBool:
      return {0, 1};
    case ir::Kind::kUsint:
    case ir::Kind::kByte:
      return {0, 255};
    case ir::Kind::kUint:
    case ir::Kind::kWord:
      return {0, 65535};
    case ir::Kind::kUdint:
    case ir::Kind::kDword:
      return {0, UINT32_MAX};
    default:
      return {0, INT64_MAX};
  }
}

TypeRef Builder::any_elementary() { return below(ir::kElementaryCount); }

TypeRef Builder::any_scalar() {
  switch (below(10)) {
    case 0:
      return string_type(false, kCapacities[below(4)]);
    case 1:
      return string_type(true, kCapacities[below(4)]);
    case 2:
      return enums_[below(static_cast<uint32_t>(enums_.size()))];
    case 3:
      return subranges_[below(static_cast<uint32_t>(subranges_.size()))];
    case 4:
      return elementary(ir::Kind::kBool);
    case 5:
      return elementary(one_in(2) ? ir::Kind::kInt : ir::Kind::kDint);
    default:
      return any_elementary();
  }
}

TypeRef Builder::any_data() {
  switch (below(18)) {
    case 3:
      return any_of(unions_);
    case 0:
    case 1:
    case 2:
      return structs_[below(static_cast<uint32_t>(structs_.size()))];
    case 4:
    case 5:
    case 6:
      return arrays_[below(static_cast<uint32_t>(arrays_.size()))];
    default:
      return any_scalar();
  }
}

void Builder::declare_enum() {
  static constexpr ir::Kind kBases[] = {ir::Kind::kInt,  ir::Kind::kInt,  ir::Kind::kUsint,
                                        ir::Kind::kSint, ir::Kind::kDint, ir::Kind::kByte};
  Type type;
  type.form = Form::kEnum;
  type.name = fresh("Enum");
  type.base = elementary(kBases[below(std::size(kBases))]);
  int64_t value = std::max<int64_t>(range(type.base).low, -3 + static_cast<int>(below(4)));
  for (uint32_t n = 2 + below(4); n > 0; --n) {
    type.literals.push_back(fresh("Lit"));
    type.values.push_back(value);
    value += 1 + below(3) * below(5);
  }
  enums_.push_back(declared(std::move(type)));
}

void Builder::declare_subrange() {
  TypeRef base = elementary(static_cast<ir::Kind>(1 + below(8)));
  Bounds all = range(base);
  Type type;
  type.form = Form::kSubrange;
  type.name = fresh("Range");
  type.base = base;
  type.low = one_in(4) ? all.low : std::max<int64_t>(all.low, -20 + static_cast<int>(below(25)));
  type.high = one_in(4) ? all.high : std::min<int64_t>(all.high, 10 + below(100));
  subranges_.push_back(declared(std::move(type)));
}

void Builder::declare_struct() {
  Type type;
  type.form = Form::kStruct;
  type.name = fresh("Struct");
  if (!structs_.empty() && one_in(4)) type.base = any_of(structs_);
  for (uint32_t n = 2 + below(4); n > 0; --n) {
    Variable member;
    member.name = fresh("m");
    bool nested = !structs_.empty() && one_in(5);
    bool list = !nested && one_in(5);
    member.type = nested ? structs_[below(static_cast<uint32_t>(structs_.size()))] : any_scalar();
    if (list) member.type = array_of(member.type, {{0, 1 + static_cast<int>(below(3))}});
    if (!nested && !list && one_in(3)) member.initial = literal(member.type, true);
    type.members.push_back(std::move(member));
  }
  for (uint32_t n = one_in(3) ? 1 + below(10) : 0; n > 0; --n) {
    Variable bit{fresh("m"), elementary(ir::Kind::kBool), std::nullopt, {}, {}};
    bit.bit = true;
    if (one_in(3)) bit.initial = literal(bit.type, true);
    type.members.push_back(std::move(bit));
  }
  structs_.push_back(declared(std::move(type)));
}

// What lies on top of each other: numbers, texts, arrays and structures of them.
void Builder::declare_union() {
  Type type;
  type.form = Form::kUnion;
  type.name = fresh("Union");
  type.overlap = one_in(3);
  for (uint32_t n = 2 + below(3); n > 0; --n) {
    Variable member{fresh("m"), any_elementary(), std::nullopt, {}, {}};
    if (one_in(3)) member.type = array_of(member.type, {{0, 1 + static_cast<int>(below(4))}});
    if (one_in(6)) member.type = string_type(one_in(3), 5);
    if (one_in(6)) member.type = any_of(structs_);
    if (!unions_.empty() && one_in(8)) member.type = any_of(unions_);
    type.members.push_back(std::move(member));
  }
  unions_.push_back(declared(std::move(type)));
}

void Builder::declare_node() {
  Type type;
  type.form = Form::kStruct;
  type.name = fresh("Node");
  type.members.push_back({fresh("m"), any_scalar(), std::nullopt, {}, {}});
  std::string pointer = (one_in(2) ? "POINTER TO " : "REF_TO ") + type.name;
  TypeRef node = declared(std::move(type));
  Variable next{fresh("next"), named(Form::kPointer, pointer, node), std::nullopt, {}, {}};
  std::vector<Variable>& members = program_.types[node].members;
  members.insert(members.begin() + below(2), std::move(next));
  nodes_.push_back(node);
}

void Builder::declare_array() {
  std::vector<Bounds> dims;
  for (uint32_t n = one_in(3) ? 2 : 1; n > 0; --n) {
    int64_t low = one_in(2) ? 0 : -2 + static_cast<int>(below(5));
    dims.push_back({low, low + 1 + below(3)});
  }
  TypeRef element =
      one_in(4) ? structs_[below(static_cast<uint32_t>(structs_.size()))] : any_scalar();
  Type type;
  type.form = Form::kArray;
  type.name = fresh("Array");
  type.base = element;
  type.dims = std::move(dims);
  const TypeRef array = declared(std::move(type));
  if (most_bytes(array) > kMostArrayBytes) program_.types[array].base = elementary(ir::Kind::kInt);
  arrays_.push_back(array);
}

void Builder::declare_types() {
  for (uint32_t n = 1 + below(2); n > 0; --n) declare_enum();
  for (uint32_t n = 1 + below(2); n > 0; --n) declare_subrange();
  for (uint32_t n = 1 + below(3); n > 0; --n) declare_struct();
  for (uint32_t n = 1 + below(2); n > 0; --n) declare_array();
  for (uint32_t n = 1 + below(2); n > 0; --n) declare_union();
  if (one_in(2)) declare_node();
}

}  // namespace differential
