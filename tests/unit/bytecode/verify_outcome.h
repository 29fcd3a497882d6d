// Whether the verifier takes an image, and for which reason it does not.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_image.h"

namespace verify_outcome {

inline const sample::Code kRet = sample::op(ir::Opcode::RET);
inline const uint32_t kInt = static_cast<uint32_t>(ir::Kind::kInt);
inline const ir::TypeId kIntType(kInt);
inline const ir::TypeId kDint(static_cast<uint32_t>(ir::Kind::kDint));

inline std::string outcome(const ir::Image& image) {
  const auto verified = ir::verify(ir::encode(image));
  return verified ? "accepted" : base::to_string(verified.error());
}

// `change` makes the accepted sample unacceptable for exactly this reason.
inline void expect_refused(base::Refusal refusal, const char* what,
                           const std::function<void(ir::Image&)>& change) {
  ir::Image image = sample::busy_image();
  ASSERT_EQ(outcome(image), "accepted");
  change(image);
  const auto verified = ir::verify(ir::encode(image));
  ASSERT_FALSE(verified.ok()) << what;
  EXPECT_EQ(verified.error().refusal, refusal) << what << ": " << verified.error().text;
  EXPECT_FALSE(verified.error().text.empty());
}

}  // namespace verify_outcome
