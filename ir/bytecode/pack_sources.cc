#include <algorithm>

#include "base/pack.h"
#include "base/tool_limits.h"
#include "ir/bytecode/embedded_sources.h"

namespace ir {
namespace {

base::Error too_many(uint64_t there, const char* of, uint32_t limit, const char* name) {
  return {base::Refusal::kTooMany, "the sources cannot travel with the image: " +
                                       std::to_string(there) + " " + of + ", the limit is " +
                                       std::to_string(limit) + " (" + name + ")"};
}

}  // namespace

base::Bytes encode_sources(const EmbeddedSources& sources) {
  base::ByteWriter out;
  if (sources.none()) return out.take();
  out.u32(static_cast<uint32_t>(sources.files.size()));
  for (const SourceFile& file : sources.files) {
    out.text(file.path);
    out.u32(file.size);
    out.raw(file.digest);
  }
  out.u32(static_cast<uint32_t>(sources.build.size()));
  for (const std::string& argument : sources.build) out.text(argument);
  out.blob(sources.packed);
  return out.take();
}

base::Result<EmbeddedSources> pack_sources(std::vector<SourceText> files,
                                           std::vector<std::string> build) {
  std::sort(files.begin(), files.end(),
            [](const SourceText& a, const SourceText& b) { return a.path < b.path; });
  uint64_t bytes = 0;
  for (const SourceText& file : files) bytes += file.text.size();
  if (bytes > base::kMaxEmbeddedBytes) {
    return too_many(bytes, "bytes", base::kMaxEmbeddedBytes, "kMaxEmbeddedBytes");
  }
  if (files.size() > base::kMaxEmbeddedFiles) {
    return too_many(files.size(), "files", base::kMaxEmbeddedFiles, "kMaxEmbeddedFiles");
  }
  base::Bytes all;
  all.reserve(bytes);
  EmbeddedSources out;
  for (const SourceText& file : files) {
    if (file.path.size() > base::kMaxEmbeddedPath) {
      return too_many(file.path.size(), "bytes of a path", base::kMaxEmbeddedPath,
                      "kMaxEmbeddedPath");
    }
    const base::ByteSpan text = base::as_bytes(file.text);
    all.insert(all.end(), text.begin(), text.end());
    out.files.push_back({file.path, static_cast<uint32_t>(text.size()), base::sha256(text)});
  }
  out.build = std::move(build);
  out.packed = base::pack(all);
  if (base::Status sound = check_sources(out); !sound) return sound.error();
  return out;
}

}  // namespace ir
