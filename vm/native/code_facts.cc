#include "vm/native/code_facts.h"

#include <algorithm>

#include "ir/bytecode/regions.h"

namespace vm::native {
namespace {

// Does the unit read the ID of an instance?
bool names_instance(ir::Opcode op) {
  return op == ir::Opcode::INST || op == ir::Opcode::INST_AT || op == ir::Opcode::CALL_INST ||
         op == ir::Opcode::CALL_INST_AT || op == ir::Opcode::CALL_METHOD ||
         op == ir::Opcode::CALL_METHOD_AT;
}

bool has_constant(const ir::Unit& u) {
  return u.base_a() == ir::Base::kConst || u.base_b() == ir::Base::kConst ||
         u.base_c() == ir::Base::kConst;
}

// What machine code compares the type of an instance with, and the body that it runs.
void add_kinds(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
               ir::TypeId type, std::vector<uint64_t>& out) {
  const std::vector<ir::TypeId>* const kinds = common.kinds_of(type);
  out.push_back(kinds == nullptr ? 0 : kinds->size());
  out.push_back(may_be_own(image, pou, type) ? 1 : 0);
  if (kinds == nullptr) return;
  for (const ir::TypeId kind : *kinds) {
    out.push_back(uint64_t{kind.index} << 32 | common.body_of[kind.index]);
  }
}

}  // namespace

base::Digest facts_of(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                      std::vector<uint64_t>& out) {
  out.assign({pou.frame_size, pou.slots.size(), pou.merges.size(),
              (common.recursive_bodies ? 1u : 0u) | (common.clean_bools ? 2u : 0u) |
                  (common.recursive_methods ? 4u : 0u)});
  for (const ir::FrameSlot& slot : pou.slots) {
    out.push_back(uint64_t{slot.offset} << 32 | static_cast<uint64_t>(slot.cls) << 24 |
                  static_cast<uint64_t>(slot.kind) << 16 | static_cast<uint64_t>(slot.local) << 8 |
                  (slot.aggregate ? 1u : 0u));
  }
  const std::span code = common.code_of(image, pou);
  bool names_instances = false;
  for (uint32_t i = 0; i < code.size(); ++i) {
    const ir::Unit& u = code[i];
    const ir::OpcodeRow& row = ir::opcode_row(u.opcode());
    const ir::Unit& x = row.extended ? code[i + 1] : u;
    const Accesses named = has_constant(u) ? accesses_of(u) : Accesses();
    for (const Access& access : named) {
      if (access.base != ir::Base::kConst) continue;
      uint64_t bits = 0;
      std::memcpy(&bits, image.pool.data() + access.offset, ir::class_size(access.cls));
      out.push_back(bits);
    }
    if (row.x.kind == ir::FieldKind::kBounds) {
      const ir::LinkedBound& bound = image.bounds[x.x()];
      out.insert(out.end(), {static_cast<uint64_t>(bound.low), bound.count, bound.stride});
    }
    if (row.c.kind == ir::FieldKind::kRange) {
      const ir::Range& range = image.ranges[u.c];
      out.insert(out.end(), {static_cast<uint64_t>(range.low), static_cast<uint64_t>(range.high)});
    }
    names_instances |= names_instance(u.opcode());
    uint32_t callee = kNone;
    if (row.c.kind == ir::FieldKind::kCode) callee = u.c;
    if (row.x.kind == ir::FieldKind::kCode) callee = x.x();
    if (u.opcode() == ir::Opcode::CALL_INST || u.opcode() == ir::Opcode::CALL_INST_AT) {
      callee = called_body(image, common, pou, u);
    }
    if (callee != kNone) {
      const ir::LinkedPou& called = image.pous[callee];
      out.insert(out.end(), {callee, called.recursion_depth,
                             may_share_instance(image, pou, called) ? uint64_t{1} : 0});
    }
    if (u.opcode() == ir::Opcode::CALL_REF)
      add_kinds(image, common, pou, ir::region_of_field(x.x()).type, out);
    if (u.opcode() == ir::Opcode::CALL_VIRTUAL) {
      for (const ir::LinkedOverride& one : common.targets_of(x.x())) {
        const ir::LinkedPou& target = image.pous[one.target];
        out.insert(out.end(), {one.type.index, one.target, target.recursion_depth,
                               may_share_instance(image, pou, target) ? uint64_t{1} : 0});
      }
      out.push_back(kNone);
    }
    if (u.opcode() == ir::Opcode::CALL_METHOD_REF) {
      add_kinds(image, common, pou, image.pous[x.x()].self, out);
    }
    if (u.opcode() == ir::Opcode::COPY) {
      out.push_back(ir::region_size(image.types, image.layouts, ir::region_of_field(x.x())));
    }
    if (u.opcode() == ir::Opcode::RESOLVE) {
      const ir::TypeId type = ir::region_of_field(x.x()).type;
      out.push_back(uint64_t{image.layouts[type].size} << 1 | (common.has_slots(type) ? 1 : 0));
      add_kinds(image, common, pou, type, out);
    }
    if (u.opcode() == ir::Opcode::LEA) {
      out.push_back(ir::region_size(image.types, image.layouts, ir::region_of_field(x.y())));
    }
    if (row.extended) ++i;
  }
  if (names_instances && pou.self.valid()) {
    for (const Children& all : common.children(pou.self)) {
      out.insert(out.end(), {all.slot, all.count, static_cast<uint64_t>(all.first),
                             static_cast<uint64_t>(all.stride)});
    }
  }
  return base::sha256({reinterpret_cast<const uint8_t*>(out.data()), out.size() * sizeof out[0]});
}

bool names_constants(const ir::Image& image, const ImageFacts& common, const ir::LinkedPou& pou,
                     ir::ConstantRange there) {
  const std::span code = common.code_of(image, pou);
  for (uint32_t i = 0; i < code.size(); ++i) {
    const ir::Unit& u = code[i];
    if (has_constant(u)) {
      for (const Access& access : accesses_of(u)) {
        const bool meets = there.meets(access.offset, ir::class_size(access.cls));
        if (access.base == ir::Base::kConst && meets) return true;
      }
    }
    if (ir::opcode_row(u.opcode()).extended) ++i;
  }
  return false;
}

}  // namespace vm::native
