// Images whose POUs several threads verify: what is answered is the same as by one.
#include <gtest/gtest.h>

#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_image.h"

namespace {

using namespace sample;
using ir::Image;

constexpr uint32_t kFunctions = 500;
constexpr uint32_t kMoves = 100;

// The sample and functions like Add that take long to verify; more units than one thread takes.
Image large_image() {
  Image image = busy_image();
  const ir::LinkedPou add = image.pous[kAddPou];
  const Code body(image.code.begin() + add.first_unit,
                  image.code.begin() + add.first_unit + add.unit_count);
  for (uint32_t i = 0; i < kFunctions; ++i) {
    ir::LinkedPou pou = add;
    pou.name = "Add" + std::to_string(i);
    pou.first_unit = static_cast<uint32_t>(image.code.size());
    Code code;
    for (uint32_t k = 0; k < kMoves; ++k) code = code + op(Opcode::MOV_16, F(4), F(0));
    code = code + body;
    pou.unit_count = static_cast<uint32_t>(code.size());
    image.code.insert(image.code.end(), code.begin(), code.end());
    image.pous.push_back(std::move(pou));
  }
  return image;
}

void spoil(Image& image, uint32_t function) {
  const uint32_t number = static_cast<uint32_t>(image.pous.size()) - kFunctions + function;
  image.code[image.pous[number].first_unit + kMoves / 2].a = 0xfff0;  // behind the frame
}

TEST(VerifyLarge, V3_EveryPouIsVerified) {
  const Image image = large_image();
  ASSERT_GT(image.code.size(), size_t{1} << 15);
  const auto verified = ir::verify(ir::encode(image));
  ASSERT_TRUE(verified.ok()) << verified.error().text;
  for (const uint32_t function : {0u, 31u, 250u, kFunctions - 1}) {
    Image bad = image;
    spoil(bad, function);
    const auto refused = ir::verify(ir::encode(bad));
    ASSERT_FALSE(refused.ok()) << function;
    EXPECT_NE(refused.error().text.find("`Add" + std::to_string(function) + "`"), std::string::npos)
        << refused.error().text;
  }
}

TEST(VerifyLarge, V3_TheFirstErrorIsTheAnswer) {
  Image bad = large_image();
  for (const uint32_t function : {37u, 38u, 170u, 333u, 499u}) spoil(bad, function);
  const base::Bytes bytes = ir::encode(bad);
  for (int i = 0; i < 20; ++i) {
    const auto refused = ir::verify(bytes);
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().text.find("`Add37`"), std::string::npos) << refused.error().text;
  }
}

}  // namespace
