// An image says all that a link needs: taken apart and linked again, on top of itself, it is what
// it was, byte for byte. All golden files, alone and as a second version of themselves.
#include <gtest/gtest.h>

#include <algorithm>

#include "ir/bytecode/image_sections.h"
#include "linker/link.h"
#include "linker/unlink.h"
#include "tests/unit/workspace/edited_project.h"

namespace {

// What an image does not say is how the initial values of one instance were written: they come back
// as values of their own, behind all others.
bool has_same_bytes(const ir::Image& a, ir::Image b) {
  if (b.constants.size() < a.constants.size()) return false;
  b.constants = a.constants;
  return ir::encode(a) == ir::encode(b);
}

// Nothing where both are equal, else the first thing that is not.
std::string difference(const ir::Image& a, const ir::Image& b) {
  if (has_same_bytes(a, b)) return "";
  for (size_t i = 0; i < std::min(a.pous.size(), b.pous.size()); ++i) {
    const ir::LinkedPou& x = a.pous[i];
    const ir::LinkedPou& y = b.pous[i];
    if (x.name != y.name) return "POU " + x.name + " is " + y.name;
    const std::string one = ir::disassemble(a, x);
    const std::string other = ir::disassemble(b, y);
    if (one != other) return one + "is now\n" + other;
  }
  const base::Bytes x = ir::encode(a);
  const base::Bytes y = ir::encode(b);
  for (uint32_t i = 0; i < ir::kImageSectionCount; ++i) {
    const auto section = static_cast<ir::ImageSection>(i);
    const bool same = std::ranges::equal(ir::section_of(x, section), ir::section_of(y, section));
    if (!same && section != ir::ImageSection::kConstants) return "section " + std::to_string(i);
  }
  return "something else";
}

base::Result<ir::Image> again(const ir::Image& image) {
  base::Result<linker::Unlinked> parts = linker::unlink(image);
  if (!parts.ok()) return parts.error();
  linker::Options options;
  options.base = &image;
  options.devices = parts->devices;
  options.safe = parts->safe;
  return linker::link(parts->program, parts->objects, options);
}

class Check {
 public:
  // The image of the text, on top of `base`, which may be null; nullopt: it has mistakes.
  std::optional<ir::Image> build(const std::string& path, const std::string& text,
                                 const ir::Image* base) {
    workspace::Settings settings;
    settings.link.base = base;
    const test::Outcome built = test::build_from_nothing(test::one_file(text), settings);
    if (!built.image) return std::nullopt;
    ir::Image image = std::move(*ir::decode(*built.image));
    const base::Result<ir::Image> linked = again(image);
    const std::string told = linked.ok() ? difference(image, *linked) : linked.error().text;
    EXPECT_EQ(told, "") << path << "\n" << (base == nullptr ? "" : text);
    ++images_;
    return image;
  }
  uint32_t images() const { return images_; }

 private:
  uint32_t images_ = 0;
};

TEST(Unlink, E09_EveryImageComesBackFromItsParts) {
  Check check;
  for (const std::string& path : test::sources_below("tests/golden")) {
    const std::string text = test::read_file(path);
    const std::optional<ir::Image> first = check.build(path, text, nullptr);
    if (!first || ::testing::Test::HasFailure()) continue;
    test::Random random(test::seed_of(path));
    (void)check.build(path, test::edited(text, random), &*first);
  }
  EXPECT_GT(check.images(), 500u);  // otherwise little was tested
}

}  // namespace
