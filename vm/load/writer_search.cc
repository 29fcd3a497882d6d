#include "vm/load/writer_search.h"

#include <algorithm>

#include "ir/bytecode/regions.h"
#include "stdlib/native/natives.h"

namespace vm {
namespace {

using ir::Opcode;
using How = Writer::How;
using Kind = Origin::Kind;

constexpr uint64_t kAll = UINT32_MAX;  // bytes: what the address leads to

}  // namespace

WriterSearch::WriterSearch(const ir::Image& image, std::span<const Variable> variables)
    : image_(image), targets_(targets_of(image, variables)) {
  for (uint32_t i = 0; i < targets_.size(); ++i) {
    (targets_[i].owner == 0 ? by_place_ : inside_).push_back(i);
    longest_ = std::max(longest_, targets_[i].end - targets_[i].begin);
  }
  std::sort(by_place_.begin(), by_place_.end(),
            [&](uint32_t a, uint32_t b) { return targets_[a].begin < targets_[b].begin; });
}

bool WriterSearch::is_shared(ir::TypeId self) {
  if (counts_.empty()) counts_.resize(image_.types.size(), UINT32_MAX);
  uint32_t& count = counts_[self.index];
  if (count == UINT32_MAX) {
    count = static_cast<uint32_t>(std::count_if(
        image_.instances.begin(), image_.instances.end(),
        [&](const auto& row) { return row.live && image_.types.is_a(row.type, self); }));
  }
  return count > 1;
}

// Variables that overlap the place; of the own instance, whichever that is.
template <class Visit>
void WriterSearch::for_each_in(ir::Base base, uint64_t begin, uint64_t end, const Visit& visit) {
  if (base == ir::Base::kGlobal) {
    const auto ends = [&](uint32_t i, uint64_t b) { return targets_[i].begin + longest_ <= b; };
    auto at = std::lower_bound(by_place_.begin(), by_place_.end(), begin, ends);
    for (; at != by_place_.end() && targets_[*at].begin < end; ++at) {
      if (begin < targets_[*at].end) visit(*at, begin, end, false);
    }
  } else if (base == ir::Base::kSelf) {
    for (const uint32_t i : of_self_) {
      const uint64_t area = image_.instances[targets_[i].owner].data;
      if (targets_[i].begin < area + end && area + begin < targets_[i].end) {
        visit(i, area + begin, area + end, is_shared(pou_->self));
      }
    }
  }
}

template <class Visit>
void WriterSearch::for_each_in(const Origin& origin, uint64_t begin, uint64_t end,
                               const Visit& visit) {
  if (origin.kind == Kind::kPlace) return for_each_in(origin.base, begin, end, visit);
  for (const uint32_t i : inside_) {
    const uint32_t owner = targets_[i].owner;
    const ir::Instance& instance = image_.instances[owner];
    if (targets_[i].begin >= instance.data + end || instance.data + begin >= targets_[i].end) {
      continue;
    }
    bool shared = true;
    if (origin.kind == Kind::kAnyInstance) {
      if (!is_of(targets_[i], origin.type)) continue;
    } else if (origin.base == ir::Base::kGlobal) {
      if (ir::initial_id(image_, origin.slot) != owner) continue;
      shared = false;
    } else {
      const ir::Instance& parent = image_.instances[instance.parent];
      const bool holds = instance.parent != 0 && pou_->self.valid() &&
                         image_.types.is_a(parent.type, pou_->self) &&
                         ir::initial_id(image_, parent.data + origin.slot) == owner;
      if (!holds) continue;
      shared = is_shared(pou_->self);
    }
    visit(i, instance.data + begin, instance.data + end, shared);
  }
}

void WriterSearch::hit(uint32_t target, uint64_t begin, uint64_t end, How how) {
  const Target& row = targets_[target];
  const bool inside = row.begin <= begin && end <= row.end;
  if (how <= How::kShared && !inside) how = How::kPart;
  found_.push_back({target, at_.pou, at_.unit, how});
}

// A BOOL that is moved to itself becomes 0 or 1: not so what else lies there, in a union.
void WriterSearch::store(ir::Base base, uint64_t begin, ir::Class cls) {
  const uint64_t end = begin + ir::class_size(cls);
  for_each_in(base, begin, end, [&](uint32_t target, uint64_t from, uint64_t to, bool shared) {
    const bool only = cls != ir::Class::kB || is_bool(targets_[target]);
    hit(target, from, to, !only ? How::kPart : shared ? How::kShared : How::kOnly);
  });
}

void WriterSearch::store_through(const Origins& origins, ir::Region region, uint64_t offset,
                                 uint64_t size, How how) {
  // With several origins one execution writes here, another there.
  for (const Origin& origin : origins) {
    if (origin.kind >= Kind::kInOut) {
      note(AddressUse::Use::kStored, origin.kind, region, offset, size);
      continue;
    }
    const uint64_t begin = origin.exact ? origin.begin + offset : origin.begin;
    const uint64_t end = origin.exact && size != kAll ? begin + size : origin.end;
    const bool indexed = !origin.exact || origin.kind == Kind::kAnyInstance || origins.size() > 1;
    for_each_in(origin, begin, end, [&](uint32_t target, uint64_t from, uint64_t to, bool shared) {
      How use = how;
      if (how == How::kOnly && shared) use = How::kShared;
      if (indexed && how != How::kText) use = How::kIndexed;
      hit(target, from, to, use);
    });
  }
}

void WriterSearch::note(AddressUse::Use use, Kind from, ir::Region region, uint64_t offset,
                        uint64_t size) {
  unknown_.push_back({use, from, region, offset, size, at_.pou, at_.unit});
}

// The address goes into a VAR_IN_OUT.
void WriterSearch::pass(const Origins& origins, ir::Region region) {
  for (const Origin& origin : origins) {
    if (origin.kind >= Kind::kInOut) {
      note(AddressUse::Use::kPassed, origin.kind, region, 0, kAll);
      continue;
    }
    for_each_in(origin, origin.begin, origin.end,
                [&](uint32_t target, uint64_t, uint64_t, bool) { targets_[target].in_out = true; });
  }
}

// A reference is made of the address; by it the whole area can be reached.
void WriterSearch::reference(const Origins& origins, ir::Region region) {
  for (const Origin& origin : origins) {
    if (origin.kind >= Kind::kInOut) {
      note(AddressUse::Use::kReferenced, origin.kind, region, 0, kAll);
      continue;
    }
    for_each_in(origin, 0, kAll, [&](uint32_t target, uint64_t, uint64_t, bool) {
      targets_[target].referenced = true;
    });
  }
}

// A reference to a variable leads to what that holds; one to the own instance leads to all of it.
void WriterSearch::reference_place(ir::Base base, uint64_t begin) {
  const bool whole = base == ir::Base::kSelf && begin == 0;
  for_each_in(base, 0, kAll, [&](uint32_t i, uint64_t area, uint64_t, bool) {
    Target& target = targets_[i];
    const uint64_t at = area + begin;
    target.referenced |= whole || (target.member_begin <= at && at < target.member_end);
  });
}

void WriterSearch::look_at_unit(const ir::Unit& unit, const ir::Unit& more,
                                const OriginWalk& walk) {
  const Opcode op = unit.opcode();
  const ir::OpcodeRow& row = ir::opcode_row(op);
  if (row.a.kind == ir::FieldKind::kDst && unit.base_a() != ir::Base::kFrame) {
    return store(unit.base_a(), unit.a, row.a.cls);
  }
  if (op >= Opcode::STFAR_B && op <= Opcode::STFAR_F64) {
    return store(unit.base_b(), unit.bc(), row.a.cls);
  }
  if (op >= Opcode::ST_B && op <= Opcode::ST_F64) {
    return store_through(walk.of(unit.a), walk.region(unit.a), unit.c, ir::class_size(row.b.cls),
                         How::kOnly);
  }
  if (row.calls) {
    for (const OriginWalk::Argument& argument : walk.arguments()) pass(argument.origins, {});
    return;
  }
  const auto whole = [&](uint32_t slot, uint64_t size, How how) {
    store_through(walk.of(slot), walk.region(slot), 0, size, how);
  };
  switch (op) {
    case Opcode::COPY: {
      const ir::Region region = ir::region_of_field(more.x());
      return whole(unit.a, ir::region_size(image_.types, image_.layouts, region), How::kPart);
    }
    case Opcode::SCOPY:
    case Opcode::WCOPY:
      return whole(unit.a, kAll, How::kOnly);
    case Opcode::ST_REF_AT:
      return pass(walk.of(unit.b), walk.region(unit.b));
    case Opcode::NATIVE:
      if (stdlib::native_row(unit.c).result == 'v') whole(unit.a * 8u, kAll, How::kText);
      return;
    case Opcode::HANDLE:
      return reference_place(unit.base_b(), more.x());
    case Opcode::HANDLE_AT:
      return reference(walk.of(unit.b), walk.region(unit.b));
    case Opcode::HANDLE_INST:
    case Opcode::HANDLE_INST_AT: {
      Origin origin;
      const bool named = op == Opcode::HANDLE_INST;
      origin.kind = named ? Kind::kInstance : Kind::kAnyInstance;
      origin.base = unit.base_b();
      origin.slot = named ? unit.bc() : 0;
      return reference({origin}, {});
    }
    case Opcode::HANDLE_ADD:
    case Opcode::UNFLAT:
      calculates_ = true;
      return;
    default:
      return;
  }
}

void WriterSearch::look_at(uint32_t number) {
  const ir::LinkedPou& pou = image_.pous[number];
  pou_ = &pou;
  of_self_.clear();
  for (const uint32_t i : inside_) {
    if (pou.self.valid() && is_of(targets_[i], pou.self)) of_self_.push_back(i);
  }
  OriginWalk walk(image_, pou);
  const ir::Unit* const code = image_.code.data() + pou.first_unit;
  for (uint32_t i = 0; i < pou.unit_count; ++i) {
    const bool extended = ir::opcode_row(code[i].opcode()).extended;
    at_ = {number, i};
    walk.enter(i);
    look_at_unit(code[i], code[extended ? i + 1 : i], walk);
    walk.pass(i);
    if (extended) ++i;
  }
}

}  // namespace vm
