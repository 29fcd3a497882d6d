// From the numbers of one program to those of another: types, members, constants and whole objects,
// by what they are called. One Translator for each program that parts come from.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/object.h"
#include "ir/program/ir.h"

namespace linker {

// Parameters of a POU by folded name, and how to find one.
struct Parameters {
  const ir::Program& program;
  ir::PouNames names;
  const ir::Pou* find(const std::string& pou) const;
};

class Translator {
 public:
  // Is what `from` calls so another thing there? Of declared types and of globals that code names.
  struct Checks {
    std::function<bool(const ir::Type&)> other_type;
    std::function<bool(const ir::Member&)> other_global;
  };

  // Borrows both. `to` grows by anonymous types and by constants, and has all declared types, if
  // not their members yet: before settle() no initial value is asked for.
  // `copied`: its constants began as those of `from`.
  Translator(const ir::Program& from, ir::Program& to, bool copied, Checks checks);

  ir::TypeId type(ir::TypeId id);
  ir::Region region(ir::Region region) { return {type(region.type), region.dim}; }
  // Number of member `number` of a type of `from` in the type that it is now; nullopt: it is gone.
  std::optional<uint32_t> member(ir::TypeId id, uint32_t number);
  // An initial value of a `type` of `from`.
  ir::ConstId constant(ir::TypeId type, ir::ConstId value);
  // A rule of the source, `{renamed from := 'old'}` (X2).
  ir::OldNameId rule(ir::OldNameId rule);
  // Without its initial value.
  ir::Member member_of(const ir::Member& member);
  // All types of `to` have their members now.
  void settle();
  ir::Object object(const ir::Object& object, const Parameters& from, const Parameters& to);

  // The first thing that has no counterpart, in words; "": everything had one.
  const std::string& problem() const { return problem_; }
  void forget_problem() { problem_.clear(); }

 private:
  void fail(std::string what) {
    if (problem_.empty()) problem_ = std::move(what);
  }
  ir::TypeId declared(ir::TypeId id);
  void ask_for_parts(const ir::Type& type);
  ir::TypeId anonymous(ir::TypeId id);
  void give_initial_values(ir::TypeId id);
  ir::Steps steps(ir::Region root, const ir::Steps& steps);
  void check_interface(const std::string& callee, const Parameters& from, const Parameters& to);
  void parameter(ir::Slot& slot, const ir::Object& object, const Parameters& from,
                 const Parameters& to);

  const ir::Program& from_;
  ir::Program& to_;
  const bool copied_;
  Checks checks_;
  std::vector<ir::TypeId> types_;  // by number in `from`; invalid: not asked yet
  std::unordered_map<std::string, ir::TypeId> declared_;         // in `to`, by folded name
  std::unordered_map<std::string, ir::TypeId> anonymous_;        // in `to`, by kind and text
  std::unordered_map<uint32_t, std::vector<uint32_t>> members_;  // by number in `from`
  std::unordered_map<uint64_t, ir::ConstId> constants_;          // by type and number in `from`
  std::vector<ir::TypeId> unsettled_;  // anonymous ones of `from` without initial values
  bool settled_ = false;
  std::string problem_;
};

}  // namespace linker
