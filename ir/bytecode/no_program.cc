#include "ir/bytecode/no_program.h"

#include "base/check.h"
#include "ir/types/natural_layout.h"

namespace ir {
namespace {

constexpr uint32_t kLeastArea = 8;

Image image_of_nothing() {
  Image image;
  image.name = "no program";
  Type globals;
  globals.kind = Kind::kGlobals;
  image.globals = image.types.own().declare(std::move(globals));
  Layouts& layouts = image.layouts.own();
  layouts = natural_layouts(image.types);
  layouts.of[image.globals.index].area_capacity = kLeastArea;
  Instance row;
  row.type = image.globals;
  row.data = kDataBegin;
  row.live = true;
  image.instances.own().push_back(std::move(row));
  image.data_capacity = kDataBegin + kLeastArea;
  return image;
}

}  // namespace

const VerifiedImage& no_program() {
  static const VerifiedImage image = [] {
    base::Result<VerifiedImage> verified = verify(encode(image_of_nothing()));
    base::check(verified.ok(), "the program of nothing is verified");
    return *std::move(verified);
  }();
  return image;
}

bool is_no_program(const Image& image) { return image.tasks.empty(); }

}  // namespace ir
