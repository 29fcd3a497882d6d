// mistakes [--limits FILE] [--show OPERATOR] [--places N] PATH...: every .st file that compiles,
// with one mistake at a time. Per kind of mistake: how often nothing was said, how often too much,
// how often the first message was far away, in tenths of a percent. With --limits: fails when a
// figure is above the one in FILE (a ratchet: figures may only go down).
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <sstream>

#include "frontend/compile.h"
#include "tests/mistakes/mistakes.h"

namespace {

using mistakes::Mistaken;
using mistakes::Operator;
using mistakes::Original;

constexpr size_t kMaxMessages = 4;
constexpr uint32_t kMaxLines = 3;

struct Options {
  std::string limits;
  std::string show;
  size_t places = 8;  // per kind of mistake and file
  std::vector<std::string> paths;
};

struct Figures {
  uint32_t places = 0;
  uint32_t silent = 0;
  uint32_t many = 0;
  uint32_t far = 0;
  uint32_t messages = 0;
  uint32_t permille(uint32_t count) const { return places == 0 ? 0 : count * 1000 / places; }
};

base::Diagnostics compiled(const std::string& text, base::SourceMap& sources) {
  sources.add("mistaken.st", text);
  base::Diagnostics diagnostics;
  if (text.find("END_TEST") == std::string::npos) {
    frontend::compile(sources, {}, diagnostics);
  } else {
    frontend::compile_tests(sources, {}, diagnostics);
  }
  diagnostics.sort();
  return diagnostics;
}

uint32_t distance(uint32_t a, uint32_t b) { return a > b ? a - b : b - a; }

// The message, or one of its notes, stands near the mistake.
bool is_near(const base::Diagnostic& message, const base::SourceMap& sources, uint32_t line) {
  std::vector<base::SourceSpan> spans = {message.span};
  for (const base::DiagnosticNote& note : message.notes) spans.push_back(note.span);
  return std::any_of(spans.begin(), spans.end(), [&](const base::SourceSpan& span) {
    return distance(sources.locate(span.begin).line, line) <= kMaxLines;
  });
}

void print_case(const char* what, const Mistaken& mistaken, const std::string& file,
                const base::Diagnostics& diagnostics, const base::SourceMap& sources) {
  base::SourceLocation at = sources.locate({mistaken.at});
  std::printf("%s %s:%u:%u: %s\n", what, file.c_str(), at.line, at.column,
              std::string(at.line_text).c_str());
  for (const base::Diagnostic& message : diagnostics.all()) {
    if (base::diagnostic_row(message.code).severity != base::Severity::kError) continue;
    base::SourceLocation place = sources.locate(message.span.begin);
    std::printf("    %u:%u %s\n", place.line, place.column, message.text.c_str());
  }
}

void examine(const Mistaken& mistaken, const std::string& file, bool show, Figures& figures) {
  base::SourceMap sources;
  base::Diagnostics diagnostics = compiled(mistaken.text, sources);
  ++figures.places;
  const base::Diagnostic* first = nullptr;
  size_t errors = 0;
  for (const base::Diagnostic& message : diagnostics.all()) {
    if (base::diagnostic_row(message.code).severity != base::Severity::kError) continue;
    if (errors++ == 0) first = &message;
  }
  figures.messages += static_cast<uint32_t>(errors);
  uint32_t line = sources.locate({mistaken.at}).line;
  const char* what = nullptr;
  if (first == nullptr) {
    ++figures.silent;
    what = "SILENT";
  } else {
    if (errors > kMaxMessages) {
      ++figures.many;
      what = "MANY";
    }
    if (!is_near(*first, sources, line)) {
      ++figures.far;
      what = "FAR";
    }
  }
  if (show && what != nullptr) print_case(what, mistaken, file, diagnostics, sources);
}

// Places are spread over the whole file.
void examine_file(const std::string& file, const Options& options,
                  std::map<std::string, Figures>& table) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  Original original = mistakes::read(text.str());
  base::SourceMap sources;
  if (compiled(original.text, sources).has_errors()) return;
  for (const Operator& op : mistakes::operators()) {
    std::vector<size_t> places;
    for (size_t token = 0; token + 1 < original.tokens.size(); ++token) {
      if (op.applies(original, token)) places.push_back(token);
    }
    size_t step = std::max<size_t>(1, places.size() / options.places);
    for (size_t i = 0; i < places.size(); i += step) {
      examine(mistakes::apply(op, original, places[i]), file, options.show == op.name,
              table[op.name]);
    }
  }
}

void print_table(const std::map<std::string, Figures>& table) {
  std::printf("%-28s %7s %7s %7s %7s %9s\n", "mistake", "places", "silent", "many", "far",
              "messages");
  for (const Operator& op : mistakes::operators()) {
    auto found = table.find(op.name);
    if (found == table.end()) continue;
    const Figures& row = found->second;
    std::printf("%-28s %7u %6.1f%% %6.1f%% %6.1f%% %9.2f\n", op.name, row.places,
                row.permille(row.silent) / 10.0, row.permille(row.many) / 10.0,
                row.permille(row.far) / 10.0,
                static_cast<double>(row.messages) / std::max(row.places, 1u));
  }
}

// Lines "SILENT MANY FAR NAME", in tenths of a percent.
bool within_limits(const std::string& path, const std::map<std::string, Figures>& table) {
  std::ifstream in(path);
  bool good = in.good();
  std::set<std::string> limited;
  for (std::string line; std::getline(in, line);) {
    std::istringstream stream(line);
    uint32_t silent = 0;
    uint32_t many = 0;
    uint32_t far = 0;
    std::string name;
    if (line.empty() || line[0] == '#' || !(stream >> silent >> many >> far)) continue;
    std::getline(stream >> std::ws, name);
    limited.insert(name);
    auto found = table.find(name);
    if (found == table.end()) continue;
    const Figures& row = found->second;
    bool holds = row.permille(row.silent) <= silent && row.permille(row.many) <= many &&
                 row.permille(row.far) <= far;
    if (!holds) std::printf("%s: above its limit %u %u %u\n", name.c_str(), silent, many, far);
    good = good && holds;
  }
  for (const auto& [name, row] : table) {
    if (limited.contains(name)) continue;
    std::printf("%s: no limit in %s\n", name.c_str(), path.c_str());
    good = false;
  }
  return good;
}

std::vector<std::string> files_of(const std::vector<std::string>& paths) {
  std::vector<std::string> out;
  for (const std::string& path : paths) {
    if (!std::filesystem::is_directory(path)) {
      out.push_back(path);
      continue;
    }
    for (const auto& entry : std::filesystem::recursive_directory_iterator(path)) {
      if (entry.path().extension() == ".st") out.push_back(entry.path());
    }
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--limits") == 0 && more) {
      options.limits = argv[++i];
    } else if (std::strcmp(argv[i], "--show") == 0 && more) {
      options.show = argv[++i];
    } else if (std::strcmp(argv[i], "--places") == 0 && more) {
      options.places = std::max<size_t>(1, std::strtoull(argv[++i], nullptr, 10));
    } else {
      options.paths.emplace_back(argv[i]);
    }
  }
  if (options.paths.empty()) {
    std::fprintf(stderr, "usage: mistakes [--limits FILE] [--show NAME] [--places N] PATH...\n");
    return 2;
  }
  std::map<std::string, Figures> table;
  for (const std::string& file : files_of(options.paths)) examine_file(file, options, table);
  print_table(table);
  return options.limits.empty() || within_limits(options.limits, table) ? 0 : 1;
}
