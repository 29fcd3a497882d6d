// What the search for writers collects of code (writer_search.cc), and what it concludes of that
// (writers.cc).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "ir/bytecode/image.h"
#include "vm/load/origins.h"
#include "vm/load/write_targets.h"
#include "vm/load/writers.h"

namespace vm {

// A store or another use of an address from outside of its POU.
struct AddressUse {
  enum class Use : uint8_t { kStored, kPassed, kReferenced };
  Use use = Use::kStored;
  Origin::Kind from = Origin::Kind::kInOut;
  ir::Region region;  // invalid type: a string
  uint64_t offset = 0;
  uint64_t size = 0;
  uint32_t pou = 0;
  uint32_t unit = 0;
};

class WriterSearch {
  using How = Writer::How;
  using Kind = Origin::Kind;

 public:
  WriterSearch(const ir::Image& image, std::span<const Variable> variables);
  std::vector<Writer> run(const std::vector<bool>* running);
  WriteEffects effects(std::span<const uint32_t> pous);

 private:
  struct At {
    uint32_t pou = 0;
    uint32_t unit = 0;
  };
  void look_at(uint32_t pou);
  void look_at_unit(const ir::Unit& unit, const ir::Unit& more, const OriginWalk& walk);
  void store(ir::Base base, uint64_t begin, ir::Class cls);
  void store_through(const Origins& origins, ir::Region region, uint64_t offset, uint64_t size,
                     How how);
  void pass(const Origins& origins, ir::Region region);
  void reference(const Origins& origins, ir::Region region);
  void reference_place(ir::Base base, uint64_t begin);
  void hit(uint32_t target, uint64_t begin, uint64_t end, How how);
  template <class Visit>
  void for_each_in(ir::Base base, uint64_t begin, uint64_t end, const Visit& visit);
  template <class Visit>
  void for_each_in(const Origin& origin, uint64_t begin, uint64_t end, const Visit& visit);
  void note(AddressUse::Use use, Kind from, ir::Region region, uint64_t offset, uint64_t size);
  bool fits(const Target& target, const AddressUse& unknown) const;
  bool reaches(const Target& target, const AddressUse& unknown) const;
  void find_escapes(Target& target) const;
  void find_by_address(uint32_t target);
  bool is_shared(ir::TypeId self);
  bool is_bool(const Target& target) const {
    const ir::TypeId type = target.type;
    return image_.types.is_scalar(type) && image_.types.scalar(type) == ir::Scalar::kBool;
  }
  bool is_of(const Target& target, ir::TypeId type) const {
    return !type.valid() || image_.types.is_a(image_.instances[target.owner].type, type);
  }

  const ir::Image& image_;
  std::vector<Target> targets_;
  std::vector<uint32_t> by_place_;  // targets of globals
  uint64_t longest_ = 0;            // of them, in bytes
  std::vector<uint32_t> inside_;    // targets of instances
  std::vector<uint32_t> of_self_;   // those of them that the POU may run for
  std::vector<uint32_t> counts_;    // instances by type, those that extend it too
  std::vector<AddressUse> unknown_;
  std::vector<Writer> found_;
  bool calculates_ = false;  // addresses of any variable can be made of numbers
  const ir::LinkedPou* pou_ = nullptr;
  At at_;
};

}  // namespace vm
