// Pieces of sources by their spans, as units are made of them; inside of units.h.
#pragma once

#include <string>
#include <string_view>

#include "frontend/parse/tree.h"
#include "tools/stc/units.h"

namespace stc {

class Slices {
 public:
  explicit Slices(const base::SourceMap& sources) : sources_(sources) {}

  std::string_view of(base::SourceSpan span) const;
  // In one line, without comments.
  std::string plain(base::SourceSpan span) const { return plain_text(of(span)); }
  // From `begin` to the semicolon that ends it.
  std::string to_semicolon(base::SourcePos begin) const;
  // The span of all its variables; that of a block is that of its first word.
  base::SourceSpan whole(const frontend::VarBlock& block) const;
  std::vector<BodyLine> lines(base::SourceSpan span) const;
  uint32_t line(base::SourcePos at) const { return sources_.locate(at).line; }
  std::string_view file(base::SourcePos at) const { return sources_.locate(at).file; }

  static std::string plain_text(std::string_view text);
  static std::string_view trimmed(std::string_view text);

 private:
  std::string_view from(base::SourcePos begin) const;

  const base::SourceMap& sources_;
};

// Every run of blanks is one, those at the ends are none.
std::string squeezed(std::string_view line);

// The section of a block of variables: "VAR_INPUT RETAIN".
std::string section_text(const frontend::VarBlock& block);

}  // namespace stc
