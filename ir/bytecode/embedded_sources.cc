#include "ir/bytecode/embedded_sources.h"

#include <algorithm>

#include "base/pack.h"
#include "base/tool_limits.h"
#include "ir/bytecode/image_sections.h"

namespace ir {
namespace {

constexpr size_t kMaxBuild = 1024;  // arguments of a build

base::Error bad_sources(std::string text) {
  return {base::Refusal::kBadSources, "image: " + std::move(text)};
}

bool is_printable(std::string_view text) {
  return std::none_of(text.begin(), text.end(),
                      [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; });
}

std::string quoted(std::string_view path) {
  return "`" + std::string(path.substr(0, base::kMaxEmbeddedPath)) + "`";
}

bool has_file(const std::vector<SourceFile>& files, std::string_view path) {
  const auto at = std::lower_bound(
      files.begin(), files.end(), path,
      [](const SourceFile& file, std::string_view wanted) { return file.path < wanted; });
  return at != files.end() && at->path == path;
}

// Is a folder on the way to it the name of a file, too?
bool leads_through_file(const std::vector<SourceFile>& files, std::string_view path) {
  for (size_t slash = path.find('/'); slash != std::string_view::npos;
       slash = path.find('/', slash + 1)) {
    if (has_file(files, path.substr(0, slash))) return true;
  }
  return false;
}

base::Status check_paths(const std::vector<SourceFile>& files) {
  if (files.size() > base::kMaxEmbeddedFiles) {
    return bad_sources(std::to_string(files.size()) + " sources; the limit is " +
                       std::to_string(base::kMaxEmbeddedFiles));
  }
  for (size_t i = 0; i < files.size(); ++i) {
    const std::string& path = files[i].path;
    if (!is_path_below(path))
      return bad_sources("source " + quoted(path) + ": no path below a folder");
    if (i != 0 && !(files[i - 1].path < path)) {
      return bad_sources("source " + quoted(path) + ": not sorted, or there twice");
    }
  }
  for (const SourceFile& file : files) {
    if (!leads_through_file(files, file.path)) continue;
    return bad_sources("source " + quoted(file.path) +
                       ": a folder on the way to it is a source, too");
  }
  return base::Ok{};
}

base::Status check_build(const std::vector<std::string>& build) {
  if (build.size() > kMaxBuild)
    return bad_sources(std::to_string(build.size()) + " arguments of a build");
  for (const std::string& argument : build) {
    const bool option = argument.starts_with("--") && argument.size() <= base::kMaxEmbeddedPath &&
                        is_printable(argument);
    if (!option && !is_path_below(argument)) return bad_sources("argument " + quoted(argument));
  }
  return base::Ok{};
}

}  // namespace

bool is_path_below(std::string_view path) {
  if (path.size() > base::kMaxEmbeddedPath || !is_printable(path)) return false;
  for (;;) {
    const size_t slash = path.find('/');
    const std::string_view part = path.substr(0, slash);
    if (part.empty() || part.front() == '.') return false;
    if (slash == std::string_view::npos) return true;
    path.remove_prefix(slash + 1);
  }
}

base::Status check_sources(const EmbeddedSources& sources) {
  if (base::Status s = check_paths(sources.files); !s) return s;
  if (base::Status s = check_build(sources.build); !s) return s;
  uint64_t bytes = 0;
  for (const SourceFile& file : sources.files) bytes += file.size;
  if (bytes > base::kMaxEmbeddedBytes) {
    return bad_sources("sources of " + std::to_string(bytes) + " bytes; the limit is " +
                       std::to_string(base::kMaxEmbeddedBytes));
  }
  if (base::unpacked_size(sources.packed, bytes) == bytes) return base::Ok{};
  return bad_sources("the packed sources do not become the " + std::to_string(bytes) +
                     " bytes that their files have");
}

base::Result<EmbeddedSources> decode_sources(base::ByteSpan section) {
  constexpr size_t kSmallestFile = 8 + sizeof(base::Digest);
  base::ByteReader in(section);
  EmbeddedSources out;
  out.files.resize(in.count(kSmallestFile));
  for (SourceFile& file : out.files) {
    file.path = in.text();
    file.size = in.u32();
    const base::ByteSpan digest = in.raw(sizeof file.digest);
    std::copy(digest.begin(), digest.end(), file.digest.begin());
  }
  out.build.resize(in.count(4));
  for (std::string& argument : out.build) argument = in.text();
  const base::ByteSpan packed = in.blob();
  if (!in.done())
    return bad_sources("section `sources` is damaged at its byte " + std::to_string(in.at()));
  if (out.none()) return bad_sources("section `sources` has none");
  out.packed.assign(packed.begin(), packed.end());
  if (base::Status sound = check_sources(out); !sound) return sound.error();
  return out;
}

base::Result<EmbeddedSources> sources_of(base::ByteSpan encoded) {
  const base::ByteSpan section = section_of(encoded, ImageSection::kSources);
  if (section.empty()) return EmbeddedSources();
  return decode_sources(section);
}

base::Result<std::vector<SourceText>> unpack_sources(const EmbeddedSources& sources) {
  if (base::Status s = check_sources(sources); !s) return s.error();
  const std::optional<base::Bytes> all = base::unpack(sources.packed, base::kMaxEmbeddedBytes);
  if (!all) return bad_sources("the packed sources are damaged");
  base::ByteReader in(*all);
  std::vector<SourceText> texts;
  for (const SourceFile& file : sources.files) {
    const base::ByteSpan text = in.raw(file.size);
    if (base::sha256(text) != file.digest) {
      return bad_sources("source " + quoted(file.path) + ": its text is not that of the build");
    }
    texts.push_back({file.path, std::string(text.begin(), text.end())});
  }
  return texts;
}

}  // namespace ir
