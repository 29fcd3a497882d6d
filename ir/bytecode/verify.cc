#include "ir/bytecode/verify.h"

#include "ir/bytecode/verify_parts.h"

namespace ir {
namespace {

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
  std::vector<verification::CodeFacts> code(image.pous.size());
  for (uint32_t pou = 0; pou < image.pous.size(); ++pou) {
    if (image.pous[pou].unit_count == 0) continue;  // a number whose POU was removed
    auto checked = verification::verify_code(context, pou);
    if (!checked) return checked.error();
    code[pou] = std::move(checked).value();
  }
  return verification::verify_calls(context, code);
}

}  // namespace

base::Result<VerifiedImage> verify(base::ByteSpan encoded) {
  base::Result<Image> decoded = decode(encoded);
  if (!decoded) return decoded.error();
  auto image = std::make_shared<const Image>(std::move(decoded).value());
  base::Result<std::vector<OutputWriter>> writers = verify_image(*image);
  if (!writers) return writers.error();
  VerifiedImage verified;
  verified.image_ = std::move(image);
  verified.output_writers_ =
      std::make_shared<const std::vector<OutputWriter>>(std::move(writers).value());
  verified.encoded_ = std::make_shared<const base::Bytes>(encoded.begin(), encoded.end());
  verified.digest_ = digest(encoded);
  return verified;
}

}  // namespace ir
