// What function blocks call their pins: a box of an export has them by position only.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace text_export {

struct Pins {
  // As the box shows them: inputs, then in-outs.
  std::vector<std::string> left;
  std::vector<std::string> right;
  // Why it is not known which of them the box shows first; empty: it is.
  std::string unclear;
};

class PinNames {
 public:
  // The function blocks that a text in ST declares, but for those in namespaces. Two that have one
  // name and other pins are unclear.
  void add(std::string_view source);
  // Those of the library that come with every program, as CODESYS calls them; what is declared
  // already goes before them.
  void add_library();

  const Pins* find(std::string_view type) const;  // null: not declared

 private:
  void add(std::string_view source, std::map<std::string, Pins>& to) const;

  std::map<std::string, Pins> types_;  // by folded name
};

}  // namespace text_export
