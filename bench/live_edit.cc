// An edit of one POU in a large project, from the saved file to the running program: the tools as
// people use them, `stvm serve` and `stvm change --watch`, on this machine.
//
//   bench_live_edit --stc PATH --stvm PATH --sources FOLDER --out FOLDER --section NAME
//                   --title TEXT [--repeats N]
//
// Each edit gives one function block statements that it never had before. Writes NAME.json and
// NAME.md. Times are wall time, as stvm says them; the files are as they were in the end.
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "bench/edits.h"
#include "bench/measure.h"
#include "bench/project_sources.h"
#include "tools/common/child.h"

namespace {

constexpr int kPatienceMs = 60'000;

using Options = std::map<std::string, std::string>;

// Lines of a child's standard output.
class Lines {
 public:
  explicit Lines(tools::ConnectedChild& child) : socket_(child.take_socket()) {}
  ~Lines() { ::close(socket_); }
  Lines(const Lines&) = delete;
  Lines& operator=(const Lines&) = delete;

  // The next one that begins so.
  std::string next(const std::string& begin) {
    for (std::string line;;) {
      char c = 0;
      pollfd ready = {socket_, POLLIN, 0};
      const bool said = ::poll(&ready, 1, kPatienceMs) == 1 && ::read(socket_, &c, 1) == 1;
      base::check(said, ("the tool says `" + begin + "`").c_str());
      if (c != '\n') {
        line += c;
        continue;
      }
      if (line.starts_with(begin)) return line;
      line.clear();
    }
  }

 private:
  int socket_;
};

tools::ConnectedChild start(const std::vector<std::string>& command) {
  auto child = tools::ConnectedChild::start(command);
  base::check(child.ok(), "the tool starts");
  return std::move(*child);
}

// "running 95 ms after it was saved: seen 14.1, built 9.0, ..., and answered 150.3 later": the
// steps' names and times.
std::vector<std::pair<std::string, double>> steps_of(const std::string& line) {
  std::vector<std::pair<std::string, double>> steps;
  for (size_t at = line.find(": ") + 2; at < line.size();) {
    const size_t end = line.find(", ", at);
    const std::string step = line.substr(at, end - at);
    if (end == std::string::npos) break;
    const size_t space = step.rfind(' ');
    steps.emplace_back(step.substr(0, space), std::atof(step.c_str() + space));
    at = end + 2;
  }
  return steps;
}

// A task with time enough for all programs (one in each file), wherever this is measured.
std::string configuration(const base::SourceMap& sources) {
  std::string out =
      "CONFIGURATION Plant\nRESOURCE Line ON PLC\n  {attribute 'watchdog' := 'T#60s'}\n"
      "  TASK Main(INTERVAL := T#100ms, PRIORITY := 1);\n";
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    const std::string area = std::filesystem::path(sources.file_name(file)).stem().string();
    out += "  PROGRAM Run" + area + " WITH Main : " + area + ";\n";
  }
  return out + "END_RESOURCE\nEND_CONFIGURATION\n";
}

// As editors do it, in one step.
void save(const std::string& path, const std::string& text) {
  std::ofstream(path + ".new", std::ios::binary) << text;
  std::filesystem::rename(path + ".new", path);
}

std::string format(const char* how, double value) {
  char text[64];
  std::snprintf(text, sizeof text, how, value);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  for (const char* name : {"--stc", "--stvm", "--sources", "--out", "--section", "--title"}) {
    if (options[name].empty()) {
      std::fprintf(stderr, "bench_live_edit: %s is missing\n", name);
      return 2;
    }
  }
  const int repeats = options["--repeats"].empty() ? 9 : std::atoi(options["--repeats"].c_str());
  const std::string& stvm = options["--stvm"];
  const std::string state = options["--out"] + "/" + options["--section"] + ".state";
  const std::string image = options["--out"] + "/" + options["--section"] + ".img";
  const std::string tasks = options["--sources"] + "/tasks.st";
  std::filesystem::remove(tasks);  // of a run that was broken off
  uint64_t lines = 0;
  const base::SourceMap sources = bench::read_sources(options["--sources"], lines);
  const uint32_t file = sources.file_count() / 2;
  const std::string path(sources.file_name(file));
  const std::string original(sources.text(file));
  std::filesystem::remove_all(state);
  save(tasks, configuration(sources));
  base::check(
      bench::run_child({options["--stc"], "build", "-q", "-o", image, options["--sources"]}, false)
          .ok,
      "the project is built");
  tools::ConnectedChild serve = start({stvm, "serve", "--dir", state, image});
  Lines serving(serve);
  serving.next("ready");
  std::vector<std::pair<std::string, std::map<std::string, double>>> rows;
  std::vector<std::string> names;
  {
    tools::ConnectedChild change = start({stvm, "change", "--watch", "--yes", "--permanent",
                                          "--allow-overrun", "--dir", state, options["--sources"]});
    Lines changing(change);
    for (const bench::Edit& edit : bench::kEdits) {
      std::map<std::string, std::vector<double>> times;
      for (int i = 0; i < 2 * repeats + 2; ++i) {
        save(path, bench::edited(original, edit.text(static_cast<uint32_t>(i))));
        double all = 0;
        names.clear();
        for (const auto& [name, ms] : steps_of(changing.next("running "))) {
          if (i >= 2) times[name].push_back(ms);  // the first ones wait for the whole build
          names.push_back(name);
          all += ms;
        }
        if (i >= 2) times["all"].push_back(all);
      }
      rows.push_back({edit.what, {}});
      for (const auto& [name, values] : times) rows.back().second[name] = bench::median(values);
    }
    bench::run_child({stvm, "stop", "--dir", state}, true);
    save(path, bench::edited(original, bench::kEdits[0].text(0)));  // and the watch finds nobody
  }
  save(path, original);
  std::filesystem::remove(tasks);
  names.push_back("all");
  std::string page =
      "## " + options["--title"] + "\n\n" + std::to_string(lines) + " lines, an image of " +
      format("%.1f", static_cast<double>(std::filesystem::file_size(image)) / (1 << 20)) +
      " MiB; `stvm change --watch --yes --permanent --allow-overrun` and `stvm serve` on one "
      "machine. "
      "Milliseconds of wall time, medians; goal 100, of which 50 for the compiler "
      "(built and packed).\n\n| edit |";
  std::string rule = "\n| --- |";
  for (const std::string& name : names) {
    page += " " + name + " |";
    rule += " ---: |";
  }
  page += rule + "\n";
  std::string json = "{\"lines\": " + std::to_string(lines) + ", \"edits\": [";
  const char* comma = "";
  for (const auto& [what, times] : rows) {
    page += "| " + what + " |";
    json += std::string(comma) + "\n  {\"name\": \"" + what + "\"";
    std::printf("%-24s", what.c_str());
    for (const std::string& name : names) {
      const double ms = times.at(name);
      page += " " + format("%.1f", ms) + " |";
      json += ", \"" + name + "\": " + format("%.2f", ms);
      std::printf("  %s %.1f", name.c_str(), ms);
    }
    page += "\n";
    json += "}";
    std::printf("\n");
    comma = ",";
  }
  const std::string out = options["--out"] + "/" + options["--section"];
  std::ofstream(out + ".md") << page;
  std::ofstream(out + ".json") << json << "\n]}\n";
  std::filesystem::remove_all(state);
  std::filesystem::remove(image);
  return 0;
}
