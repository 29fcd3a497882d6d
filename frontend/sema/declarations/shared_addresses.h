// Variables and bare addresses at %M and %Q that overlap share bytes. Each group of them becomes
// one hidden global (ir/types/shared_bytes.h), and what the sources declare are views of it:
// Variable::view, AddressView. Variables that have one address and one type are one global with
// several names. What lies alone stays what it was.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "frontend/sema/phase.h"
#include "ir/types/layout.h"

namespace frontend {

class SharedAddresses : public Phase {
 public:
  using Phase::Phase;

  // When types are resolved, and no variable is yet. Reports what cannot share bytes (E2014).
  void find();
  // After all bodies: what VAR_CONFIG places lies in an instance, and shares no bytes.
  void check() const;

 private:
  struct Place {
    Located located;  // name: of the variable with its list or program, or the address
    VarId variable;   // invalid: a bare address
    uint64_t bits = 0;
    uint64_t end() const { return located.address.bit_offset + bits; }
  };
  using Group = std::vector<Place>;

  void check_instances() const;
  void check_inputs_in_tests(const std::vector<Located>& all) const;
  void report_configured(const Located& one, const Located& other) const;
  void collect_variables();
  void collect_direct();
  uint64_t bits_of(ir::TypeId type, const ir::DirectAddress& address);
  bool is_of_program(const Place& place) const;
  bool has_several_instances(const Place& place) const;
  void share(const Group& group);
  bool check(const Group& group, bool one_place);
  std::string why_not(const Place& place, bool one_place) const;
  std::string why_not_type(ir::TypeId type) const;
  bool check_initial(const Group& group);
  void report(const Place& place, const Group& group, const std::string& why);
  void make_one(const Group& group);
  void make_structure(const Group& group);
  ir::ConstId initial_of(const Group& group, const Place& place) const;
  uint32_t add_global(const Group& group, ir::Type type, uint32_t begin);
  void leave(const Group& group);
  void number_again();
  std::string path_of(const Variable& variable) const;

  std::vector<Place> places_;
  std::optional<ir::Layouts> natural_;
  std::map<uint32_t, bool> programs_;  // by POU: a variable of it left
};

// Where a bare address shares bytes; null: it is a global by itself.
const AddressView* direct_view(const Phase& phase, const Expr& expr);

}  // namespace frontend
