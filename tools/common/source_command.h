// What `stvm source` and `stc source` do with the sources that travel with a program (X9): they
// list them, or write them as files, and say how the same program is built of them.
#pragma once

#include <string>

#include "base/result.h"
#include "ir/bytecode/embedded_sources.h"
#include "tools/common/option_rows.h"

namespace tools {

#define TOOLS_SOURCE_OPTIONS                                                                  \
  {"--output|-o", "DIR", "write the sources into this folder; without it they are listed"}, { \
    "--overwrite", nullptr, "replace files there that differ"                                 \
  }

// The text for people, or JSON, of the sources that are in an image. `program`: what it is for
// messages. Errors: kFileNotFound when none travel, kBadFormat, those of write_sources().
base::Result<std::string> bring_sources(base::ByteSpan image, const std::string& program,
                                        const Options& options, bool json);

// As a shell takes it, of the options that this version of stc has.
std::string build_command(const ir::EmbeddedSources& sources, const std::string& folder);

base::Error no_sources(const std::string& program);

}  // namespace tools
