// Pools that __NEW takes from: {attribute 'pool' := '16'} in front of a FUNCTION_BLOCK or a TYPE
// (docs/adr/0006-objects.md). Each is an array of instances in the globals and a BYTE for each of
// them; what is no block lies in one (`Name#box`, its only variable `value`), so that every
// element has an ID of its own, and a change that moves or grows a pool moves no element's handle.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "frontend/sema/phase.h"

namespace frontend {

inline constexpr uint64_t kPoolFree = 0;
inline constexpr uint64_t kPoolUsed = 1;
inline constexpr uint64_t kPoolLeaving = 2;  // inside of __DELETE

class Pools : public Phase {
 public:
  using Phase::Phase;

  // After all declarations: adds the variables, and the methods __RESET and __LEAVE to the blocks
  // that they need.
  void declare();
  // __NEW(type), __DELETE(pointer)
  Note infer_new(ExprId type);
  Note infer_delete(ExprId pointer);
  // The pool of the type that `type` names, as __NEW has it: T, or T(arguments). Reports when there
  // is none.
  const Pool* of_new(ExprId type);
  // Where an object behind a pointer to `target` may come from.
  std::vector<const Pool*> of_target(ir::TypeId target) const;
  // __RESET for every block that a variable of this type is or holds, __LEAVE where something
  // leaves.
  void add_methods(ir::TypeId type);
  // Is there anything in it that leaves by FB_Exit?
  bool leaves(ir::TypeId type);

 private:
  // Types, each looked at once: there may be many ways to one, and one that contains itself is an
  // error that does not end the look.
  using Seen = std::set<uint32_t>;
  void add_methods(ir::TypeId type, Seen& seen);
  bool leaves(ir::TypeId type, Seen& seen);
  uint32_t count_of(const Attribute& attribute);
  void add(const Name& name, ir::TypeId type, uint32_t block, bool boxed, uint32_t count);
  void add_type(const TypeDecl& decl, const Attribute& attribute);
  uint32_t add_box(const TypeDecl& decl, std::string_view name);
};

}  // namespace frontend
