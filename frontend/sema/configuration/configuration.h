// Phase: the CONFIGURATION. Chooses the resource that is compiled, then makes its tasks and program
// instances (configuration.cc, tasks.cc). Reads the tree and what is declared; writes the program's
// tasks, instances and initial values, and adds a POU for each program with connections of its own.
#pragma once

#include "frontend/sema/phase.h"

namespace frontend {

class Configuration : public Phase {
 public:
  using Phase::Phase;

  // configuration.cc
  void choose_resource();
  void configure();

 private:
  void default_configuration();
  void configure_resource(const ResourceDecl& resource);
  std::optional<uint32_t> find_task(const Name& name);
  std::optional<uint32_t> find_program(const ProgramDecl& decl);
  void add_instance(const ProgramDecl& decl, const ResourceDecl& resource);
  void add_block_task(const BlockTask& decl, const PouInfo& info);
  ir::ConstId program_arguments(const ProgramDecl& decl, const PouInfo& info,
                                std::vector<Connection>& connections);
  void retain_program(const PouInfo& info);
  void check_once(const Name& name, const Name& other);
  uint32_t clone_program(uint32_t original, const ProgramDecl& decl);
  // tasks.cc
  void add_task(const TaskDecl& decl, const ResourceDecl& resource);
  uint32_t event_of(ExprId expr);
};

}  // namespace frontend
