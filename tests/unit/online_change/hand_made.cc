#include "tests/unit/online_change/hand_made.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "ir/bytecode/symbols.h"
#include "online_change/package/package.h"

namespace hand_made {
namespace {

uint32_t align_up(uint32_t at, uint32_t align) { return (at + align - 1) / align * align; }

const ir::Type* type_named(const ir::Image& image, const std::string& name, ir::Kind kind,
                           ir::TypeId& id) {
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    id = ir::TypeId(i);
    if (image.types[id].kind == kind && ir::same_name(image.types[id].name, name)) {
      return &image.types[id];
    }
  }
  return nullptr;
}

}  // namespace

ir::TypeId Version::enumeration(const std::string& name, std::vector<ir::EnumLiteral> literals) {
  ir::Type type;
  type.kind = ir::Kind::kEnum;
  type.name = name;
  type.base = elementary(ir::Kind::kInt);
  type.literals = std::move(literals);
  return image.types.own().declare(std::move(type));
}

ir::TypeId Version::declare(ir::Kind kind, const std::string& name, const std::vector<Var>& vars) {
  ir::Type type;
  type.kind = kind;
  type.name = name;
  for (const Var& var : vars) {
    ir::Member member;
    member.name = var.name;
    member.type = var.type;
    member.constant = var.constant;
    if (var.init != 0) member.init = image.constants.own().scalar(var.init);
    type.members.push_back(member);
  }
  return image.types.own().declare(std::move(type));
}

void Version::lay_out(ir::TypeId id, const ir::Image* base) {
  if (laid_out_[id.index]) return;
  laid_out_[id.index] = true;
  const ir::Type& type = image.types[id];
  ir::TypeLayout& layout = image.layouts.own().of[id.index];
  if (image.types.has_members(id)) return lay_out_members(id, base);
  if (type.kind == ir::Kind::kArray) {
    lay_out(type.base, base);
    uint64_t count = 1;
    for (const ir::Dimension& dim : type.dims) count *= dim.count();
    layout.size = static_cast<uint32_t>(image.layouts[type.base].size * count);
    layout.align = image.layouts[type.base].align;
  } else if (type.kind == ir::Kind::kString || type.kind == ir::Kind::kWstring) {
    layout.align = type.kind == ir::Kind::kString ? 1 : 2;
    layout.size = (type.capacity + 1) * layout.align;
  } else {
    layout.size = ir::scalar_size(image.types.scalar(id));
    layout.align = layout.size;
  }
}

void Version::lay_out_members(ir::TypeId id, const ir::Image* base) {
  const ir::Type& type = image.types[id];
  ir::TypeId old_id;
  const ir::Type* old_type = base ? type_named(*base, type.name, type.kind, old_id) : nullptr;
  uint32_t end = old_type != nullptr ? base->layouts[old_id].used : 0;
  uint32_t align = 8;
  std::vector<uint32_t> offsets(type.members.size());
  for (size_t i = 0; i < type.members.size(); ++i) {
    lay_out(type.members[i].type, base);
    const ir::TypeLayout& part = image.layouts[type.members[i].type];
    int32_t twin = old_type != nullptr ? base->types.find_member(old_id, type.members[i].name) : -1;
    bool stays = twin >= 0 &&
                 base->types.text(old_type->members[static_cast<size_t>(twin)].type) ==
                     image.types.text(type.members[i].type) &&
                 base->layouts[old_type->members[static_cast<size_t>(twin)].type].size == part.size;
    if (stays) {
      offsets[i] = base->layouts[old_id].member_offsets[static_cast<size_t>(twin)];
    } else {
      offsets[i] = align_up(end, part.align);
      end = offsets[i] + part.size;
    }
  }
  ir::TypeLayout& layout = image.layouts.own().of[id.index];
  layout.member_offsets = offsets;
  layout.used = end;
  layout.align = align;
  layout.size = image.types.is_instance(id) ? 4 : align_up(end, align);
  if (image.types.is_instance(id)) layout.align = 4;
  layout.area_capacity = align_up(end + slack_, 8);
  if (old_type != nullptr) {
    uint32_t old_capacity = base->layouts[old_id].area_capacity;
    if (end <= old_capacity) layout.area_capacity = old_capacity;
  }
}

uint32_t Version::find_old(const Version& base, uint32_t id) const {
  for (uint32_t old = 1; old < base.image.instances.size(); ++old) {
    if (!base.image.instances[old].live) continue;
    if (ir::same_name(base.image.instance_path(old), image.instance_path(id))) return old;
  }
  return 0;
}

void Version::add_instance(uint32_t parent, const std::string& name, ir::TypeId type,
                           const Version* base, bool move) {
  ir::Instance instance;
  instance.type = type;
  instance.parent = parent;
  instance.live = true;
  instance.name = name;
  auto id = static_cast<uint32_t>(image.instances.size());
  image.instances.push_back(instance);
  uint32_t capacity = image.layouts[type].area_capacity;
  uint32_t old = base != nullptr ? find_old(*base, id) : 0;
  const ir::Image* old_image = base != nullptr ? &base->image : nullptr;
  bool same_type = old != 0 && ir::same_name(old_image->types[old_image->instances[old].type].name,
                                             image.types[type].name);
  bool fits =
      same_type && old_image->layouts[old_image->instances[old].type].area_capacity >= capacity;
  if (fits && !move) {
    image.instances[id].data = old_image->instances[old].data;
  } else {
    image.instances[id].data = next_area_;
    next_area_ += capacity;
  }
  add_children(id, base, move);
}

void Version::add_children(uint32_t id, const Version* base, bool move) {
  const ir::Type& type = image.types[image.instances[id].type];
  for (size_t i = 0; i < type.members.size(); ++i) {
    const ir::Member& member = type.members[i];
    uint32_t at =
        image.instances[id].data + image.layouts[image.instances[id].type].member_offsets[i];
    add_slots(id, member.type, at, member.name, base, move);
    if (member.init.valid()) {
      write_initial(at, member.type, image.constants[member.init].bits);
    } else {
      write_initial(at, member.type, 0);
    }
  }
}

void Version::add_slots(uint32_t id, ir::TypeId type, uint32_t at, const std::string& path,
                        const Version* base, bool move) {
  if (image.types.is_instance(type)) {
    write_bytes(at, image.instances.size(), 4);
    add_instance(id, path, type, base, move);
    return;
  }
  if (image.types[type].kind != ir::Kind::kArray) return;
  ir::TypeId element = image.types[type].base;
  if (!image.types.is_instance(element)) return;
  const ir::Dimension& dim = image.types[type].dims[0];
  for (uint64_t i = 0; i < dim.count(); ++i) {
    std::string index = std::to_string(dim.low + static_cast<int64_t>(i));
    add_slots(id, element, at + static_cast<uint32_t>(i) * 4, path + "[" + index + "]", base, move);
  }
}

void Version::write_bytes(uint32_t at, uint64_t bits, uint32_t size) {
  base::Bytes bytes(size);
  std::memcpy(bytes.data(), &bits, size);
  initial_[at] = bytes;
}

// `init` of a scalar; members of a structure have their own.
void Version::write_initial(uint32_t at, ir::TypeId id, uint64_t init) {
  const ir::Type& type = image.types[id];
  if (image.types.is_scalar(id)) {
    if (init != 0) write_bytes(at, init, image.layouts[id].size);
  } else if (type.kind == ir::Kind::kStruct) {
    for (size_t i = 0; i < type.members.size(); ++i) {
      const ir::Member& member = type.members[i];
      uint64_t bits = member.init.valid() ? image.constants[member.init].bits : 0;
      write_initial(at + image.layouts[id].member_offsets[i], member.type, bits);
    }
  } else if (type.kind == ir::Kind::kArray && !image.types.is_instance(type.base)) {
    uint32_t stride = image.layouts[type.base].size;
    for (uint32_t done = 0; done < image.layouts[id].size; done += stride) {
      write_initial(at + done, type.base, init);
    }
  }
}

void Version::link(const Version* base, uint32_t slack, bool move) {
  slack_ = slack;
  image.globals = declare(ir::Kind::kGlobals, "", globals_);
  laid_out_.assign(image.types.size(), false);
  image.layouts.own().of.resize(image.types.size());
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    lay_out(ir::TypeId(i), base != nullptr ? &base->image : nullptr);
  }
  next_area_ = base != nullptr ? base->next_area_ : ir::kDataBegin;
  ir::Instance row;
  row.type = image.globals;
  row.live = true;
  uint32_t capacity = image.layouts[image.globals].area_capacity;
  bool stays = base != nullptr && !move &&
               base->image.layouts[base->image.globals].area_capacity >= capacity;
  row.data = stays ? base->image.instances[0].data : next_area_;
  if (!stays) next_area_ += capacity;
  image.instances.push_back(row);
  add_children(0, base, move);
  for (const auto& [name, type] : programs_) add_instance(0, name, type, base, move);
  for (const auto& [at, bytes] : initial_) image.data.push_back({at, bytes});
  image.data_capacity = std::max(1u << 20, next_area_);
}

Running::Running(const Version& version)
    : version_(&version), memory_(version.image.data_capacity) {
  for (const ir::DataRun& run : version.image.data) {
    std::copy(run.bytes.begin(), run.bytes.end(), memory_.begin() + run.offset);
  }
}

std::string Running::get(const std::string& path) const {
  base::Result<ir::Symbol> symbol = ir::find_symbol(version_->image, path);
  if (!symbol.ok()) return "no " + path;
  return ir::format_value(version_->image, *symbol, memory_);
}

void Running::set(const std::string& path, const std::string& value) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(version_->image, path);
  ASSERT_TRUE(symbol.ok()) << path;
  base::Result<base::Bytes> bytes = ir::parse_value(version_->image, symbol->type, value);
  ASSERT_TRUE(bytes.ok()) << bytes.error().text;
  std::copy(bytes->begin(), bytes->end(), memory_.begin() + symbol->data);
}

base::Digest Running::hash() const { return ir::state_hash(version_->image, memory_); }

online_change::Plan Running::change(const Version& next) {
  using online_change::Transfer;
  auto forward = online_change::plan(version_->image, next.image);
  auto inverse = online_change::inverse_plan(version_->image, next.image);
  EXPECT_TRUE(forward.ok() && inverse.ok());
  forward_ = *forward;
  inverse_ = *inverse;
  online_change::Package package;
  package.forward = forward_;
  package.inverse = inverse_;
  base::Status sound = online_change::check_package(package, version_->image, next.image);
  EXPECT_TRUE(sound.ok()) << (sound.ok() ? "" : sound.error().text);
  transfer_ =
      std::make_unique<Transfer>(forward_, version_->image, next.image, Transfer::Steps::kAll);
  losses_.clear();
  auto collect = [&](const online_change::Loss& loss) {
    losses_.push_back(loss);
    return true;
  };
  EXPECT_TRUE(transfer_->read(memory_.data(), collect, nullptr));
  EXPECT_TRUE(transfer_->save(memory_.data(), nullptr));
  back_ = std::make_unique<Transfer>(inverse_, next.image, version_->image, Transfer::Steps::kAll);
  EXPECT_TRUE(back_->remember(memory_.data(), nullptr));
  EXPECT_TRUE(transfer_->write(memory_.data(), nullptr));
  previous_ = version_;
  version_ = &next;
  return forward_;
}

void Running::undo() {
  const auto any_loss = [](const online_change::Loss&) { return true; };
  EXPECT_TRUE(back_->read_back(memory_.data(), *transfer_, any_loss, nullptr));
  EXPECT_TRUE(back_->save(memory_.data(), nullptr));
  EXPECT_TRUE(back_->write(memory_.data(), nullptr));
  std::swap(version_, previous_);
}

const online_change::FateRow* find_row(const online_change::Plan& plan, const std::string& path) {
  for (const online_change::FateRow& row : plan.fates) {
    if (row.path == path) return &row;
  }
  ADD_FAILURE() << "no fate row for " << path;
  static const online_change::FateRow kNone;
  return &kNone;
}

}  // namespace hand_made
