// The sources that a program was made of, where they travel with its image (X9: `embed_sources` of
// stc.toml). A controller carries them and never unpacks them: what they hold has no meaning to it.
// Tools bring them back as files, so each path leads below the folder that somebody names for
// them, and nowhere else. Rules: check_sources(). They are the last section of the stored
// form only: ir::Image has nothing of them, and decode(), so verify(), checks them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"

namespace ir {

struct SourceFile {
  std::string path;  // from the folder of the project; parts are separated by `/`
  uint32_t size = 0;
  base::Digest digest{};  // of its text
};

struct EmbeddedSources {
  std::vector<SourceFile> files;   // sorted by path; none: they do not travel
  std::vector<std::string> build;  // what `stc build` was told: `--name=plant`, paths of sources
  base::Bytes packed;              // texts of all files, one after the other (base/pack.h)
  bool none() const { return files.empty(); }
};

// Relative, without `.`, `..` and hidden parts, and without control characters.
bool is_path_below(std::string_view path);
// Errors: kBadFormat.
base::Status check_sources(const EmbeddedSources& sources);

// The section; empty where none travel.
base::Bytes encode_sources(const EmbeddedSources& sources);
// What is in it, checked.
base::Result<EmbeddedSources> decode_sources(base::ByteSpan section);
// The sources of an image that is sound; none where it has none.
base::Result<EmbeddedSources> sources_of(base::ByteSpan encoded);

struct SourceText {
  std::string path;
  std::string text;
};
// In any order; sorted by path in the result. Errors: kTooMany, kBadFormat.
base::Result<EmbeddedSources> pack_sources(std::vector<SourceText> files,
                                           std::vector<std::string> build);
// kBadFormat when a text is not what its digest says.
base::Result<std::vector<SourceText>> unpack_sources(const EmbeddedSources& sources);

}  // namespace ir
