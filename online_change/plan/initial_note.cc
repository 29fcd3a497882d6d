#include "online_change/plan/initial_note.h"

#include "online_change/diff/stored_value.h"

namespace online_change {
namespace {

constexpr std::string_view kBegin = "; initial value ";
constexpr std::string_view kEnd = ", the live value stays";
constexpr size_t kLongestShown = 40;  // bytes of a value

// "1.0 -> 1.5"; "" for what has no text, or a long one.
std::string both_values(const ir::Image& image, Node leaf, const InitialData& old_data,
                        const InitialData& new_data, uint32_t to) {
  const bool known = image.types.is_scalar(leaf.type) || is_string(image, leaf.type);
  if (!known || leaf.in_out || ir::is_reference(image.types.root_kind(leaf.type))) return {};
  base::Bytes bytes(image.layouts[leaf.type].size);
  old_data.read(leaf.begin, bytes);
  const std::string before = stored_text(image, leaf.type, bytes.data());
  new_data.read(to, bytes);
  const std::string after = stored_text(image, leaf.type, bytes.data());
  return before.size() > kLongestShown || after.size() > kLongestShown ? std::string()
                                                                       : before + " -> " + after;
}

}  // namespace

std::string initial_note(const Areas& areas, const InitialData& old_data, Values before,
                         const InitialData& new_data, Values after, uint32_t size, uint32_t count,
                         std::string_view path) {
  const auto equal_in = [&](uint32_t i, uint32_t begin) {
    return begin + old_data.equal_bytes(before.begin + i * before.stride + begin, new_data,
                                        after.begin + i * after.stride + begin, size - begin);
  };
  uint32_t i = 0;
  while (i + 1 < count && equal_in(i, 0) == size) ++i;
  const uint32_t at = before.begin + i * before.stride;
  const std::optional<Node> leaf = areas.leaf_at(at + equal_in(i, 0));
  const bool inside = leaf && leaf->begin >= at;
  const uint32_t to = inside ? after.begin + i * after.stride + (leaf->begin - at) : 0;
  const std::string values =
      inside ? both_values(areas.image(), *leaf, old_data, new_data, to) : std::string();
  if (values.empty()) return std::string(kBegin) + "changed" + std::string(kEnd);
  const uint32_t behind = leaf->begin - at + areas.image().layouts[leaf->type].size;
  std::string name = areas.path_at(leaf->begin);
  const bool part = name.size() > path.size() && name.starts_with(path) &&
                    (name[path.size()] == '.' || name[path.size()] == '[');
  if (part) name = name.substr(path.size());
  if (!part && count == 1 && leaf->begin == at && behind == size) {
    return std::string(kBegin) + values + std::string(kEnd);
  }
  bool others = behind < size && equal_in(i, behind) != size;
  while (!others && ++i < count) others = equal_in(i, 0) != size;
  return std::string(kBegin) + "of " + name + ' ' + values + (others ? " (and others)" : "") +
         std::string(kEnd);
}

}  // namespace online_change
