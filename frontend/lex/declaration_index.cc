#include "frontend/lex/declaration_index.h"

#include <array>
#include <string>
#include <unordered_map>

#include "frontend/lex/lexer.h"
#include "frontend/lex/pragma.h"
#include "ir/types/types.h"

namespace frontend {

namespace {

constexpr std::array<std::string_view, 5> kKindWords = {"variable", "type", "pou", "task",
                                                        "resource"};

bool begins_pou(TokenKind kind) {
  return kind == TokenKind::kProgram || kind == TokenKind::kFunction ||
         kind == TokenKind::kFunctionBlock || kind == TokenKind::kClass ||
         kind == TokenKind::kInterface;
}

bool ends_pou(TokenKind kind) {
  return kind == TokenKind::kEndProgram || kind == TokenKind::kEndFunction ||
         kind == TokenKind::kEndFunctionBlock || kind == TokenKind::kEndClass ||
         kind == TokenKind::kEndInterface;
}

bool is_word_before_name(TokenKind kind) {
  return kind == TokenKind::kAbstract || kind == TokenKind::kFinal || kind == TokenKind::kPublic ||
         kind == TokenKind::kInternal || kind == TokenKind::kPrivate ||
         kind == TokenKind::kProtected;
}

// One walk over the tokens of a file.
class Collector {
 public:
  Collector(const base::SourceMap& sources, uint32_t file,
            std::array<std::unordered_map<std::string, std::vector<Declared>>, 5>& tables)
      : text_(sources.text(file)), base_(sources.begin(file).offset), tables_(tables) {
    base::Diagnostics ignored(0);
    list_ = lex(sources, file, ignored, LexOptions::all_text());
  }

  void run() {
    for (at_ = 0; at_ + 1 < list_.tokens.size(); ++at_) visit(kind(at_));
  }

 private:
  TokenKind kind(size_t at) const {
    return at < list_.tokens.size() ? list_.tokens[at].kind : TokenKind::kEnd;
  }
  std::string_view text(size_t at) const {
    if (at >= list_.tokens.size()) return {};
    const Token& token = list_.tokens[at];
    return text_.substr(token.begin - base_, token.length);
  }
  uint32_t begin(size_t at) const { return list_.tokens[at].begin; }

  void visit(TokenKind token) {
    if (begins_pou(token) && is_name(kind(at_ + 1))) return begin_pou();
    if (ends_pou(token)) return end_pou();
    if (token == TokenKind::kStruct || token == TokenKind::kUnion) {
      in_struct_ = true;
    } else if (token == TokenKind::kEndStruct || token == TokenKind::kEndUnion) {
      in_struct_ = false;
    } else if (token >= TokenKind::kVar && token <= TokenKind::kVarTemp) {
      in_variables_ = true;
      is_global_ = token == TokenKind::kVarGlobal;
    } else if (token == TokenKind::kEndVar) {
      in_variables_ = false;
    } else if (token == TokenKind::kType || token == TokenKind::kEndType) {
      in_types_ = token == TokenKind::kType;
    } else if (token == TokenKind::kTask && is_name(kind(at_ + 1))) {
      add(DeclaredKind::kTask, at_ + 1, at_);
    } else if (token == TokenKind::kResource && is_name(kind(at_ + 1))) {
      add(DeclaredKind::kResource, at_ + 1, at_);
    } else if (is_name(token) && !in_struct_ && (in_variables_ || in_types_)) {
      visit_name();
    }
  }

  // `name :`, `name, name :`, `name AT %QX0.0 :` after the end of another declaration.
  void visit_name() {
    TokenKind next = kind(at_ + 1);
    if (in_types_ && (next == TokenKind::kColon || next == TokenKind::kExtends)) {
      add(DeclaredKind::kType, at_, at_);
    } else if (in_variables_ &&
               (next == TokenKind::kColon || next == TokenKind::kComma || next == TokenKind::kAt)) {
      size_t colon = at_ + 1;
      while (kind(colon) == TokenKind::kComma || is_name(kind(colon)) ||
             kind(colon) == TokenKind::kDirect) {
        ++colon;
      }
      if (kind(colon) != TokenKind::kColon) return;
      Declared& declared = add(DeclaredKind::kVariable, at_, at_);
      declared.type = text(colon + 1);
      if (!is_global_) declared.begin = pou_begin_;
      if (!is_global_) locals_.push_back(declared.name);
    }
  }

  void begin_pou() {
    size_t name = at_ + 1;
    while (is_word_before_name(kind(name)) && is_name(kind(name + 1))) ++name;
    Declared& pou = add(DeclaredKind::kPou, name, at_);
    size_t base = name + 1;
    if (kind(base) == TokenKind::kExtends && is_name(kind(++base))) {
      while (kind(base + 1) == TokenKind::kDot && is_name(kind(base + 2))) base += 2;
      pou.type = text(base);
    }
    pou_begin_ = begin(at_);
    locals_.clear();
  }

  void end_pou() {
    auto& variables = tables_[static_cast<size_t>(DeclaredKind::kVariable)];
    for (std::string_view name : locals_) {
      std::vector<Declared>& all = variables[ir::fold_name(name)];
      for (auto it = all.rbegin(); it != all.rend() && it->begin == pou_begin_; ++it) {
        it->end = begin(at_);
      }
    }
    locals_.clear();
  }

  // `from`: the token that the attributes stand in front of.
  Declared& add(DeclaredKind kind, size_t name, size_t from) {
    Declared declared;
    declared.name = text(name);
    uint32_t after = from == 0 ? 0 : begin(from - 1);
    while (next_pragma_ < list_.pragmas.size() &&
           list_.pragmas[next_pragma_].begin.offset < begin(from)) {
      base::SourceSpan span = list_.pragmas[next_pragma_++];
      uint32_t offset = span.begin.offset;
      if (offset < after) continue;
      auto attribute = read_attribute(text_.substr(offset - base_, span.end.offset - offset));
      if (attribute) declared.attributes.push_back(attribute->name);
    }
    std::vector<Declared>& all = tables_[static_cast<size_t>(kind)][ir::fold_name(declared.name)];
    return all.emplace_back(std::move(declared));
  }

  std::string_view text_;
  uint32_t base_;
  std::array<std::unordered_map<std::string, std::vector<Declared>>, 5>& tables_;
  TokenList list_;
  size_t at_ = 0;
  size_t next_pragma_ = 0;
  uint32_t pou_begin_ = 0;
  std::vector<std::string_view> locals_;
  bool in_struct_ = false;
  bool in_types_ = false;
  bool in_variables_ = false;
  bool is_global_ = false;
};

}  // namespace

struct DeclarationIndex::Table {
  std::array<std::unordered_map<std::string, std::vector<Declared>>, 5> kinds;
};

std::optional<DeclaredKind> declared_kind(std::string_view word) {
  for (size_t i = 0; i < kKindWords.size(); ++i) {
    if (ir::same_name(word, kKindWords[i])) return static_cast<DeclaredKind>(i);
  }
  return std::nullopt;
}

DeclarationIndex::DeclarationIndex(const base::SourceMap& sources) : sources_(sources) {}
DeclarationIndex::~DeclarationIndex() = default;

const DeclarationIndex::Table& DeclarationIndex::table() const {
  if (table_) return *table_;
  table_ = std::make_unique<Table>();
  for (uint32_t file = 0; file < sources_.file_count(); ++file) {
    if (sources_.is_source(file)) Collector(sources_, file, table_->kinds).run();
  }
  return *table_;
}

const Declared* DeclarationIndex::find(DeclaredKind kind, std::string_view name,
                                       uint32_t position) const {
  const auto& names = table().kinds[static_cast<size_t>(kind)];
  auto found = names.find(ir::fold_name(name));
  if (found == names.end()) return nullptr;
  const Declared* best = nullptr;
  for (const Declared& declared : found->second) {
    if (position < declared.begin || position > declared.end) continue;
    if (best == nullptr || declared.begin > best->begin) best = &declared;
  }
  return best;
}

std::string_view DeclarationIndex::base_of(std::string_view pou) const {
  const auto& names = table().kinds[static_cast<size_t>(DeclaredKind::kPou)];
  const auto found = names.find(ir::fold_name(pou));
  if (found == names.end()) return {};
  const std::string_view base = found->second.front().type;
  for (const Declared& other : found->second) {
    if (!ir::same_name(other.type, base)) return {};
  }
  return base;
}

}  // namespace frontend
