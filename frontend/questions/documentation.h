// The comment at a declaration: what stands in the lines directly above it, attributes left out;
// else what follows in its own line; else, at a POU, what stands directly below its head.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace frontend::questions {

// The comments of one source file. The text is read once, and outlives this.
class Documentation {
 public:
  explicit Documentation(std::string_view text);

  // `name`: where the declared name begins in the text. `below`: look below, too. The comments'
  // text without their marks, a line each; "": there are none.
  std::string at(size_t name, bool below) const;

 private:
  struct Comment {
    size_t begin;
    size_t end;
  };
  std::string above(size_t name) const;

  std::string_view text_;
  std::vector<Comment> comments_;  // in order
};

}  // namespace frontend::questions
