#include "tools/stvm/compiler.h"

#include <algorithm>
#include <filesystem>
#include <optional>

#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/common/heap.h"
#include "tools/common/option_rows.h"
#include "tools/common/signed_content.h"

namespace stvm {

Sources sources_of(const tools::Options& options) {
  return {options.arguments(), tools::given_compile_options(options)};
}

std::vector<std::string> stc_arguments(std::vector<std::string> command, const Sources& sources) {
  command.insert(command.end(), sources.options.begin(), sources.options.end());
  command.push_back("--");
  command.insert(command.end(), sources.paths.begin(), sources.paths.end());
  return command;
}

bool is_image(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return false;
  base::Result<base::Bytes> first = tools::read_first(path, ir::kImageMagic.size());
  if (first.ok() && ir::has_image_magic(*first)) return true;
  return tools::is_signed_as(path, online_change::SignedKind::kImage);
}

base::Status check_compile_options(const Sources& sources) {
  const bool images = std::all_of(sources.paths.begin(), sources.paths.end(), is_image);
  if (sources.options.empty() || !images) return base::Ok{};
  const std::string option = sources.options[0].substr(0, sources.options[0].find('='));
  const std::string path = sources.paths.empty() ? "what is stored" : sources.paths[0];
  return base::Error{base::Refusal::kUsage,
                     option + " is for sources, and " + path + " is an image: leave it out"};
}

void expect_programs(const Sources& sources) {
  size_t bytes = 0;
  for (const std::string& path : sources.paths) {
    std::error_code error;
    const auto size = std::filesystem::file_size(path, error);
    // More or less, with all that is made of it until it runs.
    if (!error && is_image(path)) bytes += size + size / 2 * 5;
  }
  tools::expect_pieces(bytes);
}

base::Result<ir::VerifiedImage> load_program(const Sources& sources) {
  auto images = load_programs(sources);
  if (!images.ok()) return images.error();
  if (images->size() == 1) return std::move(images->front());
  return base::Error{base::Refusal::kUsage,
                     "the sources have several RESOURCEs; build them with stc, and name one image"};
}

base::Result<std::vector<ir::VerifiedImage>> load_programs(const Sources& sources) {
  std::optional<tools::TemporaryFolder> folder;  // of images that are made here
  std::vector<std::string> paths = sources.paths;
  if (!std::all_of(paths.begin(), paths.end(), is_image)) {
    base::Result<tools::TemporaryFolder> temporary = tools::TemporaryFolder::make();
    if (!temporary.ok()) return temporary.error();
    folder.emplace(std::move(*temporary));
    const std::string made = folder->file("images/");
    base::Status built =
        tools::run_beside("stc", stc_arguments({"build", "--quiet", "-o", made}, sources));
    if (!built.ok()) return built.error();
    paths.clear();
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(made, error)) {
      paths.push_back(entry.path().string());
    }
    std::sort(paths.begin(), paths.end());
  }
  std::vector<ir::VerifiedImage> images;
  for (const std::string& path : paths) {
    base::Result<base::Bytes> bytes = tools::read_content(path);
    if (!bytes.ok()) return bytes.error();
    base::Result<ir::VerifiedImage> image = ir::verify(std::move(*bytes));
    if (!image.ok()) return image.error();
    images.push_back(std::move(*image));
  }
  return images;
}

base::Result<base::Bytes> relink(const Sources& sources, base::ByteSpan running, bool move_all) {
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string base_file = folder->file("base.img");
  const std::string next_file = folder->file("next.img");
  base::Status written = tools::write_file(base_file, running);
  if (!written.ok()) return written.error();
  std::vector<std::string> command = {"build", "--quiet", "--base", base_file};
  if (move_all) command.push_back("--move-all");
  command.insert(command.end(), {"-o", next_file});
  base::Status built = tools::run_beside("stc", stc_arguments(std::move(command), sources),
                                         tools::Messages::kOnlyOfFailure);
  if (!built.ok()) return built.error();
  return tools::read_bytes(next_file);
}

}  // namespace stvm
