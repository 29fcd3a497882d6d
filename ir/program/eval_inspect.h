// Variables of the evaluator by path, and its whole state as text: evaluate.h's questions.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/program/eval_references.h"

namespace ir {

class EvalInspector {
 public:
  // Borrows everything; `instances` is parallel to Program::instances.
  EvalInspector(const Program& program, const Layouts& layouts, const References& references,
                Variable& globals, std::vector<Variable>& instances)
      : program_(program),
        layouts_(layouts),
        references_(references),
        globals_(globals),
        instances_(instances) {}

  base::Result<Address> find_value(std::string_view path) const;  // of any type
  base::Result<Address> find_scalar(std::string_view path) const;
  base::Result<Address> find_string(std::string_view path) const;
  std::string text_of(const Address& at) const;  // of a string, up to its NUL
  uint64_t bits_of(const Address& at) const;
  std::string state() const;

 private:
  Address whole(Variable& variable) const;
  Address part_of(const Address& at, size_t number) const;
  static bool is_slot(const Address& at);
  std::optional<Address> find_first(std::string_view name) const;
  std::optional<Address> find_member(const Address& at, std::string_view name) const;
  std::optional<Address> find_element(const Address& at, std::string_view& rest) const;
  std::optional<Address> find_dotted(std::string_view path, size_t& end) const;
  std::optional<Address> find(std::string_view path) const;
  std::string leaf_text(const Address& at) const;
  void append_state(const std::string& path, const Address& at, std::string& out) const;

  const Program& program_;
  const Layouts& layouts_;
  const References& references_;
  Variable& globals_;
  std::vector<Variable>& instances_;
};

}  // namespace ir
