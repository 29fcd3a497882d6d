#include "frontend/lex/library_index.h"

#include <algorithm>

#include "base/name_case.h"
#include "stdlib/sources.h"

namespace frontend {
namespace {

// In bytes. Looking through so much text takes about as long as parsing the whole library.
constexpr size_t kLarge = 256 * 1024;

// Of the compiler itself: the record of an input of type ANY, and what charts keep.
constexpr std::string_view kAlways[] = {"<stdlib>/any.st", "<stdlib>/sfc.st"};

bool begins_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' ||
         static_cast<unsigned char>(c) >= 0x80;
}
bool is_in_word(char c) { return begins_word(c) || (c >= '0' && c <= '9'); }

// The words of a text, one after the other; empty at its end.
class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::string_view next() {
    while (at_ < text_.size() && !begins_word(text_[at_])) ++at_;
    const size_t begin = at_;
    while (at_ < text_.size() && is_in_word(text_[at_])) ++at_;
    return text_.substr(begin, at_ - begin);
  }

 private:
  std::string_view text_;
  size_t at_ = 0;
};

}  // namespace

const LibraryIndex& LibraryIndex::of(bool iec) {
  static const LibraryIndex kIec(true);
  static const LibraryIndex kVendors(false);
  return iec ? kIec : kVendors;
}

LibraryIndex::LibraryIndex(bool iec) {
  const auto sources = stdlib::library_sources();
  for (uint32_t file = 0; file < sources.size(); ++file) {
    if (!stdlib::is_of_dialect(sources[file], iec)) continue;
    all_.push_back(file);
    Words pous(sources[file].pous);
    for (std::string_view name = pous.next(); !name.empty(); name = pous.next()) {
      pous_.push_back(name);
      files_.emplace(base::name_hash(name), file);
    }
    Words types(sources[file].types);
    for (std::string_view name = types.next(); !name.empty(); name = types.next()) {
      files_.emplace(base::name_hash(name), file);
    }
  }
}

void LibraryIndex::add_files(std::string_view text, std::vector<uint32_t>& files,
                             std::vector<bool>& seen) const {
  Words words(text);
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    const auto [first, last] = files_.equal_range(base::name_hash(word));
    for (auto row = first; row != last; ++row) {
      if (seen[row->second]) continue;
      seen[row->second] = true;
      files.push_back(row->second);
    }
  }
}

std::vector<uint32_t> LibraryIndex::needed(const base::SourceMap& sources) const {
  size_t bytes = 0;
  for (uint32_t file = 0; file < sources.file_count(); ++file) bytes += sources.text(file).size();
  if (bytes > kLarge) return all_;
  const auto library = stdlib::library_sources();
  std::vector<uint32_t> files;
  std::vector<bool> seen(library.size());
  for (const uint32_t file : all_) {
    for (const std::string_view name : kAlways)
      seen[file] = seen[file] || library[file].name == name;
    if (seen[file]) files.push_back(file);
  }
  for (uint32_t file = 0; file < sources.file_count(); ++file) {
    add_files(sources.text(file), files, seen);
  }
  for (size_t i = 0; i < files.size(); ++i) add_files(library[files[i]].text, files, seen);
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace frontend
