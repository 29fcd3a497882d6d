// Handles of the evaluator: which area or exposed local they name, and back.
#pragma once

#include <map>
#include <optional>
#include <unordered_map>
#include <vector>

#include "ir/program/eval_bytes.h"
#include "ir/types/reach.h"

namespace ir {

class References {
 public:
  References(const Program& program, const Layouts& layouts)
      : program_(program), layouts_(layouts), bytes_(program.types, layouts) {}

  void add_area(Variable& root, uint32_t id, uint32_t generation, uint32_t data);

  // The handle of the place `at`; exposes its root when that is a local. `task` numbers the
  // exposures. nullopt: more locals are exposed than a machine allows (kStack).
  std::optional<uint64_t> handle_of(const Address& at, uint32_t task);
  uint64_t handle_of_instance(const Variable& instance) const;
  // The handle moved by the low 32 bits of `bytes`, with their sign.
  uint64_t move(uint64_t handle, uint64_t bytes) const;
  // Null when the handle names no whole instance.
  Variable* instance_of(uint64_t handle) const;
  // Where a `type` behind the handle is; nullopt: it traps. A string may get less than its
  // capacity when `short_string`.
  std::optional<Address> resolve(uint64_t handle, TypeId type, bool short_string) const;
  // Why resolve() found nothing; "" when there is no more to say than the kind of the trap.
  std::string why_unresolved(uint64_t handle, TypeId type, bool short_string) const;
  uint32_t flat(uint64_t handle) const;
  uint64_t unflat(uint32_t data) const;
  // The locals of that frame are gone.
  void leave(uint64_t frame);
  // "NULL", "ref", or the path of the variable.
  std::string text(uint64_t handle, TypeId target) const;

  void name_area(const Variable& root, std::string path);
  const EvalBytes& bytes() const { return bytes_; }

 private:
  struct Home {
    Variable* root = nullptr;
    uint64_t frame = 0;  // not 0: an exposed local
    uint32_t segment = 0;
    uint32_t data = 0;
    uint32_t used = 0;
    uint32_t capacity = 0;  // bytes from `data` on that are its own
    std::vector<uint32_t> slots;
    std::vector<Reach> reaches;  // of its variables; a local is one
    std::string path;
  };
  const Home* home_of(uint64_t handle) const;
  uint32_t new_segment(uint32_t task);
  // The reach of the variable that the handle was taken from; no bytes: it is lost.
  static Reach reach_in(const Home& home, uint64_t handle);
  uint32_t room_for_string(const Home& home, Reach reach, uint32_t offset) const;
  static bool touches_slot(const Home& home, uint64_t begin, uint64_t end);
  std::optional<Address> resolve_instance(const Home& home, uint64_t handle, TypeId type) const;

  const Program& program_;
  const Layouts& layouts_;
  EvalBytes bytes_;
  std::map<uint32_t, Home> areas_;  // by segment
  std::unordered_map<const Variable*, uint32_t> segment_of_;
  std::vector<Home> exposed_;
  std::unordered_map<uint32_t, uint32_t> exposures_;  // by task: how many so far
  uint32_t next_data_ = 0;
};

}  // namespace ir
