// Every form of literal over arbitrary bytes: the input stands behind the beginning of each
// form, the lexer finds the tokens, and their decoders give values inside their limits and
// problems inside their text.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/check.h"
#include "base/limits.h"
#include "frontend/lex/lexer.h"
#include "frontend/lex/literals.h"

namespace {

using frontend::StringCharset;
using frontend::TokenKind;

constexpr const char* kBeginnings[] = {"",      "16#",   "2#", "1.", "1E", "T#", "LTIME#-", "D#",
                                       "TOD#",  "LDT#",  "'",  "\"", "%",  "%I", "%QW",     "x.%X",
                                       "INT#-", "BOOL#", "1_", "$",  "'$", "\"$"};

void check_problem(const frontend::MaybeProblem& problem, std::string_view text) {
  if (!problem) return;
  base::check(!problem->text.empty(), "a problem has a text");
  base::check(problem->at <= text.size(), "a problem lies inside its literal");
}

void check_time(const frontend::DecodedTime& time, std::string_view text) {
  check_problem(time.problem, text);
  base::check(time.ns <= uint64_t{1} << 63, "a time fits into 64 bits");
}

void check_string(std::string_view text, bool latin1) {
  using enum StringCharset;
  for (StringCharset charset : {kLatin1Source, kLatin1ToUtf8, kUtf8Source, kUtf8SourceBytes}) {
    bool for_latin1 = charset == kLatin1Source || charset == kLatin1ToUtf8;
    if (for_latin1 != latin1) continue;
    frontend::DecodedString string = frontend::decode_string(text, charset);
    check_problem(string.problem, text);
    size_t most = charset == kLatin1ToUtf8 ? text.size() * 2 : text.size();
    base::check(string.bytes.size() <= most, "decoding does not lengthen a string");
  }
}

void check_wide_string(std::string_view text, bool latin1) {
  frontend::DecodedString string = frontend::decode_wide_string(text, latin1);
  check_problem(string.problem, text);
  base::check(string.bytes.size() % 2 == 0, "a wide string has whole units");
  base::check(string.bytes.size() <= text.size() * 2, "a byte makes one unit at most");
}

void check_address(std::string_view text) {
  frontend::DecodedAddress address = frontend::decode_address(text);
  check_problem(address.problem, text);
  frontend::DecodedPart part = frontend::decode_part(text);
  check_problem(part.problem, text);
  if (address.problem) return;
  base::check(address.levels.size() <= base::kMaxAddressLevels, "levels are limited");
  uint64_t end = uint64_t{address.address.bit_offset} + address.address.bit_size;
  base::check(end <= uint64_t{1} << 32, "an address ends inside 32 bits");
}

void check_token(TokenKind kind, std::string_view text, bool latin1) {
  switch (kind) {
    case TokenKind::kInteger:
      return check_problem(frontend::decode_integer(text).problem, text);
    case TokenKind::kReal:
      return check_problem(frontend::decode_real(text).problem, text);
    case TokenKind::kDuration:
      return check_time(frontend::decode_duration(text), text);
    case TokenKind::kDate:
      return check_time(frontend::decode_date(text).time, text);
    case TokenKind::kString:
      return check_string(text, latin1);
    case TokenKind::kWideString:
      return check_wide_string(text, latin1);
    case TokenKind::kDirect:
      return check_address(text);
    default:
      return;
  }
}

void run(std::string text) {
  base::SourceMap sources;
  sources.add("fuzz.st", std::move(text));
  base::Diagnostics diagnostics;
  frontend::TokenList list = frontend::lex(sources, 0, diagnostics);
  for (const frontend::Token& token : list.tokens) {
    check_token(token.kind, sources.text(0).substr(token.begin, token.length), list.latin1);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  std::string text(reinterpret_cast<const char*>(data), size);
  for (const char* beginning : kBeginnings) run(beginning + text);
  return 0;
}
