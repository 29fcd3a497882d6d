// What the programs of one RESOURCE have in common: with each other %Q, with the programs of other
// RESOURCEs the globals that are declared outside all of them, and %Q. After all bodies.
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/sema/phase.h"
#include "ir/program/ir.h"
#include "ir/types/layout.h"

namespace frontend {

struct CommonGlobal {
  std::string name;
  std::string type;  // as people read it
  base::SourceSpan declared;
  bool plain = false;    // it can be exchanged
  bool written = false;  // by the resource's code, at `at`; or its address is taken there
  base::SourceSpan at = {};
};

struct ResourceUses {
  std::string resource;
  std::map<uint32_t, CommonGlobal> globals;      // that its code names; by member of the globals
  std::map<uint32_t, base::SourceSpan> outputs;  // bytes of %Q that it writes, and where
  std::vector<bool> other_code;                  // by PouId: only other resources can reach it
};

class CommonUses : public Phase {
 public:
  using Phase::Phase;

  // Each byte of %Q has one writer among the tasks (E5003).
  void check_output_tasks();
  // Each global has one coil among the ladders of the programs (W0035; second_coils.cc).
  void check_second_coils();
  // Instances that each call makes anew: no two calls meet (E2016; declarations/call_instances.cc).
  void check_call_instances();
  // The uses of the resource that is compiled; nothing where there is only one. Marks the globals
  // that are exchanged (ir::Program::shared), and leaves overrides out that only others can reach.
  ResourceUses of_resource();
  // Is the variable declared outside every RESOURCE of several, and not a constant?
  bool is_outer(VarId global) const;

 private:
  void check_call_instances(const std::vector<ir::TypeId>& starts, uint32_t task,
                            std::map<uint32_t, uint32_t>& task_of);
  std::vector<bool> leads_to_circle() const;  // by POU: can its calls come to one who calls itself?
  bool calls_itself(uint32_t pou) const;
  void report_call_instance(const PouInfo& info, const std::string& why, const char* help) const;
  // The bodies of these types, and everything that they can reach through calls.
  std::vector<uint32_t> reached_from(const std::vector<ir::TypeId>& starts) const;
  std::vector<bool> other_code() const;
  void check_instance_outputs(const ir::ProgramInstance& instance, const ir::Layouts& natural,
                              std::unordered_map<uint32_t, uint32_t>& owner);
  void add_outputs(const std::vector<OutputWrite>& writes, const ir::Layouts& natural,
                   ResourceUses& out) const;
};

// One writer for each global and each output (E5010, E5003); W0014 for what is not exchanged.
void check_resources(const std::vector<ResourceUses>& resources, base::Diagnostics& diagnostics);

}  // namespace frontend
