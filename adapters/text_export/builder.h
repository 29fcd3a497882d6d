// One network of an export: its trees -> elements and links. networks_ladder.cc has what of a
// ladder carries power: series and branches of contacts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/text_export/networks.h"
#include "adapters/text_export/tree.h"

namespace text_export {

namespace network = frontend::network;
using network::Element;
using network::Link;
using network::Modifier;
using Code = base::DiagnosticCode;

// What arrives at a pin. No links: nothing does.
struct Wire {
  std::vector<Link> from;
  bool negated = false;
};

inline Modifier negation(bool negated) { return negated ? Modifier::kNegated : Modifier::kNone; }

class Builder {
 public:
  // `links`: pairs that the wires of this export have connected so far.
  Builder(const PinNames& pins, const Report& report, const std::string& what, size_t& links)
      : pins_(pins), report_(report), what_(what), links_(links) {}

  network::Network run(const DrawnNetwork& drawn, bool ladder, uint32_t number);
  bool failed() const { return failed_; }

 private:
  void fail(uint32_t at, const std::string& text, const std::string& fix = {});
  uint32_t push(Element element);
  void connect(network::Input& input, Wire wire, uint32_t at);
  network::Text operand(std::string_view text, uint32_t at, const char* what);
  static std::vector<Link> rail() { return {{0, 0}}; }

  Wire value(const Tree& tree);
  Wire source(const Tree& tree);
  Wire assign(const Tree& tree);
  // `power`: what arrives at EN. `leads_on`: its value goes somewhere.
  Wire box(const Tree& tree, const std::vector<Link>& power, bool leads_on);
  void inputs(const Tree& tree, const Pins* pins, Element& block);
  void outputs(const Tree& tree, const Pins* pins, uint32_t block);
  void end(const End& target, Wire wire, bool power);
  Wire read_once(Wire wire, uint32_t at);

  void rung(const DrawnNetwork& drawn);
  std::vector<Link> power(const Tree& tree, std::vector<Link> from);
  std::vector<Link> branches(const Tree& tree, const std::vector<Link>& from);
  std::vector<Link> both(std::vector<Link> from, Wire wire, uint32_t at);

  const PinNames& pins_;
  const Report& report_;
  const std::string& what_;
  uint32_t number_ = 0;
  bool has_rail_ = false;
  bool failed_ = false;
  size_t& links_;
  network::Network out_;
};

}  // namespace text_export
