// X2: what the new version's sources say was renamed (`{renamed from := 'old'}`), applied to the
// running version. The result is the running version's image with the names that the new one has
// for the same things; numbers, layouts, instances and code stay. Whatever compares two versions
// goes by names, so linker, differ, planner and checks see a renamed variable as one that kept
// its name when they are given this image (docs/adr/0012-renames.md).
//
// A rule applies when the running version has the old name, and has the new one not at all or as
// the old name of another rule that applies (a and b change places). It does not apply again where
// the running version's variable of the new name carries the same rule.
#pragma once

#include <optional>
#include <string>

#include "ir/bytecode/image.h"
#include "ir/program/ir.h"

namespace ir {

// nullopt: no rule applies. In the result, `old_name` of a type, member, literal or instance is
// the name that it had, and invalid where that is the same. Cost: nothing without rules; else
// both versions' types, and one copy of the image when a rule applies.
std::optional<Image> under_new_names(const Image& old_image, const Program& next);
std::optional<Image> under_new_names(const Image& old_image, const Image& next);

// What `renamed`, which is `image` under other names, calls `path`, in `image`; "": no variable.
std::string own_path(const Image& image, const Image& renamed, std::string_view path);

// Owns the copy where there is one. Borrows both images.
class OldUnderNewNames {
 public:
  template <class Next>
  OldUnderNewNames(const Image& old_image, const Next& next)
      : copy_(under_new_names(old_image, next)), old_(old_image) {}
  const Image& image() const { return copy_ ? *copy_ : old_; }
  bool renamed() const { return copy_.has_value(); }

 private:
  std::optional<Image> copy_;
  const Image& old_;
};

}  // namespace ir
