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
  // In-outs are declared in front of inputs: which of them the box shows first is not known.
  bool unclear = false;
};

class PinNames {
 public:
  // The function blocks that a text in ST declares. The first declaration of a name counts.
  void add(std::string_view source);
  // Those of the library that come with every program, as CODESYS calls them.
  void add_library();

  const Pins* find(std::string_view type) const;  // null: not declared

 private:
  std::map<std::string, Pins> types_;  // by folded name
};

}  // namespace text_export
