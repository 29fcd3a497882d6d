#include "ir/bytecode/pou_version.h"
#include "ir/bytecode/proof.h"
#include "ir/bytecode/verify_parts.h"

namespace ir {
namespace {

using verification::CodeFacts;

base::Status verify_version(const verification::Context& context, const PouVersion& version) {
  const LinkedPou& pou = context.image.pous[version.pou];
  if (version.units.size() != pou.unit_count) {
    return verification::refuse(base::Refusal::kBadCall,
                                "a version of `" + pou.name + "` has another length");
  }
  const base::Result<CodeFacts> own = verification::verify_code(context, version.pou);
  if (!own) return own.error();
  const base::Result<CodeFacts> other =
      verification::verify_code(context, version.pou, version.units);
  if (!other) return other.error();
  if (other->callees != own->callees || other->native_bytes > own->native_bytes) {
    return verification::refuse(base::Refusal::kBadCall,
                                "a version of `" + pou.name + "` calls something else");
  }
  return base::Ok{};
}

}  // namespace

std::vector<base::Status> verify_versions(const VerifiedImage& verified,
                                          std::span<const PouVersion> versions) {
  const Image& image = verified.image();
  auto facts = verification::verify_types(image);
  if (!facts) return std::vector<base::Status>(versions.size(), facts.error());
  const RegionMap regions(image.types, image.layouts);
  verification::Context context(image, *facts, regions);
  const verification::Likeness none(nullptr, {}, image);
  if (base::Status s = verification::verify_tables(context, none); !s) {
    return std::vector<base::Status>(versions.size(), s);
  }
  std::vector<base::Status> answers;
  for (const PouVersion& version : versions) answers.push_back(verify_version(context, version));
  return answers;
}

}  // namespace ir
