// The code of __START (sema/objects/start.cc): FB_Init of every new instance, inner ones first,
// with the arguments that its declaration gives; FB_Exit of those that leave, FB_Reinit of those
// whose type a change has changed. Which is which, their stamps say (ir/types/stamps.h). start.cc
// visits the instances, construction.cc has what is done with one.
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "frontend/lower/arguments.h"
#include "frontend/lower/body_phase.h"

namespace frontend {

class StartCode : public BodyPhase {
 public:
  using BodyPhase::BodyPhase;

  void run();
  // A variable that is made anew at each call, when it has its initial values.
  void begin(VarId id);
  // Gives the references inside of `at` their values, where `init` says that they are unbound.
  void bind_references(const ir::Place& at, ir::TypeId type, ir::ConstId init);

  // FB_Init of a new instance and of those in it, with these arguments, after its references.
  void construct(const ir::Place& at, ir::TypeId type, Range32 args, base::SourceSpan span);
  // What a change does with an instance that has been made.
  void visit(const ir::Place& at, ir::TypeId type) { instance(at, type, {}, {}, false); }
  // Has the instance at `at` not been made yet? Its block has a stamp.
  ir::ValueId is_new(const ir::Place& at, const PouInfo& block) const;
  // FB_Exit, if the block has one; with CODESYS and TwinCAT those of its bases too.
  void exit(const ir::Place& at, const PouInfo& block);
  void when(ir::ValueId condition, const std::function<void()>& then);
  // With what `init` gives each element.
  using PerValue = std::function<void(const ir::Place&, ir::ConstId)>;
  void each_element(const ir::Place& at, ir::TypeId array, ir::ConstId init, const PerValue& each);
  // Element number `flat`, counted from 0 through all dimensions.
  static ir::Place element(const ir::Place& at, const ir::Type& array, uint64_t flat);

 private:
  // How a declaration has it: the type with arguments, and the values that come after FB_Init.
  struct Written {
    const Spec* spec = nullptr;
    ir::ConstId values = {};
  };
  void references(const std::vector<VarId>& variables);
  void bind_reference(const ir::Place& at, uint64_t unbound);
  void variable(VarId id);
  void visit(VarId id);
  void content(const ir::Place& at, ir::TypeId type, Written written);
  void elements(const ir::Place& at, ir::TypeId type, Written written);
  using PerElement = std::function<void(const ir::Place&)>;
  void loop(const ir::Place& at, const std::vector<ir::Dimension>& dims, size_t number,
            ir::TypeId element, const PerElement& each);
  void instance(const ir::Place& at, ir::TypeId type, Range32 args, ir::ConstId values,
                bool new_ones = true);
  ir::Place stamp_place(const ir::Place& at, const PouInfo& block) const;
  void start_members(const ir::Place& at, const PouInfo& block);
  std::vector<const PouInfo*> codes_of(const PouInfo& block, std::string_view name) const;
  void initialize(const ir::Place& at, const PouInfo& block, Range32 args);
  void call_after(const ir::Place& at, const PouInfo& block);
  void call(const ir::Place& at, const PouInfo& method);
  void call(const ir::Place& at, const PouInfo& method, const Expr& written,
            std::vector<Binding>& bindings);
  bool bind(const Expr& call, const PouInfo& method, std::vector<Binding>& bindings);
  bool bind_base(const PouInfo& method, const PouInfo& block, const std::vector<Binding>& given,
                 std::vector<Binding>& bindings);
  const Variable* find_missing(const PouInfo& method, const std::vector<Binding>& bindings) const;
  bool check_all_given(const PouInfo& method, const std::vector<Binding>& bindings);
  std::vector<VarId> parameters_of(const PouInfo& method) const;
  std::string method_text(const PouInfo& method) const;
  ir::ValueId number(uint32_t value) { return build_.constant(ir::Scalar::kU32, value); }

  base::SourceSpan span_;  // of the variable that is constructed
};

}  // namespace frontend
