// Inside of the parser: bodies in ladder and FBD. Their readers make networks (network/network.h);
// here statements are made of them, element by element in the order of execution. Power that
// arrives anywhere is a kResult, as in instruction lists: a value without a variable. What an edge
// remembers is a variable of the POU, `operand#rising#target`, found again by name in an online
// change. Everything here is syntax: types are sema's.
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "frontend/network/network.h"
#include "frontend/parse/parser.h"

namespace frontend {

class Parser::Diagram {
 public:
  Diagram(Parser& parser, PouDecl& pou) : p_(parser), tree_(parser.tree_), pou_(pou) {}
  void run(const network::Body& body);  // adds statements, and variables to the POU
  // Where the parser reads an expression with wires: what a wire carries, when its name or that of
  // its ENO begins there; its tokens are taken then. Else invalid.
  ExprId wire_value();

 private:
  using Element = network::Element;
  struct Value {
    ExprId expr;         // invalid: not connected
    bool power = false;  // connected with the left rail: TRUE
  };
  struct Output {
    uint32_t uses = 0;
    uint32_t user = 0;   // an element that uses it
    bool power = false;  // somebody uses it as power, so it is BOOL
    ExprId kept;         // a kResult; invalid: read from the instance, or not made yet
  };

  // --- diagram.cc
  void check_wires(const network::Body& body);
  void network(const network::Network& network);
  void count_uses();
  void element(uint32_t number);
  void contact(uint32_t number, const Element& element);
  void coil(uint32_t number, const Element& element);
  void sink(const Element& element);
  void assign(const Element& element, ExprId value, network::Modifier modifier);
  void jump(const Element& element);
  Value input(const network::Input& input);
  Value linked(const network::Input& input);
  ExprId output(network::Link link, base::SourceSpan span);
  ExprId expression(const Element& source);
  ExprId edge(ExprId value, network::Modifier modifier, const std::string& of,
              base::SourceSpan span);
  Name memory(const std::string& of, network::Modifier modifier, base::SourceSpan span);
  ExprId enabled_by(const Element& element) const;

  // --- diagram_block.cc
  void block(uint32_t number, const Element& element);
  ExprId callee(const Element& element);
  Range32 arguments(uint32_t number, const Element& element, Value* enable);
  void add_eno(uint32_t number, const Element& element);
  void add_outputs(uint32_t number, const Element& element);
  void add_power(uint32_t number, uint32_t output);
  bool is_right_below(uint32_t box, const Element& sink) const;
  const Element* only_sink(network::Link link) const;
  bool takes_power(const Element& element, const network::Input& input) const;
  bool is_result(const Element& element, uint32_t output) const;

  // --- expressions and statements
  // `quiet`: what is wrong is said in another place.
  ExprId parse(const network::Text& text, bool quiet = false);
  ExprId boolean(bool value, base::SourceSpan span);
  ExprId name(const Name& name);
  ExprId binary(BinaryOp op, ExprId left, ExprId right, base::SourceSpan span);
  ExprId member(ExprId operand, const std::string& name, base::SourceSpan span);
  ExprId keep(ExprId value, base::SourceSpan span);
  ExprId new_result(ExprId value, base::SourceSpan span);
  void emit(Stmt stmt, base::SourceSpan span);
  void emit_assign(ExprId target, ExprId value, AssignOp op, base::SourceSpan span);
  void emit_if(ExprId condition, const Stmt& then, base::SourceSpan span);
  std::string_view made(std::string text);

  Parser& p_;
  Tree& tree_;
  PouDecl& pou_;
  const network::Network* network_ = nullptr;
  base::SourceSpan here_;          // the element that is made
  uint32_t number_ = 0;            // the same, by number
  std::vector<uint32_t> targets_;  // by element: the first after it that writes or calls
  bool ladder_ = false;
  std::vector<uint32_t> next_box_;  // blocks: the next one of the same instance in the network
  std::vector<std::vector<Output>> outputs_;                            // by element and output
  std::map<std::vector<std::pair<uint32_t, uint32_t>>, ExprId> joins_;  // several links, kept
  std::vector<ExprId> conditions_;                      // by element: when its outputs are stored
  std::vector<bool> done_;                              // sinks that a call has written
  std::unordered_map<std::string, uint32_t> memories_;  // folded names
  std::unordered_map<std::string, ExprId> wires_;       // of the expression that is read
  VarBlock kept_;                                       // what edges remember
};

}  // namespace frontend
