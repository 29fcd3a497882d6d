#include "tests/golden/runner/state_texts.h"

#include <algorithm>
#include <string_view>

#include "ir/bytecode/symbols.h"

namespace golden {
namespace {

constexpr size_t kMostBytes = size_t{64} << 20;  // of memories that are kept

}  // namespace

std::string StateTexts::text(const ir::VerifiedImage& image, std::span<const uint8_t> memory) {
  // What is behind the areas, gigabytes of it, nobody has written.
  memory = memory.first(std::min<size_t>(memory.size(), image.image().data_capacity));
  const auto* bytes = reinterpret_cast<const char*>(memory.data());
  const size_t hash = std::hash<std::string_view>()({bytes, memory.size()});
  const auto [first, last] = known_.equal_range(hash);
  const auto found = std::find_if(first, last, [&](const auto& entry) {
    return entry.second.image == image.digest() && std::ranges::equal(entry.second.memory, memory);
  });
  if (found != last) return found->second.text;
  std::string text = ir::state_text(image.image(), memory);
  size_ += memory.size();
  if (size_ <= kMostBytes) {
    known_.insert({hash, {image.digest(), {memory.begin(), memory.end()}, text}});
  }
  return text;
}

}  // namespace golden
