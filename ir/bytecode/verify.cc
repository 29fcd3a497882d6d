#include "ir/bytecode/verify.h"

#include <algorithm>
#include <array>
#include <mutex>
#include <optional>

#include "base/memory_limit.h"
#include "base/parallel.h"
#include "ir/bytecode/image_sections.h"
#include "ir/bytecode/proof.h"
#include "ir/bytecode/verify_code.h"

namespace ir {
namespace {

constexpr size_t kUnitsForThreads = 1 << 15;  // below, threads cost more than they save
constexpr size_t kPousAtATime = 32;

// One POU after the other, or several at once; the first error is the answer in any case.
base::Result<verification::CodeFactsOfAll> verify_pous(const verification::Context& context,
                                                       const verification::Likeness& likeness) {
  const Image& image = context.image;
  verification::CodeFactsOfAll facts(image.pous.size());
  const auto share = [](verification::CodeFacts made) {
    return std::make_shared<const verification::CodeFacts>(std::move(made));
  };
  std::vector<uint8_t> bad(image.pous.size(), 0);
  const auto check = [&](verification::CodeRoom& room, uint32_t pou) {
    if (image.pous[pou].unit_count == 0) return true;  // a number whose POU was removed
    facts[pou] = likeness.code(pou);
    if (facts[pou] != nullptr) return true;
    auto checked = verification::verify_code(context, room, pou);
    if (checked) facts[pou] = share(std::move(checked).value());
    return checked.ok();
  };
  const uint32_t jobs = image.code.size() < kUnitsForThreads ? 1 : base::usable_cores();
  const size_t parts = (image.pous.size() + kPousAtATime - 1) / kPousAtATime;
  base::for_each_index(parts, jobs, 1, [&](size_t part) {
    verification::CodeRoom room;
    const size_t end = std::min(image.pous.size(), (part + 1) * kPousAtATime);
    for (size_t i = part * kPousAtATime; i < end; ++i) {
      const auto pou = static_cast<uint32_t>(i);
      bad[i] = base::within_memory([&] { return check(room, pou); }, [] { return false; }) ? 0 : 1;
    }
  });
  for (uint32_t pou = 0; pou < image.pous.size(); ++pou) {
    if (bad[pou] == 0) continue;
    auto again = verification::verify_code(context, pou);  // in the caller's memory limit
    if (!again) return again.error();
    facts[pou] = share(std::move(again).value());
  }
  return facts;
}

// The last images that were proven, as long as somebody holds them: the next one is often another
// version of one of them.
class Proofs {
 public:
  std::shared_ptr<const verification::Proof> like(base::ByteSpan encoded) {
    const size_t types = section_of(encoded, ImageSection::kTypes).size();
    std::lock_guard lock(mutex_);
    for (const auto& row : rows_) {
      std::shared_ptr<const verification::Proof> proof = row.lock();
      if (proof == nullptr) continue;
      if (section_of(*proof->encoded, ImageSection::kTypes).size() == types) return proof;
    }
    return nullptr;
  }
  void add(const std::shared_ptr<const verification::Proof>& proof) {
    std::lock_guard lock(mutex_);
    std::move_backward(rows_.begin(), rows_.end() - 1, rows_.end());
    rows_[0] = proof;
  }

 private:
  std::mutex mutex_;
  std::array<std::weak_ptr<const verification::Proof>, 4> rows_;  // the newest first
};

Proofs& proofs() {
  static Proofs all;
  return all;
}

}  // namespace

namespace verification {

base::Result<std::shared_ptr<const Proof>> prove(std::shared_ptr<const base::Bytes> encoded,
                                                 const Proof* like) {
  std::optional<KnownImage> known;
  if (like != nullptr) known.emplace(KnownImage{like->image, *like->encoded, like->places});
  base::Result<DecodedImage> decoded = decode(*encoded, known ? &*known : nullptr);
  if (!decoded) return decoded.error();
  auto proof = std::make_shared<Proof>();
  proof->encoded = std::move(encoded);
  proof->image = std::move(decoded->image);
  proof->places = std::move(decoded->places);
  const Image& image = proof->image;
  const Likeness likeness(like, *proof->encoded, image);
  if (likeness.types()) {
    proof->types = like->types;
  } else {
    auto facts = verify_types(image);
    if (!facts) return facts.error();
    proof->types = std::make_shared<const std::vector<TypeFacts>>(std::move(facts).value());
  }
  if (!likeness.constants()) {
    if (base::Status s = verify_constants(image); !s) return s.error();
  }
  proof->regions = likeness.regions()
                       ? like->regions
                       : std::make_shared<const RegionMap>(image.types, image.layouts);
  Context context(image, *proof->types, *proof->regions);
  if (base::Status s = verify_tables(context, likeness); !s) return s.error();
  if (base::Status s = verify_overrides(image); !s) return s.error();
  if (base::Status s = verify_migrations(image); !s) return s.error();
  if (base::Status s = verify_charts(image); !s) return s.error();
  if (base::Status s = verify_contents(image); !s) return s.error();
  if (base::Status s = verify_initial_data(image); !s) return s.error();
  if (!likeness.instances()) {
    if (base::Status s = verify_instances(context); !s) return s.error();
  }
  proof->areas = likeness.instances()
                     ? like->areas
                     : std::make_shared<const std::vector<uint32_t>>(areas_in_order(image));
  if (base::Status s = verify_resources(context, *proof->areas); !s) return s.error();
  auto code = verify_pous(context, likeness);
  if (!code) return code.error();
  proof->code = std::move(code).value();
  if (likeness.calls(proof->code)) {
    proof->calls = like->calls;
    return std::shared_ptr<const Proof>(std::move(proof));
  }
  auto calls = verify_calls(context, proof->code);
  if (!calls) return calls.error();
  proof->calls = std::move(calls).value();
  return std::shared_ptr<const Proof>(std::move(proof));
}

}  // namespace verification

const NameIndex& VerifiedImage::names() const { return names_->of(*image_); }

base::Result<VerifiedImage> verify(base::Bytes encoded) {
  return verify(std::make_shared<const base::Bytes>(std::move(encoded)));
}

base::Result<VerifiedImage> verify(std::shared_ptr<const base::Bytes> encoded) {
  const std::shared_ptr<const verification::Proof> like = proofs().like(*encoded);
  auto proven = verification::prove(std::move(encoded), like.get());
  if (!proven) return proven.error();
  const std::shared_ptr<const verification::Proof>& proof = *proven;
  proofs().add(proof);
  VerifiedImage verified;
  verified.image_ = {proof, &proof->image};
  verified.calls_ = {proof, &proof->calls};
  verified.names_ = {proof, &proof->names};
  verified.encoded_ = proof->encoded;
  verified.digest_ = digest(*proof->encoded);
  return verified;
}

}  // namespace ir
