// Which files of the standard library a small project needs: those that declare a name that stands
// somewhere in its text, and what these need themselves. A comment or a member of that name counts
// too, so more may be parsed than is used, never less.
#pragma once

#include <cstdint>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "base/source.h"

namespace frontend {

class LibraryIndex {
 public:
  // Of the standard's own dialect, or else of the others. Made once for each; lives as long as the
  // process.
  static const LibraryIndex& of(bool iec);

  // Numbers among stdlib::library_sources(), rising: all that belong to the dialect.
  const std::vector<uint32_t>& all() const { return all_; }
  // The same, of what `sources` need. For sources that are so large that looking for names takes
  // longer than parsing the library: all.
  std::vector<uint32_t> needed(const base::SourceMap& sources) const;
  // Names of functions and function blocks, for "did you mean".
  const std::vector<std::string_view>& pous() const { return pous_; }

 private:
  explicit LibraryIndex(bool iec);
  // The files that declare a word of the text, each once, those in `seen` not again.
  void add_files(std::string_view text, std::vector<uint32_t>& files,
                 std::vector<bool>& seen) const;

  std::vector<uint32_t> all_;
  std::vector<std::string_view> pous_;
  std::unordered_multimap<uint64_t, uint32_t> files_;  // by base::name_hash() of a declared name
};

}  // namespace frontend
