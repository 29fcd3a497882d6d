// Inside of to_iec10(): elements of PLCopen XML, as the export writes them, -> IEC 61131-10.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/plcopen/iec10.h"

namespace plcopen {

using xml::Node;

class Iec10Writer {
 public:
  Unsaid problems;

  void project(Node from, Node to);

 private:
  void problem(Node at, const std::string& text) {
    ++count_;
    std::string name(xml::attribute(at, "name"));
    problems[owner_].push_back(name.empty() || name == owner_ ? text : "`" + name + "`: " + text);
  }
  static void set(Node to, const char* name, std::string_view value) {
    to.append_attribute(name) = std::string(value).c_str();
  }
  static void copy(Node to, const char* name, Node from, const char* attribute) {
    std::string_view value = xml::attribute(from, attribute);
    if (!value.empty()) set(to, name, value);
  }
  static Node text(Node to, const char* name, const std::string& value) {
    Node out = to.append_child(name);
    out.append_child(pugi::node_pcdata).set_value(value.c_str());
    return out;
  }
  void documentation(Node to, Node from);
  // addData that nothing else takes. `to` is complete.
  void other_data(Node to, Node from);
  void type(Node to, Node from);
  void array(Node to, Node from);
  void specification(Node to, Node from);
  void enumeration(Node to, Node from);
  void value(Node to, Node from);
  void variable(Node to, Node from, uint32_t order);
  void list(Node to, const char* name, Node from, uint32_t order);
  void pou(Node to, Node from, const char* element);
  void members(Node to, Node from, bool program);
  void bases(Node to, Node interface);
  void body(Node to, const char* name, Node from);
  void diagram(Node to, Node from, bool ladder);
  void object(Node to, Node from);
  void block(Node to, Node from);
  void connection_in(Node to, Node from);
  void connection_out(Node to, Node from, const std::string& pin);
  void resource(Node to, Node from);

  uint32_t count_ = 0;                    // of problems
  std::string owner_;                     // the POU or type that is written
  std::map<std::string, uint32_t> pins_;  // connectionPointOutId by "localId|formalParameter"
};

}  // namespace plcopen
