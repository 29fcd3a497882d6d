// Inside of from_iec10(): elements of IEC 61131-10 -> elements of PLCopen XML.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "adapters/plcopen/iec10.h"

namespace plcopen {

using xml::Code;
using xml::Node;

class Iec10Reader {
 public:
  Iec10Reader(Converted& out, xml::Reporter& report) : out_(out), report_(report) {}
  void project(Node from);

 private:
  // --- iec10.cc
  static std::string_view kind_of(Node node);  // xsi:type, without its prefix
  Node made(Node parent, const char* name, Node from);
  static void copy(Node to, const char* name, Node from, const char* attribute);
  void unknown(Node node, const std::string& what);
  void common(Node to, Node from);
  void type(Node to, Node from);
  void specification(Node to, Node from);
  void value(Node to, Node from);
  void variable(Node list, Node from);
  void list(Node to, const char* name, Node from, const std::vector<Node>& variables);
  void parameters(Node to, Node from);
  void interface(Node to, Node from);
  Node data(Node owner, const char* name, const char* element, Node from);
  void pou(Node to, Node from, const char* type);
  void members(Node out, Node from);
  void contents(Node from, Node types, Node pous, Node others);
  void resource(Node to, Node from);

  // --- iec10_body.cc
  struct Pin {
    uint32_t element = 0;
    std::string name;
  };
  void body(Node to, Node from);
  void measure(Node from);
  void find_orders(Node network);
  void find_pins(Node network);
  void object(Node to, Node from);
  void block(Node out, Node from);
  void pin(Node list, Node from);
  void place(Node out, Node from);
  void connect(Node out, Node from, Node body);
  void feedback(Node point, Node from, Node body);

  Converted& out_;
  xml::Reporter& report_;
  uint32_t ids_ = 0;                        // local ids of the body
  uint32_t network_ = 0;                    // of the body
  uint32_t order_ = 0;                      // of the last element with one, in the body
  double height_ = 1;                       // of each network of the body
  double scale_ = 1;                        // of places in them
  std::map<std::string, Pin> pins_;         // of the network, by connectionPointOutId
  std::map<const void*, uint32_t> id_of_;   // local id of each object of the network
  std::map<const void*, uint32_t> orders_;  // in the body, of those objects that have one
};

}  // namespace plcopen
