// stc draw: bodies in ladder, FBD and SFC as pictures.
#include <cstdio>
#include <filesystem>
#include <set>

#include "frontend/compile.h"
#include "frontend/draw/picture.h"
#include "tools/common/files.h"
#include "tools/stc/commands.h"
#include "tools/stc/live_values.h"
#include "tools/stc/session.h"

namespace stc {
namespace {

constexpr uint64_t kPictureWidth = 1200;  // a screen, or paper across

constexpr tools::OptionRow kDrawOptions[] = {
    TOOLS_COMPILE_OPTIONS,
    {"--output|-o", "FILE|DIR", "FILE.svg for one picture, or a folder for all (default: stdout)"},
    {"--live", "HOST|DIR", "colour what is powered and active there now, and show values"},
    {"--values", "FILE", "the same with values from a file, NAME=VALUE a line"},
    {"--width", "PIXELS", "a longer rung goes on below (default 1200; 0: it never does)"},
    {"--plain", nullptr, "leave out addresses and comments of operands"},
    {"--instance", "PATH", "whose values: Line.Filler (default: the name of the program)"},
};
constexpr tools::Command kDrawCommand{"draw", "PATHS... [POU]",
                                      "Draws ladder, function block diagrams and charts as SVG.",
                                      kDrawOptions, 1};

// A POU, action or method whose body is a drawing.
struct Drawn {
  std::string name;  // Motor, Motor.Reset, Drives.Motor
  const frontend::PouDecl* pou = nullptr;
  const frontend::PouDecl* owner = nullptr;
};

void collect(const frontend::PouDecl& pou, const frontend::PouDecl* owner,
             const std::string& prefix, std::vector<Drawn>& out) {
  std::string name = prefix + std::string(pou.name.text);
  bool drawn = pou.chart != frontend::kNoChart || pou.diagram != frontend::kNoDiagram;
  if (drawn) out.push_back({name, &pou, owner});
  for (const frontend::PouDecl& member : pou.members) {
    collect(member, owner == nullptr ? &pou : owner, name + '.', out);
  }
}

// "A.B." in NAMESPACE A.B.
std::string space_of(const frontend::Tree& tree, frontend::ScopeId scope) {
  std::string out;
  for (; tree.in_namespace(scope); scope = tree[scope].parent) {
    out = std::string(tree[scope].name.text) + '.' + out;
  }
  return out;
}

const char* kind_word(frontend::PouKind kind) {
  switch (kind) {
    case frontend::PouKind::kFunction:
      return "FUNCTION ";
    case frontend::PouKind::kFunctionBlock:
      return "FUNCTION_BLOCK ";
    case frontend::PouKind::kProgram:
      return "PROGRAM ";
    case frontend::PouKind::kMethod:
      return "METHOD ";
    case frontend::PouKind::kAction:
      return "ACTION ";
    default:
      return "";
  }
}

// A last argument that names no file is a POU.
struct Selection {
  std::vector<std::string> paths;
  std::string pou;
};
Selection selection(const tools::Options& options) {
  Selection out{options.arguments(), {}};
  std::error_code ignored;
  bool named = out.paths.size() > 1 && !std::filesystem::exists(out.paths.back(), ignored) &&
               out.paths.back().find('/') == std::string::npos &&
               !out.paths.back().ends_with(".st");
  if (!named) return out;
  out.pou = out.paths.back();
  out.paths.pop_back();
  return out;
}

class Artist {
 public:
  Artist(const tools::Options& options, const Project& project, const frontend::Tree& tree,
         uint64_t width)
      : options_(options), project_(project), tree_(tree), width_(static_cast<double>(width)) {}

  base::Result<std::string> draw(const Drawn& drawn) {
    frontend::draw::Live live(instance(drawn));
    bool shown = options_.has("--live") || options_.has("--values");
    if (options_.has("--values")) {
      base::Status read = read_values(options_.text("--values"), live);
      if (!read.ok()) return read.error();
    }
    if (options_.has("--live")) {
      base::Status fetched = fetch_values(options_.text("--live"), names(drawn), live);
      if (!fetched.ok()) return fetched.error();
    }
    const frontend::draw::Live* values = shown ? &live : nullptr;
    std::string title = kind_word(drawn.pou->kind) + drawn.name;
    if (shown && !instance(drawn).empty()) title += "  (" + instance(drawn) + ')';
    if (drawn.pou->chart != frontend::kNoChart) {
      return frontend::draw::draw_chart(tree_, project_.sources, tree_.charts[drawn.pou->chart],
                                        title, values);
    }
    const frontend::draw::Notes notes =
        frontend::draw::notes_of(tree_, project_.sources, *drawn.pou, drawn.owner);
    frontend::draw::Look look{values, options_.has("--plain") ? nullptr : &notes, width_};
    return frontend::draw::draw_body(tree_.diagrams[drawn.pou->diagram], title, look);
  }

 private:
  std::string instance(const Drawn& drawn) const {
    if (options_.has("--instance")) return options_.text("--instance");
    const frontend::PouDecl& pou = drawn.owner != nullptr ? *drawn.owner : *drawn.pou;
    bool program = pou.kind == frontend::PouKind::kProgram;
    return program ? std::string(pou.name.text) : std::string();
  }

  std::vector<std::string> names(const Drawn& drawn) const {
    std::set<std::string> out;
    std::string own = instance(drawn);
    auto add = [&](const std::string& path) {
      if (!own.empty()) out.insert(own + '.' + path);
      out.insert(path);
    };
    std::vector<std::string> paths =
        drawn.pou->chart != frontend::kNoChart
            ? frontend::draw::variables(tree_, project_.sources, tree_.charts[drawn.pou->chart])
            : frontend::draw::variables(tree_.diagrams[drawn.pou->diagram]);
    for (const std::string& path : paths) add(path);
    return {out.begin(), out.end()};
  }

  const tools::Options& options_;
  const Project& project_;
  const frontend::Tree& tree_;
  double width_;
};

std::string list(const std::vector<Drawn>& drawn) {
  std::string out;
  for (const Drawn& one : drawn) out += (out.empty() ? "" : ", ") + one.name;
  return out;
}

base::Status write(const std::string& file, const std::string& text) {
  return tools::write_file(file, base::as_bytes(text));
}

base::Status draw_all(const tools::Options& options, Artist& artist,
                      const std::vector<Drawn>& drawn) {
  std::string output = options.text("--output");
  bool folder = !output.empty() && !output.ends_with(".svg");
  if (!folder && drawn.size() != 1) {
    return base::Error{base::Refusal::kUsage,
                       "draw: name one of " + list(drawn) + ", or a folder with -o"};
  }
  std::error_code failed;
  if (folder) std::filesystem::create_directories(output, failed);
  for (const Drawn& one : drawn) {
    base::Result<std::string> picture = artist.draw(one);
    if (!picture.ok()) return picture.error();
    if (output.empty()) {
      std::fputs(picture->c_str(), stdout);
      continue;
    }
    base::Status written = write(folder ? output + '/' + one.name + ".svg" : output, *picture);
    if (!written.ok()) return written;
  }
  return base::Ok{};
}

base::Status draw(const tools::Options& options) {
  base::Result<uint64_t> width = options.number("--width", kPictureWidth);
  if (!width.ok()) return width.error();
  Selection chosen = selection(options);
  base::Result<Project> project = open_project(options, chosen.paths);
  if (!project.ok()) return project.error();
  frontend::Tree tree;
  base::Diagnostics diagnostics = diagnostics_of(*project);
  frontend::parse_all(project->sources, project->compile, tree, diagnostics);
  report(*project, diagnostics, base::DiagnosticFormat::kText);
  if (diagnostics.has_errors()) {
    return base::Error{base::Refusal::kSourceErrors, "draw: the sources have errors"};
  }
  std::vector<Drawn> drawn;
  for (const frontend::PouDecl& pou : tree.pous) {
    collect(pou, nullptr, space_of(tree, pou.scope), drawn);
  }
  std::vector<Drawn> all = drawn;
  if (!chosen.pou.empty()) {
    std::erase_if(drawn, [&](const Drawn& one) { return !ir::same_name(one.name, chosen.pou); });
  }
  if (drawn.empty()) {
    std::string there =
        all.empty() ? "nothing there is drawn in ladder, FBD or SFC" : "there are " + list(all);
    return base::Error{
        base::Refusal::kUsage,
        chosen.pou.empty() ? "draw: " + there : "draw: no drawing `" + chosen.pou + "`; " + there};
  }
  Artist artist(options, *project, tree, *width);
  return draw_all(options, artist, drawn);
}

int run_draw(const tools::Options& options) {
  base::Status drawn = draw(options);
  return drawn.ok() ? tools::kOk : tools::refuse("stc", drawn.error());
}

}  // namespace

const Entry kDraw{&kDrawCommand, run_draw};

}  // namespace stc
