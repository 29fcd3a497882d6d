// What stands in a pragma `{...}`: words, quoted texts and signs, and attributes.
// Views into the pragma's text; anything may stand there, so nothing is an error here.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace frontend {

// Reads a pragma piece by piece, without its braces.
class PragmaReader {
 public:
  enum class Kind : uint8_t { kEnd, kWord, kText, kSign };

  explicit PragmaReader(std::string_view inside) : text_(inside) { next(); }
  Kind kind() const { return kind_; }
  std::string_view piece() const { return piece_; }  // of a kText: without its quotes
  void next();
  bool is_word(std::string_view word) const;
  bool accept_word(std::string_view word);
  bool accept_sign(char sign);

 private:
  std::string_view text_;
  size_t at_ = 0;
  Kind kind_ = Kind::kEnd;
  std::string_view piece_;
};

struct PragmaAttribute {
  std::string_view name;
  std::string_view value;
  bool has_value = false;
  std::string_view part;  // {renamed '.part' from := 'old'}
  bool marked = false;    // `, inverse` after the value
  std::string_view from;  // `, from := 'Type'` after the value
};
// `{attribute 'name'}`, `{attribute 'name' := 'value'}`, and `{renamed from := 'old'}` as an
// attribute `renamed`, whose value is missing when it is written in another way, and goes on to the
// last one of several old names. nullopt for all other pragmas. So are `{migration of := 'Type'}`,
// `{migration of := 'Type', from := 'Other'}` and `{old := 'x'}`, `{new := 'x'}`.
inline constexpr std::string_view kRenamedAttribute = "renamed";
inline constexpr std::string_view kMigrationAttribute = "migration";
std::optional<PragmaAttribute> read_attribute(std::string_view pragma);

// The texts of such a value: "b', 'a" -> b, a.
std::vector<std::string_view> quoted_texts(std::string_view value);

// Without the braces.
std::string_view inside_pragma(std::string_view pragma);

}  // namespace frontend
