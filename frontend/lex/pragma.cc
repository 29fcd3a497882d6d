#include "frontend/lex/pragma.h"

#include <algorithm>

#include "frontend/lex/characters.h"
#include "ir/types/types.h"

namespace frontend {

void PragmaReader::next() {
  while (at_ < text_.size() && is_space(text_[at_])) ++at_;
  size_t begin = at_;
  if (at_ == text_.size()) {
    kind_ = Kind::kEnd;
    piece_ = {};
  } else if (char quote = text_[at_]; quote == '\'' || quote == '"') {
    size_t end = std::min(text_.find(quote, at_ + 1), text_.size());
    kind_ = Kind::kText;
    piece_ = text_.substr(at_ + 1, end - at_ - 1);
    at_ = std::min(end + 1, text_.size());
  } else if (is_name_part(text_[at_])) {
    while (at_ < text_.size() && (is_name_part(text_[at_]) || text_[at_] == '.')) ++at_;
    kind_ = Kind::kWord;
    piece_ = text_.substr(begin, at_ - begin);
  } else {
    ++at_;
    kind_ = Kind::kSign;
    piece_ = text_.substr(begin, 1);
  }
}

bool PragmaReader::is_word(std::string_view word) const {
  return kind_ == Kind::kWord && ir::same_name(piece_, word);
}

bool PragmaReader::accept_word(std::string_view word) {
  if (!is_word(word)) return false;
  next();
  return true;
}

bool PragmaReader::accept_sign(char sign) {
  if (kind_ != Kind::kSign || piece_[0] != sign) return false;
  next();
  return true;
}

std::string_view inside_pragma(std::string_view pragma) {
  return pragma.size() < 2 ? std::string_view() : pragma.substr(1, pragma.size() - 2);
}

namespace {

// , 'text' ...; what `first` begins ends after the last of them.
std::string_view read_more(PragmaReader& reader, std::string_view first) {
  while (reader.accept_sign(',')) {
    if (reader.kind() != PragmaReader::Kind::kText) return {};
    const std::string_view piece = reader.piece();
    first = {first.data(), static_cast<size_t>(piece.data() + piece.size() - first.data())};
    reader.next();
  }
  return first;
}

// [, from := 'text'] [, inverse]
void read_migration(PragmaReader& reader, PragmaAttribute& out) {
  if (!reader.accept_sign(',')) return;
  if (reader.accept_word("from")) {
    const bool head = reader.accept_sign(':') && reader.accept_sign('=');
    if (!head || reader.kind() != PragmaReader::Kind::kText || reader.piece().empty()) return;
    out.from = reader.piece();
    reader.next();
    if (!reader.accept_sign(',')) return;
  }
  out.marked = reader.accept_word("inverse");
}

// NAME ['part'] [word] := 'text' [, from := 'text'] [, inverse]. Whoever looks for it says what is
// wrong with one that is written otherwise.
PragmaAttribute read_rule(PragmaReader& reader, std::string_view word) {
  PragmaAttribute out;
  out.name = reader.piece();
  reader.next();
  if (word == "from" && reader.kind() == PragmaReader::Kind::kText) {
    out.part = reader.piece();
    reader.next();
  }
  const bool head = (word.empty() || reader.accept_word(word)) && reader.accept_sign(':') &&
                    reader.accept_sign('=');
  if (!head || reader.kind() != PragmaReader::Kind::kText) return out;
  out.value = reader.piece();
  reader.next();
  if (word == "of") read_migration(reader, out);
  if (word == "from") out.value = read_more(reader, out.value);
  out.has_value = reader.kind() == PragmaReader::Kind::kEnd;
  return out;
}

}  // namespace

std::vector<std::string_view> quoted_texts(std::string_view value) {
  std::vector<std::string_view> out;
  for (size_t at = 0; at <= value.size();) {
    const size_t end = std::min(value.find_first_of("'\"", at), value.size());
    out.push_back(value.substr(at, end - at));
    const size_t next = value.find_first_of("'\"", end + 1);
    at = next == std::string_view::npos ? value.size() + 1 : next + 1;
  }
  return out;
}

std::optional<PragmaAttribute> read_attribute(std::string_view pragma) {
  PragmaReader reader(inside_pragma(pragma));
  if (reader.is_word(kRenamedAttribute)) return read_rule(reader, "from");
  if (reader.is_word(kMigrationAttribute)) return read_rule(reader, "of");
  if (reader.is_word("old") || reader.is_word("new")) return read_rule(reader, "");
  if (!reader.accept_word("attribute")) return std::nullopt;
  bool named =
      reader.kind() == PragmaReader::Kind::kText || reader.kind() == PragmaReader::Kind::kWord;
  if (!named || reader.piece().empty()) return std::nullopt;
  PragmaAttribute out;
  out.name = reader.piece();
  reader.next();
  if (reader.accept_sign(':') && reader.accept_sign('=')) {
    out.has_value = true;
    out.value = reader.piece();
  }
  return out;
}

}  // namespace frontend
