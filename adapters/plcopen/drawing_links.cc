// Connections of a drawing -> links; elements -> networks in the order of execution.
#include <algorithm>
#include <set>

#include "adapters/plcopen/drawing.h"
#include "base/limits.h"
#include "base/name_case.h"

namespace plcopen {

using network::Element;
using network::Kind;
using network::Link;
using network::Modifier;

namespace {

constexpr size_t kMaxConnectors = 100;  // that lead from one to the other

}  // namespace

bool Drawing::connect() {
  for (size_t i = 0; i < pending_.size(); ++i) {
    const Pending pending = pending_[i];
    connect(pending);
  }
  pending_.clear();
  if (!failed_) store();
  return !failed_;
}

// Outputs that set or reset: the variables behind them do, where they do nothing else.
void Drawing::store() {
  if (stored_.empty()) return;
  for (Element& element : all_.elements) {
    for (network::Input& input : element.inputs) {
      for (Link link : input.from) {
        auto found = stored_.find({link.element, link.output});
        if (found == stored_.end()) continue;
        const bool takes = element.kind == Kind::kSink || element.kind == Kind::kCoil;
        if (takes && input.from.size() == 1 && input.modifier == Modifier::kNone &&
            element.modifier == Modifier::kNone) {
          element.modifier = found->second.modifier;
        } else {
          fail(Code::kXmlBody, found->second.pin,
               "an output sets or resets something else than a plain variable",
               "connect it to a coil or <outVariable>, and read that variable");
        }
      }
    }
  }
}

void Drawing::connect(const Pending& pending) {
  std::vector<Link> links;
  Modifier edge = Modifier::kNone;
  const size_t known = all_.elements.size();
  if (pending.point) append_links(pending.point, links, &edge);
  for (size_t i = known; i < all_.elements.size(); ++i) {  // made of what stands at the pin
    all_.elements[i].position = all_.elements[pending.element].position;
  }
  if (links.empty() && pending.required && !failed_) {
    fail(Code::kDanglingConnection, pending.point,
         "nothing is connected to " + xml::shown(xml::is(pending.point, "connectionPointIn")
                                                     ? pending.point.parent()
                                                     : pending.point));
  }
  const Element& element = all_.elements[pending.element];
  const bool wire = element.kind == Kind::kContact || element.kind == Kind::kCoil ||
                    element.kind == Kind::kRightRail;
  if (links.size() > 1 && !wire && !ladder_) {
    const std::string_view own = xml::attribute(pending.point, "formalParameter");
    const std::string pin(own.empty() ? xml::attribute(pending.point.parent(), "formalParameter")
                                      : own);
    fail(Code::kTwoDrivers, pending.point,
         "several connections lead to " +
             (pin.empty() ? std::string("one input") : "the input `" + pin + "`"),
         "make a block OR of them");
  }
  if (links.empty() && element.kind == Kind::kSink && !failed_) {
    return ignore(pending.element);
  }
  network::Input& input = all_.elements[pending.element].inputs[pending.input];
  if (edge != Modifier::kNone) {
    if (links.size() != 1 || input.modifier != Modifier::kNone) {
      fail(Code::kXmlBody, pending.point, "an edge of a variable meets another modifier here",
           "use a block R_TRIG or F_TRIG");
    }
    input.modifier = edge;
  }
  input.from.insert(input.from.end(), links.begin(), links.end());
}

// A variable that nothing is connected to keeps its value: rails do nothing, and go nowhere.
void Drawing::ignore(uint32_t sink) {
  Element& element = all_.elements[sink];
  report_.add(
      Code::kXmlNotUnderstood, nodes_[sink],
      "nothing is connected to `" + element.operand.text + "`, so nothing is written to it");
  element.kind = Kind::kRightRail;
  element.operand = {};
  element.modifier = Modifier::kNone;
  element.inputs[0].modifier = Modifier::kNone;
}

std::vector<Link> Drawing::links_of(Node point) {
  std::vector<Link> out;
  Modifier edge = Modifier::kNone;
  append_links(point, out, &edge);
  if (edge != Modifier::kNone) fail(Code::kXmlBody, point, "an edge cannot stand here");
  for (Link link : out) {
    if (stored_.count({link.element, link.output}) == 0) continue;
    fail(Code::kXmlBody, point, "an output that sets or resets is no condition");
  }
  return out;
}

void Drawing::append_links(Node point, std::vector<Link>& out, Modifier* edge) {
  const bool fresh = followed_.insert(point.internal_object()).second;
  if (!fresh || followed_.size() > kMaxConnectors) {
    return fail(Code::kLoopWithoutVariable, point,
                fresh ? "too many connectors lead to each other" : "connectors lead in a circle");
  }
  for (Node node : point) {
    if (node.type() == pugi::node_element && !count_link(point)) break;
    if (xml::is(node, "connection")) append_link(node, out, edge);
    if (!xml::is(node, "expression")) continue;
    Element source;  // TC6 lets an expression stand at the pin
    source.kind = Kind::kSource;
    source.operand.text = expression(node);
    source.outputs.resize(1);
    if (!source.operand.empty()) out.push_back({push(std::move(source)), 0});
  }
  followed_.erase(point.internal_object());
}

// False, after one report: there are too many.
bool Drawing::count_link(Node at) {
  if (++links_ <= base::kMaxLinks) return true;
  if (links_ == base::kMaxLinks + 1) {
    fail(Code::kXmlLimit, at,
         "the connections of this body connect more than " + std::to_string(base::kMaxLinks) +
             " pairs of elements",
         "give what a connector carries to a variable");
  }
  return false;
}

void Drawing::append_link(Node connection, std::vector<Link>& out, Modifier* edge) {
  std::string_view id = xml::attribute(connection, "refLocalId");
  auto found = by_id_.find(id_of(id));
  if (found == by_id_.end()) {
    return fail(Code::kDanglingConnection, connection,
                "a connection leads to localId `" + std::string(id) +
                    "`, which is no element of this body");
  }
  Raw& raw = raws_[found->second];
  if (raw.what == What::kOpen) return;
  if (raw.what == What::kContinuation) {
    const std::string name(xml::attribute(raw.node, "name"));
    auto connector = connectors_.find(base::fold_name(name));
    if (connector != connectors_.end()) {
      Node point = xml::child(raws_[connector->second].node, "connectionPointIn");
      if (point) return append_links(point, out, edge);
    }
    return fail(Code::kDanglingConnection, raw.node,
                "there is no connector `" + name + "`, or nothing is connected to it");
  }
  if (raw.what == What::kConnector) {
    return fail(Code::kDanglingConnection, connection,
                "a connection leads to a connector instead of its continuation");
  }
  if (raw.edge != Modifier::kNone) *edge = raw.edge;
  if (all_.elements[raw.element].kind == Kind::kBlock) {
    if (link_block(raw, connection, out)) return;
  } else if (!all_.elements[raw.element].outputs.empty()) {
    out.push_back({raw.element, 0});
    return;
  }
  fail(Code::kDanglingConnection, connection,
       xml::shown(raw.node) + " has no output `" +
           std::string(xml::attribute(connection, "formalParameter")) + "`");
}

// By the name of the output. The only output needs none.
bool Drawing::link_block(Raw& raw, Node connection, std::vector<Link>& out) {
  std::string_view name = xml::attribute(connection, "formalParameter");
  const std::vector<network::Output>& outputs = all_.elements[raw.element].outputs;
  for (uint32_t i = 0; i < outputs.size(); ++i) {
    if (!base::same_name(outputs[i].name, name)) continue;
    out.push_back({raw.element, i});
    return true;
  }
  for (Passed& passed : raw.passed) {
    if (!base::same_name(passed.name, name)) continue;
    const uint32_t source = read_back(raw, passed);
    if (source != kNone) out.push_back({source, 0});
    return true;
  }
  if (!name.empty() || outputs.size() != 1) return false;
  out.push_back({raw.element, 0});
  return true;
}

// The variable that was given to an in-out parameter, read after the block.
uint32_t Drawing::read_back(Raw& raw, Passed& passed) {
  if (passed.source != kNone) return passed.source;
  std::vector<Link> links;
  Modifier edge = Modifier::kNone;
  const uint32_t block = raw.element;
  const Node node = raw.node;
  if (passed.point) append_links(passed.point, links, &edge);
  if (links.size() != 1 || all_.elements[links[0].element].kind != Kind::kSource) {
    fail(Code::kXmlBody, node,
         "the in-out parameter `" + passed.name + "` of " + xml::shown(node) +
             " goes on, but no variable is connected to it");
    return kNone;
  }
  Element source = all_.elements[links[0].element];
  source.position = all_.elements[block].position;
  passed.source = push(std::move(source));
  precedences_.push_back({block, passed.source});
  return passed.source;
}

// Where the drawing has no places, the document's order tells.
void Drawing::forget_places() {
  if (all_.elements.empty()) return;
  auto place = [](const network::Position& at) { return std::pair(at.x, at.y); };
  const bool drawn = std::any_of(all_.elements.begin(), all_.elements.end(), [&](const Element& e) {
    return place(e.position) != place(all_.elements.front().position);
  });
  if (drawn) return;
  for (Element& element : all_.elements) {
    element.position = {0, static_cast<int32_t>(2 * (&element - all_.elements.data()) + 1), 0, 0,
                        false};
  }
  // What is no element stands in front of the next one.
  for (Remark& remark : remarks_) {
    remark.y = static_cast<int32_t>(2 * remark.before);
  }
}

static const std::string& name_of(const Element& element) {
  return element.kind == Kind::kBlock ? element.type.text : element.operand.text;
}

std::string Drawing::loop_text(const network::Network& part,
                               const std::vector<uint32_t>& loop) const {
  std::string out;
  size_t shown = 0;
  for (uint32_t number : loop) {
    const Element& element = part.elements[number];
    if (element.kind != Kind::kBlock && element.kind != Kind::kContact) continue;
    if (++shown > 5) return out + " ...";
    out += (out.empty() ? "`" : ", `") + name_of(element) + "`";
  }
  return out;
}

// Is that the loop: an order that is given, against the flow of data? Then it is no longer.
bool Drawing::follow_data(network::Network& part,
                          const std::vector<network::Precedence>& precedences, Node node) {
  const network::Network said = part;
  const auto pairs = network::follow_data(part, precedences);
  for (size_t i = 0; i < pairs.size() && i < 5; ++i) {
    const Element& read = said.elements[pairs[i].first];
    const Element& reader = said.elements[pairs[i].second];
    report_.add(Code::kXmlOrder, node,
                "`" + name_of(reader) + "` (executionOrderId " + std::to_string(reader.order) +
                    ") reads `" + name_of(read) + "` (executionOrderId " +
                    std::to_string(read.order) + "), and is executed behind it here");
  }
  return !pairs.empty();
}

namespace {

// By element, those that read it.
std::vector<std::vector<uint32_t>> readers_of(const network::Network& network) {
  std::vector<std::vector<uint32_t>> readers(network.elements.size());
  for (uint32_t reader = 0; reader < network.elements.size(); ++reader) {
    for (const network::Input& input : network.elements[reader].inputs) {
      for (const network::Link& link : input.from) {
        if (link.element < readers.size()) readers[link.element].push_back(reader);
      }
    }
  }
  return readers;
}

// A variable that is read and written in one place is read after it, unless what it reads goes
// through the place itself: then it keeps its value until the next scan. Gives a loop that is left.
std::vector<uint32_t> ordered(network::Network& network,
                              std::vector<network::Precedence> precedences) {
  constexpr int kMostLoops = 100;  // each costs as much as the network is large
  std::vector<uint32_t> loop = network::order(network, precedences);
  std::vector<std::vector<uint32_t>> readers;
  for (int i = 0; i < kMostLoops && !loop.empty(); ++i) {
    const std::set<uint32_t> in_loop(loop.begin(), loop.end());
    if (readers.empty()) readers = readers_of(network);
    std::vector<network::Precedence> later;
    const size_t gone = std::erase_if(precedences, [&](const network::Precedence& each) {
      const bool inside = in_loop.count(each.first) != 0 && in_loop.count(each.second) != 0;
      if (!inside || network.elements[each.second].kind != Kind::kSource) return inside;
      for (const uint32_t reader : readers[each.second]) {  // outside of the loop: once written
        if (in_loop.count(reader) == 0) later.push_back({each.first, reader});
      }
      return inside;
    });
    if (gone == 0) break;
    precedences.insert(precedences.end(), later.begin(), later.end());
    loop = network::order(network, precedences);
  }
  return loop;
}

}  // namespace

network::Body Drawing::body() {
  network::Body out;
  out.language = ladder_ ? network::Language::kLadder : network::Language::kFbd;
  if (failed_) return out;
  forget_places();
  add_results();
  if (ladder_) compare_as_contacts();
  std::vector<network::Part> parts = network::split(all_, precedences_);
  for (size_t i = 0; i < parts.size(); ++i) {
    network::Network& part = parts[i].network;
    Node node = node_of(parts[i]);
    report_.set_network(static_cast<uint32_t>(i + 1));
    std::vector<uint32_t> loop = ordered(part, parts[i].precedences);
    if (!loop.empty() && follow_data(part, parts[i].precedences, node)) {
      loop = ordered(part, parts[i].precedences);
    }
    if (!loop.empty()) {
      fail(Code::kLoopWithoutVariable, node,
           "the value of " + loop_text(part, loop) + " goes in a circle, and nothing keeps it",
           "give it to a variable, and read that variable where the circle begins");
    } else if (!does_something(part)) {
      report_.add(Code::kNoCoil, node, "nothing takes what this network computes");
    }
    out.networks.push_back(part);
  }
  report_.set_network(0);
  place_remarks(parts, out);
  drop_idle(out);
  return out;
}

// The first element of a part that stands in the document.
Node Drawing::node_of(const network::Part& part) const {
  for (uint32_t element : part.from) {
    const Kind kind = all_.elements[element].kind;
    auto found = nodes_.find(element);
    if (found != nodes_.end() && kind != Kind::kLeftRail && kind != Kind::kRightRail) {
      return found->second;
    }
  }
  return raws_.empty() ? Node() : raws_.front().node;
}

}  // namespace plcopen
