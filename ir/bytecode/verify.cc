#include "ir/bytecode/verify.h"

#include "base/memory_limit.h"
#include "base/parallel.h"
#include "ir/bytecode/verify_parts.h"

namespace ir {
namespace {

constexpr size_t kUnitsForThreads = 1 << 15;  // below, threads cost more than they save
constexpr size_t kPousAtATime = 32;

// One POU after the other, or several at once; the first error is the answer in any case.
base::Result<std::vector<verification::CodeFacts>> verify_pous(
    const verification::Context& context) {
  const Image& image = context.image;
  std::vector<verification::CodeFacts> facts(image.pous.size());
  std::vector<uint8_t> bad(image.pous.size(), 0);
  const auto check = [&](size_t pou) {
    const auto number = static_cast<uint32_t>(pou);
    if (image.pous[number].unit_count == 0) return true;  // a number whose POU was removed
    auto checked = verification::verify_code(context, number);
    if (checked) facts[number] = std::move(checked).value();
    return checked.ok();
  };
  const uint32_t jobs = image.code.size() < kUnitsForThreads ? 1 : base::usable_cores();
  base::for_each_index(image.pous.size(), jobs, kPousAtATime, [&](size_t pou) {
    bad[pou] = base::within_memory([&] { return check(pou); }, [] { return false; }) ? 0 : 1;
  });
  for (uint32_t pou = 0; pou < image.pous.size(); ++pou) {
    if (bad[pou] == 0) continue;
    auto again = verification::verify_code(context, pou);  // in the caller's memory limit
    if (!again) return again.error();
    facts[pou] = std::move(again).value();
  }
  return facts;
}

base::Result<std::vector<OutputWriter>> verify_image(const Image& image) {
  auto facts = verification::verify_types(image);
  if (!facts) return facts.error();
  if (base::Status s = verification::verify_constants(image); !s) return s.error();
  verification::Context context(image, std::move(facts).value());
  if (base::Status s = verification::verify_tables(context); !s) return s.error();
  if (base::Status s = verification::verify_overrides(image); !s) return s.error();
  if (base::Status s = verification::verify_migrations(image); !s) return s.error();
  if (base::Status s = verification::verify_initial_data(image); !s) return s.error();
  if (base::Status s = verification::verify_instances(context); !s) return s.error();
  if (base::Status s = verification::verify_resources(context); !s) return s.error();
  const auto code = verify_pous(context);
  if (!code) return code.error();
  return verification::verify_calls(context, *code);
}

}  // namespace

base::Result<VerifiedImage> verify(base::Bytes encoded) {
  base::Result<Image> decoded = decode(encoded);
  if (!decoded) return decoded.error();
  auto image = std::make_shared<const Image>(std::move(decoded).value());
  base::Result<std::vector<OutputWriter>> writers = verify_image(*image);
  if (!writers) return writers.error();
  VerifiedImage verified;
  verified.image_ = std::move(image);
  verified.output_writers_ =
      std::make_shared<const std::vector<OutputWriter>>(std::move(writers).value());
  verified.digest_ = digest(encoded);
  verified.encoded_ = std::make_shared<const base::Bytes>(std::move(encoded));
  return verified;
}

}  // namespace ir
