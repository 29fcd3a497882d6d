// Do two versions differ in code alone? Then every variable stays as it is, and there is nothing to
// plan: what an edit of statements costs does not grow with the data.
#pragma once

#include "base/bytes.h"
#include "ir/bytecode/image.h"
#include "online_change/plan/plan.h"

namespace online_change {

// An image and its encoded form.
struct EncodedImage {
  const ir::Image& image;
  base::ByteSpan bytes;
};

bool same_types(const EncodedImage& a, const EncodedImage& b);
// Types, places, instances and initial data are equal, and no rule of the sources says what should
// become of values. False says nothing.
bool same_data(const EncodedImage& a, const EncodedImage& b);
// What plan() gives for such a pair, there and back.
struct SameDataPlans {
  Plan forward;
  Plan inverse;
};
SameDataPlans plans_of_same_data(const ir::Image& old_image, const ir::Image& new_image);

}  // namespace online_change
