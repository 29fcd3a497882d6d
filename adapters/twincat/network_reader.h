// One network of a ladder or function block diagram of TwinCAT (<NWL>): its trees -> elements and
// links. networks_power.cc has what of a ladder carries power: series and branches of contacts.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "adapters/twincat/archive.h"
#include "base/name_case.h"
#include "frontend/network/network.h"

namespace twincat {

namespace network = frontend::network;
using network::Kind;
using network::Link;
using network::Modifier;
using xml::Node;

// The output of a box that leads on: the one without an entry. nullopt: it cannot be told.
std::optional<uint32_t> leading_output(Node box);

// What arrives at a pin. No links: nothing does.
struct Wire {
  std::vector<Link> from;
  Modifier modifier = Modifier::kNone;
};

Modifier modifier_of(uint32_t flags);

inline bool is_bool(std::string_view type) {
  return type.empty() || base::same_name(type, "BOOL") || base::same_name(type, "BIT");
}

class NetworkReader {
 public:
  NetworkReader(bool ladder, const std::string& what, xml::Reporter& report)
      : ladder_(ladder), what_(what), report_(report) {}

  network::Network run(Node network);
  bool failed() const { return failed_; }

 private:
  void fail(Node at, const std::string& text, const std::string& fix = {});
  uint32_t marks(Node owner, uint32_t known, const char* what);
  network::Text operand(Node owner, const char* what);
  uint32_t push(network::Element element);
  void connect(network::Input& input, Wire wire, Node at);

  static std::vector<Link> rail() { return {{0, 0}}; }
  Wire value(const Item& item);
  Wire demux(const Item& item);
  Wire read_once(Wire wire, Node at);
  Wire assign(const Item& item, bool leads_on);
  void end(Node target, uint32_t flags, const Wire& wire, bool power);

  // --- networks_box.cc
  Wire box(const Item& item, bool leads_on);
  void box_inputs(const Item& item, network::Element& block);
  Modifier pin_mark(const Item& box, const std::vector<Item>& marks, size_t pin, bool connected);
  void box_outputs(const Item& item, uint32_t block);
  std::string name_of(Node box) const;

  // --- ladder: what power goes through
  bool is_logic(const Item& item) const;
  bool carries_power(const Item& item) const;
  Wire powered(const Item& item) { return {power(item, rail())}; }
  std::vector<Link> power(const Item& item, std::vector<Link> from);
  void check_parallel(const Item& item, const std::vector<Item>& trees);
  std::vector<Link> branches(const std::vector<Item>& trees, const std::vector<Link>& from);
  std::vector<Link> contact(const Item& item, std::vector<Link> from);
  std::vector<Link> contact(network::Text operand, Modifier modifier, std::vector<Link> from,
                            Node at);
  std::string compared(const Item& item) const;
  std::vector<Link> both(std::vector<Link> from, Wire wire, Node at);

  bool ladder_;
  std::vector<Link> feed_ = rail();  // or what feeds the ways that are read: the rail in them
  const std::string& what_;
  xml::Reporter& report_;
  bool failed_ = false;
  size_t links_ = 0;
  network::Network out_;
  std::map<std::string, Wire> wires_;  // by VarId
};

}  // namespace twincat
