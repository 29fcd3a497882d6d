// Images in which any field was changed, with all hashes made anew: the verifier refuses them,
// alone and beside a version that it knows with the same words, or every consumer of images lives
// with them (consumers.h).
//
// An input is a script: a byte that names the version (tests/fuzz/versions.h), one that says which
// consumers, then 8 bytes for each change of a field (field_changes.h), or of the sources that
// travel along, which are no part of ir::Image.
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include "base/check.h"
#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/proof.h"
#include "tests/fuzz/consumers.h"
#include "tests/fuzz/field_changes.h"
#include "tests/fuzz/versions.h"

namespace {

constexpr size_t kMostChanges = 3;
constexpr size_t kVersions = 2 * (fuzz::kEveryTable + 1);

struct Good {
  ir::VerifiedImage version;
  std::vector<fuzz::ImageField> fields;
  std::shared_ptr<const ir::verification::Proof> proof;
};

const Good& good_version(uint8_t number) {
  static std::optional<Good> all[kVersions];
  std::optional<Good>& good = all[number % kVersions];
  if (good) return *good;
  const fuzz::Versions& pair = fuzz::versions(static_cast<uint8_t>(number % kVersions / 2));
  const ir::VerifiedImage& version = number % kVersions % 2 == 0 ? pair.from : pair.to;
  auto proof = ir::verification::prove(std::make_shared<base::Bytes>(version.encoded()), nullptr);
  good = Good{version, fuzz::fields_of(version.image()), *proof};
  return *good;
}

// Sources that travel along, with some bytes that are others.
base::Bytes changed_sources(const uint8_t* data, size_t size) {
  static const base::Bytes good = ir::encode_sources(*ir::pack_sources(
      {{"lib/pid.st", "(* pid *) (* pid *) (* pid *)"}, {"main.st", "PROGRAM p END_PROGRAM"}},
      {"--name=plant", "--define=SIM", "main.st", "lib"}));
  base::Bytes section = good;
  for (size_t at = 0; at + 8 <= size && at < 8 * kMostChanges; at += 8) {
    section[(data[at] | data[at + 1] << 8) % section.size()] = data[at + 2];
    if (data[at + 3] % 8 == 0) section.resize(section.size() - 1);
  }
  return section;
}

base::Bytes changed(const Good& good, const uint8_t* data, size_t size) {
  ir::Image image = good.version.image();
  for (size_t at = 0; at + fuzz::FieldChange::kBytes <= size && at < 8 * kMostChanges; at += 8) {
    fuzz::apply(image, good.fields, fuzz::FieldChange(data + at, at));
  }
  return ir::encode(image);
}

// Null: refused.
std::optional<ir::VerifiedImage> verified(const Good& good, base::Bytes bytes) {
  const auto shared = std::make_shared<const base::Bytes>(std::move(bytes));
  const auto alone = ir::verification::prove(shared, nullptr);
  const auto beside = ir::verification::prove(shared, good.proof.get());
  base::check(alone.ok() == beside.ok() &&
                  (alone.ok() || base::to_string(alone.error()) == base::to_string(beside.error())),
              "a version that is known changes no answer");
  if (!alone.ok()) {
    base::check(!alone.error().text.empty(), "a reason");
    return std::nullopt;
  }
  base::Result<ir::VerifiedImage> image = ir::verify(shared);
  base::check(image.ok(), "what is proven is verified");
  return *std::move(image);
}

// All consumers; of those that take longest one, and all of them with one image of four.
void meet_all(const ir::VerifiedImage& good, const ir::VerifiedImage& image, uint8_t pair,
              uint8_t turn) {
  using online_change::Strategy;
  const Strategy strategy = (turn & 8) != 0 ? Strategy::kStandby : Strategy::kInPlace;
  const bool there = (turn & 4) != 0;
  const ir::VerifiedImage& from = there ? good : image;
  const ir::VerifiedImage& to = there ? image : good;
  fuzz::read_image(image);
  fuzz::read_code(image);
  for (const bool back : {false, true}) {
    fuzz::compare_images(back ? image : good, back ? good : image);
    fuzz::carry_values(back ? image : good, back ? good : image);
  }
  fuzz::merge_images(good, image, good);
  fuzz::merge_images(image, good, image);
  fuzz::link_on([&](const ir::Image& base) { return fuzz::second_on(pair, base); }, image);
  fuzz::run_image(image);
  fuzz::change_images(from, to, strategy);
  fuzz::exchange_globals(from, to);
  fuzz::serve_images(from, to, strategy, turn % fuzz::kServings);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size < 2) return 0;
  const Good& good = good_version(data[0]);
  const bool sources = data[1] % 64 >= 48;
  const auto image = verified(
      good,
      sources ? ir::encode(good.version.image(), nullptr, changed_sources(data + 2, size - 2)).bytes
              : changed(good, data + 2, size - 2));
  if (!image) return 0;
  static std::set<std::pair<size_t, uint8_t>> met;  // versions that nothing has changed, by turns
  const bool is_good = image->digest() == good.version.digest();
  if (is_good && !met.insert({data[0] % kVersions, data[1] % 16}).second) return 0;
  meet_all(good.version, *image, static_cast<uint8_t>(data[0] % kVersions / 2), data[1]);
  return 0;
}
