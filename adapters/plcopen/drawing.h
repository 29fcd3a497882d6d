// <LD>, <FBD> and what of them stands in <SFC>: elements with local ids -> the model of networks.
// Connectors, continuations and variables that are written and read at once are gone after it.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "adapters/plcopen/reader.h"
#include "frontend/network/order.h"

namespace plcopen {

namespace network = frontend::network;

class Drawing {
 public:
  Drawing(bool ladder, Reporter& report) : ladder_(ladder), report_(report) {}

  // False: it is no element of a diagram.
  bool add(Node node);
  // After the last element: what connections name. False when anything was wrong.
  bool connect();
  // What a <connectionPointIn> outside of these elements is connected to.
  std::vector<network::Link> links_of(Node point);
  // Networks in the order of execution; empty, after reports, when there is none. Networks without
  // effect are left out with a warning.
  network::Body body();

  // Only what leads to `links`, which a coil or variable `end` takes. For text, after connect().
  // `work` grows by what it cost.
  Drawing part(const std::vector<network::Link>& links, const std::string& end, size_t& work) const;
  // Another place takes what comes to a coil or variable.
  void redirect(uint32_t element, const std::string& place) {
    all_.elements[element].operand.text = place;
  }

  const network::Network& elements() const { return all_; }
  // Where an element stands in the document; empty: nowhere.
  Node place_of(uint32_t element) const {
    auto found = nodes_.find(element);
    return found == nodes_.end() ? Node() : found->second;
  }
  bool failed() const { return failed_; }

 private:
  // kOpen: nothing stands there, so what it leads to stays open.
  enum class What : uint8_t { kElement, kConnector, kContinuation, kInOut, kOpen };
  struct Passed {  // an in-out parameter of a block, to be read after it
    std::string name;
    Node point;
    uint32_t source = kNone;
  };
  struct Raw {
    Node node;
    What what = What::kElement;
    uint32_t element = kNone;                           // in all_; of kInOut the source
    network::Modifier edge = network::Modifier::kNone;  // of a variable that is read
    std::vector<Passed> passed;
  };
  struct Pending {
    uint32_t element;
    uint32_t input;
    Node point;
    bool required;
  };
  struct Stored {  // what an output does to the variables behind it
    network::Modifier modifier;
    Node pin;
  };
  struct Remark {
    int32_t y;
    std::string text;
    Node node;
    bool label;
    bool title;
    size_t before;  // the element of all_ that follows it in the document
    int32_t row;    // y as the document says it
    Node disabled;  // a network that it shows
  };
  static constexpr uint32_t kNone = 0xffffffffu;

  void fail(Code code, Node node, std::string text, std::string fix = {});
  void report_inside(Node node);

  // --- drawing_elements.cc
  network::Element made(Node node, network::Kind kind);
  Raw& record(Node node, What what, uint32_t element);
  void wait_for(uint32_t element, uint32_t input, Node owner, bool required);
  bool negated(Node node);
  network::Modifier edge_of(Node node);
  network::Modifier modifier_of(Node node, bool stores);
  network::Modifier storage_of(Node node);
  bool is_open(Node node);  // a variable whose place an editor has left empty; it is recorded then
  std::string operand(Node node, const char* child);
  std::string expression(Node node);
  uint32_t push(network::Element element);
  void add_rail(Node node, network::Kind kind);
  void add_contact(Node node, network::Kind kind);
  void add_read(Node node, network::Kind kind);
  void add_written(Node node, network::Kind kind);
  void add_both(Node node, network::Kind kind);
  void add_block(Node node, network::Kind kind);
  void add_end(Node node, network::Kind kind);
  void add_connector(Node node, network::Kind kind);
  void add_remark(Node node, network::Kind kind);

  // --- drawing_pins.cc
  void add_results();
  void add_pins(Node node, uint32_t block, Raw& raw);
  void add_storage(Node pin, uint32_t block);

  // --- drawing_comparisons.cc
  void compare_as_contacts();

  // --- drawing_links.cc
  void connect(const Pending& pending);
  void store();
  void ignore(uint32_t sink);
  void append_links(Node point, std::vector<network::Link>& out, network::Modifier* edge);
  bool count_link(Node at);
  void append_link(Node connection, std::vector<network::Link>& out, network::Modifier* edge);
  bool link_block(Raw& raw, Node connection, std::vector<network::Link>& out);
  uint32_t read_back(Raw& raw, Passed& passed);
  void forget_places();

  // --- drawing_remarks.cc
  struct Inserted {  // a network that is no part of the drawing
    size_t before;   // the part that follows it
    int32_t y;
    network::Network network;
    bool disabled = false;  // behind the labels of its row
  };
  void place_remarks(const std::vector<network::Part>& parts, network::Body& body);
  std::vector<Inserted> disabled_networks(const std::vector<int32_t>& ends);
  // Null, or the label that `own` had: a network has one, so that one gets a network of its own.
  static std::optional<network::Text> place_remark(Remark& remark, network::Network& own);
  static bool does_something(const network::Network& part);
  static void drop_idle(network::Body& body);
  Node node_of(const network::Part& part) const;
  bool follow_data(network::Network& part, const std::vector<network::Precedence>& precedences,
                   Node node);
  std::string loop_text(const network::Network& part, const std::vector<uint32_t>& loop) const;

  bool ladder_;
  Reporter& report_;
  bool failed_ = false;
  network::Network all_;
  std::vector<Raw> raws_;
  std::map<uint32_t, Node> nodes_;  // by element
  std::vector<Pending> pending_;
  std::vector<network::Precedence> precedences_;
  std::map<std::pair<uint32_t, uint32_t>, Stored> stored_;  // by element and output
  std::vector<Remark> remarks_;
  std::map<uint64_t, size_t> by_id_;
  std::map<std::string, size_t> connectors_;  // by name
  uint64_t links_ = 0;                        // through connectors, too
  std::set<const void*> followed_;            // points that are being resolved
};

// 0: none, or no number; otherwise one more than the id, which may be 0.
uint64_t id_of(std::string_view text);

// --- diagram.cc
// A body in LADDER or FBD as text.
std::string diagram_text(Node body, const std::string& name, Reporter& report);
// The same of a drawing that is read. `member`: of the POU, whose body it is; `elements`: what an
// export writes for it; empty: those of the model.
std::string drawing_text(Drawing& drawing, Node at, const std::string& member, std::string elements,
                         Reporter& report);
// False, after a report: not all of it is understood.
bool add_all(Node body, Drawing& drawing, const std::string& name, Reporter& report);

// --- diagram_condition.cc
// What arrives at `name`, in a body that ends in that coil or variable, as an expression.
std::string diagram_condition(Node body, const std::string& name, Reporter& report);
// The condition that links of a chart lead to; empty after a report when they are none.
std::string links_text(const network::Network& all, const std::vector<network::Link>& links,
                       Node at, Reporter& report);
// Is it more than an expression: does it call function blocks, see edges, write, jump?
bool is_more_than_expression(Node body);
bool is_more_than_expression(const network::Network& all);
// Then it is the body of a method `method`: what arrives at `name` is its result. Empty after a
// report when that cannot be.
std::string condition_body(Node body, const std::string& name, const std::string& method,
                           Reporter& report);
// An element in a chart that no condition is made of: what to do with it.
void report_in_chart(Node node, Reporter& report);

}  // namespace plcopen
