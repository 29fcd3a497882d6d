// Source texts and positions. A SourceMap owns every text of one compilation;
// a SourcePos is a 32-bit offset into their concatenation, so that tokens and
// nodes carry four bytes and line numbers are computed only for messages.
// Views into a text stay valid while others are added. Copies of a SourceMap share the texts. Who
// keeps a tree over edits of its sources adds later texts after the first ones, and says which
// pieces of the first ones live on where.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace base {

struct SourcePos {
  uint32_t offset = 0xffffffffu;  // none
  bool valid() const { return offset != 0xffffffffu; }
  friend auto operator<=>(SourcePos, SourcePos) = default;
};

// Half open: [begin, end).
struct SourceSpan {
  SourcePos begin;
  SourcePos end;
};

struct SourceLocation {
  std::string_view file;  // name as given to add(); "" when unknown
  uint32_t line = 0;      // 1-based; 0 when unknown
  uint32_t column = 0;    // 1-based, in bytes
  std::string_view line_text;
};

// What a text is to the language: a source, or what messages point into and nothing parses (XML
// that sources were made of).
enum class TextUse : uint8_t { kSource, kQuoted };

class SourceMap {
 public:
  // Takes the text; returns the position of its first byte. Texts over 2^31
  // bytes in all are refused by the caller (limits.def).
  SourcePos add(std::string name, std::string text, TextUse use = TextUse::kSource);

  bool is_source(uint32_t file) const { return files_[file].use == TextUse::kSource; }
  uint32_t file_count() const { return static_cast<uint32_t>(files_.size()); }
  std::string_view file_name(uint32_t file) const { return files_[file].name; }
  std::string_view text(uint32_t file) const { return *files_[file].text; }
  SourcePos begin(uint32_t file) const { return {files_[file].base}; }
  // The file that holds `pos`; file_count() when none.
  uint32_t file_of(SourcePos pos) const;
  SourceLocation locate(SourcePos pos) const;

  // Another text for a file; the positions in files after it change.
  void replace(uint32_t file, std::string text);
  // What stood at [begin, begin + size] stands at `to` now, in a later text of the same file.
  struct Piece {
    uint32_t begin;
    uint32_t size;
    uint32_t to;
  };
  // All of them, sorted by `begin`; locate() follows them, file_of() and text() do not.
  void set_pieces(std::vector<Piece> pieces) { pieces_ = std::move(pieces); }
  bool has_pieces() const { return !pieces_.empty(); }
  SourcePos current(SourcePos pos) const;
  // Position after all texts.
  SourcePos end() const { return {next_base_}; }

 private:
  struct File {
    std::string name;
    std::shared_ptr<const std::string> text;
    uint32_t base;
    TextUse use;
    mutable std::vector<uint32_t> line_starts;  // filled by the first locate()
  };
  std::deque<File> files_;  // names do not move
  std::vector<Piece> pieces_;
  uint32_t next_base_ = 0;
};

}  // namespace base
