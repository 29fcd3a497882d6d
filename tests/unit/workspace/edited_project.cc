#include "tests/unit/workspace/edited_project.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "base/name_case.h"
#include "frontend/compile.h"
#include "frontend/parse/parse.h"
#include "frontend/source_edits.h"
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "tests/source_path.h"

namespace test {
namespace {

std::string rendered(base::Diagnostics& diagnostics, const base::SourceMap& sources) {
  diagnostics.sort();
  return base::render(diagnostics, sources, base::DiagnosticFormat::kJson, false);
}

// Lines of a part of a text, as offsets of their beginnings and of the end.
std::vector<size_t> lines_of(const std::string& text, size_t begin, size_t end) {
  std::vector<size_t> lines;
  for (size_t at = text.find('\n', begin); at < end; at = text.find('\n', at + 1)) {
    lines.push_back(at + 1);
  }
  return lines;
}

struct Part {
  size_t begin;
  size_t end;
};

// The statements of some POU, or everything.
Part choose_part(const std::string& text, Random& random) {
  if (random.below(8) == 0) return {0, text.size()};
  const base::SourceMap sources = one_file(text);
  base::Diagnostics unheard;
  frontend::Tree tree;
  frontend::parse(sources, 0, tree, unheard);
  const auto places = frontend::code_places(tree.pous, sources, 0);
  if (places.empty()) return {0, text.size()};
  const auto& place = places[random.below(static_cast<uint32_t>(places.size()))];
  return {place.begin, place.end};
}

void change_number(std::string& text, const Part& part, Random& random) {
  std::vector<size_t> digits;
  for (size_t i = part.begin; i < part.end; ++i) {
    if (text[i] >= '0' && text[i] <= '9') digits.push_back(i);
  }
  if (digits.empty()) return;
  text[digits[random.below(static_cast<uint32_t>(digits.size()))]] =
      static_cast<char>('0' + random.below(10));
}

void change_word(std::string& text, const Part& part, Random& random) {
  static constexpr const char* kWords[][2] = {
      {" + ", " - "},  {"TRUE", "FALSE"}, {" AND ", " OR "},
      {"'", "'more "}, {" < ", " >= "},   {" := ", " := 1 + "},
      {";", "; ;"},    {" - ", " * "},    {"FALSE", "TRUE"},
      {";", ""},       {"(", "(("},       {"IF ", "IF NOT "},
  };
  for (int tries = 0; tries < 4; ++tries) {
    const auto& [from, to] = kWords[random.below(sizeof kWords / sizeof kWords[0])];
    const size_t at = text.find(
        from, part.begin + random.below(static_cast<uint32_t>(part.end - part.begin + 1)));
    if (at >= part.end) continue;
    text.replace(at, std::string(from).size(), to);
    return;
  }
}

void change_lines(std::string& text, const Part& part, Random& random) {
  const std::vector<size_t> lines = lines_of(text, part.begin, part.end);
  if (lines.size() < 2) return;
  const uint32_t number = random.below(static_cast<uint32_t>(lines.size() - 1));
  const std::string line = text.substr(lines[number], lines[number + 1] - lines[number]);
  const size_t to = lines[random.below(static_cast<uint32_t>(lines.size()))];
  switch (random.below(5)) {
    case 0:
      text.erase(lines[number], line.size());
      break;
    case 1:
      text.insert(to, line);
      break;
    case 2:
      text.insert(to, "\n");
      break;
    case 3:
      text.insert(to, "  (* a comment *)\n");
      break;
    default:
      text.insert(to, "  ;\n");
      break;
  }
}

}  // namespace

base::SourceMap one_file(const std::string& text) {
  base::SourceMap sources;
  sources.add("edited.st", text);
  return sources;
}

std::string edited(const std::string& text, Random& random) {
  std::string out = text;
  for (uint32_t edits = 1 + random.below(2); edits > 0; --edits) {
    const Part part = choose_part(out, random);
    const uint32_t kind = random.below(4);
    if (kind == 0) {
      change_number(out, part, random);
    } else if (kind == 1) {
      change_word(out, part, random);
    } else {
      change_lines(out, part, random);
    }
  }
  return out;
}

Outcome build_from_nothing(const base::SourceMap& sources, const workspace::Settings& settings) {
  Outcome outcome;
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program = frontend::compile(sources, settings.compile, diagnostics);
  outcome.messages = rendered(diagnostics, sources);
  if (!program) return outcome;
  base::Status optimised = ir::optimise(*program, settings.passes, false, 1);
  auto objects = ir::lower_all(*program, {}, 1);
  if (!optimised.ok() || !objects.ok()) {
    outcome.refusal = "not lowered";
    return outcome;
  }
  auto image = linker::link(*program, *objects, settings.link);
  if (image.ok()) {
    outcome.image = ir::encode(*image);
  } else {
    outcome.refusal = base::to_string(image.error());
  }
  return outcome;
}

Outcome build_again(workspace::IncrementalBuild& build, const base::SourceMap& sources) {
  Outcome outcome;
  base::Diagnostics diagnostics;
  auto image = build.build(sources, diagnostics);
  outcome.messages = rendered(diagnostics, sources);
  if (image.ok()) {
    outcome.image = ir::encode(**image);
  } else if (image.error().refusal != base::Refusal::kSourceErrors) {
    outcome.refusal = base::to_string(image.error());
  }
  return outcome;
}

std::string read_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

std::vector<std::string> sources_below(const std::string& folder) {
  std::vector<std::string> paths;
  const std::string root = tests::source_path(folder);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    if (entry.path().extension() == ".st") paths.push_back(entry.path().string());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

uint64_t seed_of(const std::string& path) {
  return base::name_hash(std::filesystem::path(path).filename().string());
}

}  // namespace test
