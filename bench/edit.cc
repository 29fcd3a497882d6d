// An edit of one POU in a large project: how long the resident compiler (workspace/) takes from new
// source texts to the new image's bytes.
//
//   bench_edit --sources FOLDER --out FOLDER --section NAME --title TEXT [--repeats N]
//
// Each edit gives one function block other statements; the image of the last one is compared with
// that of a build from nothing. Writes NAME.json and NAME.md. Times are processor time.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <vector>

#include "base/diagnostics.h"
#include "bench/edits.h"
#include "bench/measure.h"
#include "bench/project_sources.h"
#include "ir/bytecode/image_beside.h"
#include "tools/common/heap.h"
#include "workspace/incremental_build.h"

namespace {

using Options = std::map<std::string, std::string>;

struct Row {
  std::string name;
  double build_ms;
  double encode_ms;
};

template <class T>
T taken(base::Result<T> result) {
  base::check(result.ok(), result.ok() ? "" : base::to_string(result.error()).c_str());
  return std::move(*result);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) options[argv[i]] = argv[i + 1];
  for (const char* name : {"--sources", "--out", "--section", "--title"}) {
    if (options[name].empty()) {
      std::fprintf(stderr, "bench_edit: %s is missing\n", name);
      return 2;
    }
  }
  const int repeats = options["--repeats"].empty() ? 9 : std::atoi(options["--repeats"].c_str());
  bench::pin_to_one_core();
  tools::keep_freed_memory();  // as stc does
  uint64_t lines = 0;
  base::SourceMap sources = bench::read_sources(options["--sources"], lines);
  const uint32_t file = sources.file_count() / 2;
  const std::string original(sources.text(file));
  workspace::IncrementalBuild build({});
  ir::Image before;
  ir::WrittenImage written;
  // As `stc package --watch` does, which knows what runs.
  const auto built = [&](double& build_ms, double& encode_ms) {
    base::Diagnostics messages;
    const double begin = bench::cpu_seconds();
    const ir::Image* image = taken(build.build(sources, {file}, messages));
    const double linked = bench::cpu_seconds();
    const ir::KnownImage known{before, written.bytes, written.places};
    written = ir::encode(*image, written.bytes.empty() ? nullptr : &known);
    build_ms = (linked - begin) * 1e3;
    encode_ms = (bench::cpu_seconds() - linked) * 1e3;
    before = *image;
  };
  double whole_ms = 0;
  double whole_encode_ms = 0;
  built(whole_ms, whole_encode_ms);
  std::vector<Row> rows{{"from nothing", whole_ms, whole_encode_ms}};
  for (const bench::Edit& edit : bench::kEdits) {
    std::vector<double> build_ms;
    std::vector<double> encode_ms;
    for (int i = 0; i < 2 * repeats; ++i) {
      sources.replace(file, bench::edited(original, edit.text(static_cast<uint32_t>(i))));
      built(build_ms.emplace_back(), encode_ms.emplace_back());
    }
    rows.push_back({edit.what, bench::median(build_ms), bench::median(encode_ms)});
    base::Diagnostics messages;
    workspace::IncrementalBuild anew({});
    const base::Bytes clean = ir::encode(*taken(anew.build(sources, messages)));
    base::check(clean == written.bytes, "an edit gives the image of a build from nothing");
  }
  std::printf("whole builds %llu, edits %llu, bodies %llu\n",
              static_cast<unsigned long long>(build.counts().whole),
              static_cast<unsigned long long>(build.counts().edits),
              static_cast<unsigned long long>(build.counts().lowered));
  std::string json = "{\"lines\": " + std::to_string(lines) + ", \"edits\": [";
  std::string page = "## " + options["--title"] + "\n\n" + std::to_string(lines) +
                     " lines, an image of the whole project after an edit of one function block. "
                     "Processor time on one core, medians.\n\n"
                     "| edit | image, ms | its bytes, ms |\n| --- | ---: | ---: |\n";
  const char* comma = "";
  for (const Row& row : rows) {
    char text[200];
    std::snprintf(text, sizeof text, "%-30s %10.1f %10.1f\n", row.name.c_str(), row.build_ms,
                  row.encode_ms);
    std::fputs(text, stdout);
    std::snprintf(text, sizeof text, "| %s | %.1f | %.1f |\n", row.name.c_str(), row.build_ms,
                  row.encode_ms);
    page += text;
    std::snprintf(text, sizeof text, "%s\n  {\"name\": \"%s\", \"ms\": %.2f, \"encode_ms\": %.2f}",
                  comma, row.name.c_str(), row.build_ms, row.encode_ms);
    json += text;
    comma = ",";
  }
  const std::string path = options["--out"] + "/" + options["--section"];
  std::ofstream(path + ".md") << page;
  std::ofstream(path + ".json") << json << "\n]}\n";
  return 0;
}
