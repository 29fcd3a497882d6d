#include "tools/common/source_command.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "base/tool_limits.h"
#include "base/visible_text.h"
#include "tools/common/json.h"
#include "tools/common/source_files.h"
#include "tools/common/table.h"

namespace tools {
namespace {

constexpr size_t kSourceWidth = base::kMaxEmbeddedPath + 40;  // paths are shown whole

constexpr const char* kEmbeddedOptions[] = {"--name=",        "--dialect=", "--resource=",
                                            "--define=",      "--passes=",  "--no-opt",
                                            "--embed-sources"};

bool is_known(const std::string& argument) {
  return std::any_of(
      std::begin(kEmbeddedOptions), std::end(kEmbeddedOptions), [&](const std::string& option) {
        return option.ends_with('=') ? argument.starts_with(option) : argument == option;
      });
}

std::string for_shell(const std::string& text) {
  constexpr const char* kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./=,:+@%";
  if (!text.empty() && text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string out = "'";
  for (char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

using States = std::optional<std::vector<SourceState>>;

std::string text_of(const ir::EmbeddedSources& sources, const std::string& program,
                    const States& states, const std::string& folder) {
  Table table({"> bytes", states ? "state" : "", "source"});
  uint64_t bytes = 0;
  for (size_t i = 0; i < sources.files.size(); ++i) {
    const ir::SourceFile& file = sources.files[i];
    bytes += file.size;
    const char* const state = states ? source_state_name((*states)[i]) : "";
    table.row({std::to_string(file.size), state, file.path});
  }
  std::string out = table.text(kSourceWidth) + "\n" + std::to_string(sources.files.size()) +
                    " sources of " + program + ", " + std::to_string(bytes) + " bytes (" +
                    std::to_string(sources.packed.size()) + " in the image)";
  out += states ? ", in " + folder + "\n" : "; -o DIR writes them\n";
  if (states) out += "build: " + build_command(sources, folder) + "\n";
  return base::visible_lines(out);  // what somebody sent
}

std::string json_of(const ir::EmbeddedSources& sources, const std::string& program,
                    const States& states, const std::string& folder) {
  JsonWriter json;
  json.begin_object().field("program", program);
  if (states) json.field("folder", folder);
  json.key("sources").begin_array();
  for (size_t i = 0; i < sources.files.size(); ++i) {
    const ir::SourceFile& file = sources.files[i];
    json.begin_object().field("path", file.path).field("bytes", file.size);
    json.field("sha256", base::to_hex(file.digest));
    if (states) json.field("state", source_state_name((*states)[i]));
    json.end_object();
  }
  json.end_array().key("build").begin_array();
  for (const std::string& argument : sources.build) json.value(argument);
  json.end_array().end_object();
  return json.finish();
}

}  // namespace

base::Error no_sources(const std::string& program) {
  return {base::Refusal::kNoSources,
          "no sources travel with " + program + ": it was built without `embed_sources`"};
}

std::string build_command(const ir::EmbeddedSources& sources, const std::string& folder) {
  std::string out = "stc build";
  std::string paths;
  for (const std::string& argument : sources.build) {
    if (!argument.starts_with("--")) {
      paths += " " + for_shell((std::filesystem::path(folder) / argument).string());
    } else if (is_known(argument)) {
      out += " " + for_shell(argument);
    }
  }
  return out + (paths.empty() ? " " + for_shell(folder) : paths);
}

base::Result<std::string> bring_sources(base::ByteSpan image, const std::string& program,
                                        const Options& options, bool json) {
  base::Result<ir::EmbeddedSources> sources = ir::sources_of(image);
  if (!sources.ok()) return sources.error();
  if (sources->none()) return no_sources(program);
  const std::string folder = options.text("--output");
  States states;
  if (options.has("--output")) {
    base::Result<std::vector<ir::SourceText>> texts = ir::unpack_sources(*sources);
    if (!texts.ok()) return texts.error();
    auto written = write_sources(*texts, folder, options.has("--overwrite"));
    if (!written.ok()) return written.error();
    states = std::move(*written);
  }
  return json ? json_of(*sources, program, states, folder)
              : text_of(*sources, program, states, folder);
}

}  // namespace tools
