#include "tools/stvm/shown_edits.h"

#include <algorithm>

#include "tools/common/all_system_edits.h"
#include "tools/common/source_edits.h"

namespace stvm {
namespace {

constexpr size_t kShownEdits = 1000;
constexpr size_t kNamedInstances = 3;

}  // namespace

tools::PouEdits shown_edits(const ir::VerifiedImage& old_image,
                            const ir::VerifiedImage& new_image) {
  tools::PouEdits edits = online_change::pou_edits({old_image.image(), old_image.encoded()},
                                                   {new_image.image(), new_image.encoded()});
  if (edits.size() > kShownEdits) edits.resize(kShownEdits);
  return edits;
}

std::string instances_text(const ir::Image& image, std::span<const uint32_t> ids) {
  std::string text;
  for (const uint32_t id : ids.first(std::min(ids.size(), kNamedInstances))) {
    text += (text.empty() ? "" : ", ") + image.instance_path(id);
  }
  if (ids.size() > kNamedInstances) {
    text += " and " + std::to_string(ids.size() - kNamedInstances) + " more";
  }
  return text;
}

tools::SystemEdits shown_system(const ir::VerifiedImage& old_image,
                                const ir::VerifiedImage& new_image, bool back) {
  tools::SystemEdits edits = tools::all_system_edits(old_image, new_image, back);
  for (auto& edit : tools::source_edits(old_image.encoded(), new_image.encoded())) {
    edits.push_back(std::move(edit));
  }
  if (edits.size() <= kShownEdits) return edits;
  const std::string more = std::to_string(edits.size() - kShownEdits);
  edits.resize(kShownEdits);
  edits.push_back({"more", more + " rows", "`stc diff` shows all"});
  return edits;
}

std::string undone_text(const std::string& edit, const std::string& without,
                        const std::string& why) {
  std::string text = "edit " + edit;
  if (!without.empty()) text += ", without FB_Exit of " + without;
  return why.empty() ? text : text + ": " + why;
}

}  // namespace stvm
