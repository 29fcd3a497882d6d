#include "ir/bytecode/verify.h"

#include "ir/bytecode/verify_parts.h"

namespace ir {
namespace {

base::Status verify_image(const Image& image) {
  auto facts = verification::verify_types(image);
  if (!facts) return facts.error();
  if (base::Status s = verification::verify_constants(image); !s) return s;
  verification::Context context(image, std::move(facts).value());
  if (base::Status s = verification::verify_tables(context); !s) return s;
  if (base::Status s = verification::verify_overrides(image); !s) return s;
  if (base::Status s = verification::verify_migrations(image); !s) return s;
  if (base::Status s = verification::verify_initial_data(image); !s) return s;
  if (base::Status s = verification::verify_instances(context); !s) return s;
  if (base::Status s = verification::verify_resources(context); !s) return s;
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
  if (base::Status s = verify_image(*image); !s) return s.error();
  VerifiedImage verified;
  verified.image_ = std::move(image);
  verified.encoded_ = std::make_shared<const base::Bytes>(encoded.begin(), encoded.end());
  verified.digest_ = digest(encoded);
  return verified;
}

}  // namespace ir
