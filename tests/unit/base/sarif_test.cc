// The rules of the SARIF 2.1.0 schema that readers depend on, for what render() writes.
#include <gtest/gtest.h>

#include "base/diagnostics.h"
#include "base/diagnostics_render.h"
#include "tests/unit/base/json_value.h"

namespace base {
namespace {

using Kind = JsonValue::Kind;

JsonValue sarif(const Diagnostics& diagnostics, const SourceMap& sources) {
  std::string text = render(diagnostics, sources, DiagnosticFormat::kSarif, false);
  std::optional<JsonValue> value = JsonReader(text).read();
  EXPECT_TRUE(value.has_value()) << text;
  return value.value_or(JsonValue{});
}

// Every member is one that the schema knows: objects there allow no others.
void only(const JsonValue& object, std::initializer_list<const char*> known) {
  EXPECT_EQ(object.kind, Kind::kObject);
  for (const auto& [key, member] : object.members) {
    bool found = false;
    for (const char* name : known) found = found || key == name;
    EXPECT_TRUE(found) << "unknown member " << key;
  }
}

void check_message(const JsonValue& message) {
  only(message, {"text"});
  EXPECT_FALSE(message["text"].text.empty());
}

// RFC 3986: no blanks, no bytes above ASCII, `%` only before two digits.
void check_uri(const std::string& uri) {
  ASSERT_FALSE(uri.empty());
  for (size_t i = 0; i < uri.size(); ++i) {
    auto byte = static_cast<unsigned char>(uri[i]);
    EXPECT_TRUE(byte > 0x20 && byte < 0x7F &&
                std::string("<>\"{}|\\^`").find(uri[i]) == std::string::npos)
        << uri;
    bool escape = uri[i] != '%' || (i + 2 < uri.size() && std::isxdigit(uri[i + 1]) != 0);
    EXPECT_TRUE(escape) << uri;
  }
  // The first segment of a relative reference holds no colon.
  bool absolute = uri.rfind("file:///", 0) == 0;
  EXPECT_TRUE(absolute || uri.substr(0, uri.find('/')).find(':') == std::string::npos) << uri;
}

void check_location(const JsonValue& location) {
  only(location, {"physicalLocation", "message", "id"});
  const JsonValue& place = location["physicalLocation"];
  only(place, {"artifactLocation", "region"});
  only(place["artifactLocation"], {"uri"});
  check_uri(place["artifactLocation"]["uri"].text);
  const JsonValue& region = place["region"];
  only(region, {"startLine", "startColumn", "endLine", "endColumn"});
  EXPECT_GE(region["startLine"].number, 1);
  EXPECT_GE(region["startColumn"].number, 1);
  EXPECT_GE(region["endLine"].number, region["startLine"].number);
  if (region["endLine"].number == region["startLine"].number) {
    EXPECT_GE(region["endColumn"].number, region["startColumn"].number);
  }
}

void check_result(const JsonValue& result, const JsonValue& rules) {
  only(result, {"ruleId", "ruleIndex", "level", "message", "locations", "relatedLocations",
                "partialFingerprints"});
  const std::string& level = result["level"].text;
  EXPECT_TRUE(level == "error" || level == "warning" || level == "note") << level;
  check_message(result["message"]);
  auto index = static_cast<size_t>(result["ruleIndex"].number);
  ASSERT_LT(index, rules.items.size());
  EXPECT_EQ(rules.items[index]["id"].text, result["ruleId"].text);
  for (const JsonValue& location : result["locations"].items) check_location(location);
  for (const JsonValue& location : result["relatedLocations"].items) {
    check_location(location);
    check_message(location["message"]);
  }
}

void check_log(const JsonValue& log) {
  only(log, {"$schema", "version", "runs"});
  EXPECT_EQ(log["version"].text, "2.1.0");
  ASSERT_EQ(log["runs"].items.size(), 1u);
  const JsonValue& run = log["runs"].items[0];
  only(run, {"tool", "columnKind", "results"});
  EXPECT_EQ(run["columnKind"].text, "unicodeCodePoints");
  const JsonValue& driver = run["tool"]["driver"];
  only(run["tool"], {"driver"});
  only(driver, {"name", "version", "rules"});
  EXPECT_EQ(driver["name"].text, "stc");
  std::map<std::string, int> seen;
  for (const JsonValue& rule : driver["rules"].items) {
    only(rule, {"id", "shortDescription", "help"});
    EXPECT_EQ(++seen[rule["id"].text], 1) << "a rule twice";
    check_message(rule["shortDescription"]);
    check_message(rule["help"]);
  }
  // Also without any result: null would mean that nothing was looked at.
  EXPECT_EQ(run["results"].kind, Kind::kArray);
  for (const JsonValue& result : run["results"].items) check_result(result, driver["rules"]);
}

TEST(Sarif, NothingFound) {
  SourceMap sources;
  Diagnostics diagnostics;
  check_log(sarif(diagnostics, sources));
}

TEST(Sarif, EveryKindOfResult) {
  SourceMap sources;
  SourcePos first = sources.add("a b/\xC3\xA4 100%.st", "x := \xE4 \"quoted\";\r\n\ty := 1;\n");
  SourcePos second = sources.add("/abs/c:d.st", "z\n");
  sources.add("c:d.st", "z\n");
  SourcePos third{second.offset + 3};
  Diagnostics diagnostics;
  auto span = [](SourcePos from, uint32_t begin, uint32_t end) {
    return SourceSpan{{from.offset + begin}, {from.offset + end}};
  };
  diagnostics.add(DiagnosticCode::kExpected, span(first, 0, 1), "a \"b\" \\ \t \x01 \xE4",
                  "write `c`");
  diagnostics.add(DiagnosticCode::kMissingSemicolon, span(first, 5, 25), "over two lines");
  diagnostics.add(DiagnosticCode::kExpected, span(second, 0, 0), "empty span");
  diagnostics.add(DiagnosticCode::kExpected, span(third, 0, 1), "a colon in the name");
  diagnostics.add(DiagnosticCode::kExpected, {}, "no place");
  Diagnostic with_notes{DiagnosticCode::kImplicitNarrowing, span(second, 0, 1), "w", {}, {}};
  with_notes.notes.push_back({span(first, 0, 1), "here"});
  with_notes.notes.push_back({{}, "nowhere"});
  diagnostics.add(with_notes);
  diagnostics.sort();
  JsonValue log = sarif(diagnostics, sources);
  check_log(log);
  EXPECT_EQ(log["runs"].items[0]["results"].items.size(), 6u);
}

// Where the pages of codes are is said by who builds (STC_DOCUMENTATION); without it there is no
// address to name.
TEST(Sarif, R04_RulesNameTheirPages) {
  SourceMap sources;
  const SourcePos place = sources.add("a.st", "x");
  Diagnostics diagnostics;
  diagnostics.add(DiagnosticCode::kExpected, {place, {place.offset + 1}}, "text");
  const auto uri_of = [&](const RunFacts& run) {
    const JsonValue log = *JsonReader(render_sarif(diagnostics, sources, run)).read();
    return log["runs"].items[0]["tool"]["driver"]["rules"].items[0]["helpUri"].text;
  };
  EXPECT_EQ(uri_of({.documentation = "https://stc.example/codes"}),
            "https://stc.example/codes/E1001");
  EXPECT_EQ(uri_of({}), "");
}

}  // namespace
}  // namespace base
