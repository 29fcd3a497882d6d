// scale COPIES FOLDER SOURCES...: writes COPIES copies of the sources into FOLDER. Every copy but
// the first gives the global names (POUs, types, enumeration values, global variables) a prefix, so
// that all copies together are one program of realistic size.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "base/source.h"
#include "frontend/lex/lexer.h"
#include "tools/common/files.h"

namespace {

using frontend::Token;
using frontend::TokenKind;

std::string lower(std::string_view text) {
  std::string out(text);
  for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
  return out;
}

struct File {
  std::string name;
  uint32_t begin = 0;  // SourcePos of the first byte
  std::vector<Token> tokens;
};

// Finds the global names of one file in its tokens.
class NameCollector {
 public:
  NameCollector(const base::SourceMap& sources, const File& file, uint32_t index,
                std::set<std::string>& names)
      : text_(sources.text(index)), file_(file), names_(names) {}

  void run() {
    while (at_ < file_.tokens.size()) {
      switch (kind()) {
        case TokenKind::kFunction:
        case TokenKind::kFunctionBlock:
        case TokenKind::kProgram:
          ++at_;
          add();
          break;
        case TokenKind::kType:
          take_types();
          break;
        case TokenKind::kVarGlobal:
          take_globals();
          break;
        default:
          ++at_;
      }
    }
  }

 private:
  TokenKind kind(size_t ahead = 0) const {
    size_t index = at_ + ahead;
    return index < file_.tokens.size() ? file_.tokens[index].kind : TokenKind::kEnd;
  }
  void add() {
    const Token& token = file_.tokens[at_];
    names_.insert(lower(text_.substr(token.begin - file_.begin, token.length)));
    ++at_;
  }
  void skip_past(TokenKind end) {
    while (kind() != end && kind() != TokenKind::kEnd) ++at_;
  }
  // NAME : (A, B := 5, C);
  void take_enumeration() {
    while (kind() != TokenKind::kRightParen && kind() != TokenKind::kEnd) {
      bool first = kind() == TokenKind::kLeftParen || kind() == TokenKind::kComma;
      ++at_;
      if (first && frontend::is_name(kind())) add();
    }
  }
  void take_types() {
    while (kind() != TokenKind::kEndType && kind() != TokenKind::kEnd) {
      if (frontend::is_name(kind()) && kind(1) == TokenKind::kColon) {
        add();
        ++at_;
        if (kind() == TokenKind::kLeftParen) take_enumeration();
        if (kind() == TokenKind::kStruct) skip_past(TokenKind::kEndStruct);
      }
      ++at_;
    }
  }
  void take_globals() {
    while (kind() != TokenKind::kEndVar && kind() != TokenKind::kEnd) {
      if (frontend::is_name(kind()) &&
          (kind(1) == TokenKind::kColon || kind(1) == TokenKind::kComma ||
           kind(1) == TokenKind::kAt)) {
        add();
        if (kind() != TokenKind::kComma) skip_past(TokenKind::kSemicolon);
      }
      ++at_;
    }
  }

  std::string_view text_;
  const File& file_;
  std::set<std::string>& names_;
  size_t at_ = 0;
};

std::string with_prefix(std::string_view text, const File& file, const std::set<std::string>& names,
                        const std::string& prefix) {
  std::string out;
  size_t done = 0;
  for (size_t i = 0; i < file.tokens.size(); ++i) {
    const Token& token = file.tokens[i];
    size_t at = token.begin - file.begin;
    if (!frontend::is_name(token.kind)) continue;
    if (token.kind == TokenKind::kAt && file.tokens[i + 1].kind == TokenKind::kDirect) {
      // Two copies cannot own the same address.
      out += text.substr(done, at - done);
      done = at + file.tokens[i + 1].begin + file.tokens[i + 1].length - token.begin;
      continue;
    }
    if (names.count(lower(text.substr(at, token.length))) == 0) continue;
    out += text.substr(done, at - done);
    out += prefix;
    done = at;
  }
  return out + std::string(text.substr(done));
}

bool fail(const std::string& text) {
  std::fprintf(stderr, "scale: %s\n", text.c_str());
  return false;
}

bool read_sources(int count, char** paths, base::SourceMap& sources, std::vector<File>& files) {
  for (int i = 0; i < count; ++i) {
    base::Result<std::string> text = tools::read_text(paths[i]);
    if (!text.ok()) return fail(base::to_string(text.error()));
    std::filesystem::path path = paths[i];
    std::string name = path.parent_path().filename().string() + "_" + path.filename().string();
    uint32_t begin = sources.add(name, std::move(*text)).offset;
    base::Diagnostics ignored;
    files.push_back(
        {name, begin, frontend::lex(sources, static_cast<uint32_t>(i), ignored).tokens});
  }
  return true;
}

bool write_copy(int copy, const std::string& folder, const base::SourceMap& sources,
                const std::vector<File>& files, const std::set<std::string>& names) {
  std::string prefix = copy == 0 ? "" : "k" + std::to_string(copy) + "_";
  for (uint32_t i = 0; i < files.size(); ++i) {
    std::string text = copy == 0 ? std::string(sources.text(i))
                                 : with_prefix(sources.text(i), files[i], names, prefix);
    std::string path = folder + "/" + prefix + files[i].name;
    if (!tools::write_file(path, base::as_bytes(text)).ok()) return fail("cannot write " + path);
  }
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: scale COPIES FOLDER SOURCES...\n");
    return 2;
  }
  base::SourceMap sources;
  std::vector<File> files;
  if (!read_sources(argc - 3, argv + 3, sources, files)) return 1;
  std::set<std::string> names;
  for (uint32_t i = 0; i < files.size(); ++i) NameCollector(sources, files[i], i, names).run();
  std::filesystem::create_directories(argv[2]);
  for (int copy = 0; copy < std::atoi(argv[1]); ++copy) {
    if (!write_copy(copy, argv[2], sources, files, names)) return 1;
  }
  return 0;
}
