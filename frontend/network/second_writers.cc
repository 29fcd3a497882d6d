// In a ladder, a value that is written and then written again before anything can have read it
// . Two coils are reported whatever stands between them (suspicious.cc).
#include <map>
#include <string>
#include <string_view>

#include "frontend/lex/characters.h"
#include "frontend/network/suspicious.h"
#include "ir/types/types.h"

namespace frontend::network {
namespace {

struct Written {
  base::SourceSpan span;
  bool coil = false;
};

class SecondWriters {
 public:
  SecondWriters(const Body& body, base::Diagnostics& diagnostics)
      : body_(body), diagnostics_(diagnostics) {}

  void run() {
    for (const Network& network : body_.networks) {
      if (network.disabled) continue;
      for (const Element& element : network.elements) look_at(network, element);
    }
  }

 private:
  void look_at(const Network& network, const Element& element) {
    const bool plain =
        element.modifier == Modifier::kNone || element.modifier == Modifier::kNegated;
    if (element.kind == Kind::kBlock && !element.operand.empty()) return unread_.clear();
    if (element.kind == Kind::kContact || element.kind == Kind::kSource || !plain) {
      return read(element.operand.text);
    }
    if (element.kind == Kind::kCoil) write(element, true, true);
    if (element.kind == Kind::kSink) write(element, false, is_always_done(network, element));
  }

  // The box that it comes from has no EN, or EN at the rail.
  static bool is_always_done(const Network& network, const Element& sink) {
    if (sink.inputs.empty() || sink.inputs[0].from.size() != 1) return false;
    const Element& box = network.elements[sink.inputs[0].from[0].element];
    if (box.kind != Kind::kBlock) return false;
    for (const Input& input : box.inputs) {
      if (!ir::same_name(input.name, "EN")) continue;
      for (const Link link : input.from) {
        if (network.elements[link.element].kind != Kind::kLeftRail) return false;
      }
    }
    return true;
  }

  // Whatever begins with a name that is in the text.
  void read(std::string_view text) {
    for (size_t at = 0; at < text.size();) {
      size_t end = at;
      while (end < text.size() && is_name_part(text[end])) ++end;
      if (end != at) unread_.erase(ir::fold_name(text.substr(at, end - at)));
      at = end + (end == at ? 1 : 0);
    }
  }

  void write(const Element& element, bool coil, bool always) {
    const std::string place = fixed_place(element.operand.text);
    const std::string head = place.substr(0, place.find_first_of(".["));
    if (head.empty() || head[0] == '%') return read(element.operand.text);
    Places& places = unread_[head];
    const auto before = places.find(place);
    if (before != places.end() && always && !(coil && before->second.coil)) {
      base::Diagnostic message{Code::kSecondCoil,
                               element.operand.span,
                               "`" + element.operand.text +
                                   "` is written before this, which has no effect then: nothing "
                                   "reads it between",
                               "take one of them away, or write another variable",
                               {{before->second.span, "what is written first"}}};
      diagnostics_.add(std::move(message));
    }
    places[place] = {element.operand.span, coil};
  }

  using Code = base::DiagnosticCode;
  using Places = std::map<std::string, Written>;

  const Body& body_;
  base::Diagnostics& diagnostics_;
  std::map<std::string, Places> unread_;  // by the name that the place begins with
};

}  // namespace

void report_second_writers(const Body& body, base::Diagnostics& diagnostics) {
  if (body.language == Language::kLadder && !may_skip(body)) SecondWriters(body, diagnostics).run();
}

}  // namespace frontend::network
