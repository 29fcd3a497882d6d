#include "online_change/package/package.h"

#include <array>

#include "base/check.h"
#include "base/digest_reader.h"
#include "base/large_pages.h"
#include "base/limits.h"
#include "ir/bytecode/verify.h"
#include "online_change/package/delta.h"
#include "online_change/package/plan_fields.h"

namespace online_change {
namespace {

using base::ByteReader;
using base::ByteWriter;

// Header: magic, version, of each part its bytes and their SHA-256; then the parts. Layout and
// program together are the image.
constexpr uint32_t kMagic = 0x47504353;  // "SCPG"
constexpr uint32_t kPackageVersion = 4;
constexpr uint32_t kShortVersion = 5;  // layout and program are deltas to those of the base
// As these, with gathers; written only where there are some.
constexpr uint32_t kGatherVersion = 6;
constexpr uint32_t kShortGatherVersion = 7;
constexpr const char* kPartNames[] = {"layout", "program", "commands"};
constexpr size_t kParts = std::size(kPartNames);

bool has_gathers(const Package& package) {
  return !package.forward.gathers.empty() || !package.inverse.gathers.empty();
}

base::Error bad_format(const std::string& what) {
  return {base::Refusal::kBadFormat, "change package: " + what};
}

using Parts = std::array<base::ByteSpan, kParts>;

// Each part as its header says, and nothing after the last.
base::Result<Parts> split(ByteReader& in) {
  std::array<uint32_t, kParts> lengths{};
  std::array<base::Digest, kParts> stored{};
  uint64_t total = 0;
  for (size_t i = 0; i < kParts; ++i) {
    total += lengths[i] = in.u32();
    stored[i] = base::read_digest(in);
  }
  if (total > base::kMaxImageBytes) {
    return base::Error{base::Refusal::kTooLarge, "change package of " + std::to_string(total) +
                                                     " bytes; the limit is " +
                                                     std::to_string(base::kMaxImageBytes)};
  }
  if (in.failed() || total != in.left()) return bad_format("has another length than it says");
  Parts parts;
  for (size_t i = 0; i < kParts; ++i) {
    parts[i] = in.raw(lengths[i]);
    if (base::sha256(parts[i]) == stored[i]) continue;
    return base::Error{base::Refusal::kBadHash,
                       std::string("change package: the checksum of its ") + kPartNames[i] +
                           " part does not match"};
  }
  return parts;
}

base::Bytes encode_commands(const Package& package) {
  base::WriteArchive commands;
  command_fields(commands, package, has_gathers(package));
  return commands.take();
}

base::Bytes put_together(uint32_t version, const Parts& parts) {
  ByteWriter out;
  out.u32(kMagic);
  out.u32(version);
  for (const base::ByteSpan part : parts) {
    out.u32(static_cast<uint32_t>(part.size()));
    out.raw(base::sha256(part));
  }
  for (const base::ByteSpan part : parts) out.raw(part);
  return out.take();
}

// Layout and program of the image.
std::array<base::ByteSpan, 2> parts_of(base::ByteSpan image) {
  const size_t layout = ir::layout_end(image);
  return {image.first(layout), image.subspan(layout)};
}

base::Result<base::Bytes> image_of(const Parts& parts, base::ByteSpan base_image) {
  base::Bytes image;
  image.reserve(base_image.size() + base_image.size() / 8);  // for both parts
  base::expect_whole_use(image.data(), base_image.size());
  const auto base_parts = parts_of(base_image);
  for (size_t i = 0; i < base_parts.size(); ++i) {
    const size_t limit = base::kMaxImageBytes - image.size();
    auto longer = apply_delta(base_parts[i], parts[i], limit, std::move(image));
    if (!longer) {
      return bad_format(std::string("its ") + kPartNames[i] +
                        " part is no delta to the version that it is made for");
    }
    image = std::move(*longer);
  }
  return image;
}

base::Bytes encode_short(const Package& plans, base::ByteSpan image, base::ByteSpan base_image) {
  const base::Bytes commands = encode_commands(plans);
  const auto [layout, program] = parts_of(image);
  const auto [base_layout, base_program] = parts_of(base_image);
  const uint32_t version = has_gathers(plans) ? kShortGatherVersion : kShortVersion;
  return put_together(
      version, {make_delta(base_layout, layout), make_delta(base_program, program), commands});
}

// A package without its image.
base::Result<Package> plans_for(const EncodedImage& from, const EncodedImage& to) {
  Package package;
  package.base = ir::digest(from.bytes);
  if (same_data(from, to)) {
    SameDataPlans plans = plans_of_same_data(from.image, to.image);
    package.forward = std::move(plans.forward);
    package.inverse = std::move(plans.inverse);
    base::dcheck([&] { return check_package(package, from.image, to.image).ok(); },
                 "what moves no data is a sound package, too");
    return package;
  }
  base::Result<Plan> forward = plan(from.image, to.image);
  if (!forward) return forward.error();
  base::Result<Plan> inverse = inverse_plan(from.image, to.image);
  if (!inverse) return inverse.error();
  package.forward = std::move(forward).value();
  package.inverse = std::move(inverse).value();
  base::Status sound = check_package(package, from.image, to.image);
  if (!sound) return sound.error();
  return package;
}

}  // namespace

bool has_package_magic(base::ByteSpan bytes) {
  ByteReader in(bytes);
  return in.u32() == kMagic;
}

base::Bytes encode(const Package& package) {
  const base::Bytes commands = encode_commands(package);
  const auto [layout, program] = parts_of(package.image);
  const uint32_t version = has_gathers(package) ? kGatherVersion : kPackageVersion;
  return put_together(version, {layout, program, commands});
}

base::Bytes encode_short(const Package& package, base::ByteSpan base_image) {
  return encode_short(package, package.image, base_image);
}

base::Error stale_base(const base::Digest& base, const base::Digest& running) {
  return {base::Refusal::kStaleBase, "made for version " + base::short_hex(base) + ", but " +
                                         base::short_hex(running) +
                                         " is running; make the change again"};
}

base::Result<Package> decode(base::ByteSpan bytes, base::ByteSpan base_image) {
  ByteReader in(bytes);
  if (in.u32() != kMagic) return bad_format("does not begin like one");
  uint32_t version = in.u32();
  const bool gathers = version == kGatherVersion || version == kShortGatherVersion;
  if (version != kPackageVersion && version != kShortVersion && !gathers)
    return bad_format("has version " + std::to_string(version));
  base::Result<Parts> parts = split(in);
  if (!parts.ok()) return parts.error();
  const auto& [layout, program, commands] = *parts;
  Package package;
  base::ReadArchive plans(commands);
  command_fields(plans, package, gathers);
  if (!plans.done()) return bad_format("has a damaged plan");
  if (version == kPackageVersion || version == kGatherVersion) {
    package.image.assign(layout.begin(), layout.end());
    package.image.insert(package.image.end(), program.begin(), program.end());
    return package;
  }
  if (package.base != ir::digest(base_image)) {
    return stale_base(package.base, ir::digest(base_image));
  }
  auto image = image_of(*parts, base_image);
  if (!image.ok()) return image.error();
  package.image = std::move(*image);
  return package;
}

base::Result<Package> make_package(base::ByteSpan old_image, base::ByteSpan new_image) {
  base::Result<ir::VerifiedImage> from =
      ir::verify(base::Bytes(old_image.begin(), old_image.end()));
  if (!from) return from.error();
  base::Result<ir::VerifiedImage> to = ir::verify(base::Bytes(new_image.begin(), new_image.end()));
  if (!to) return to.error();
  return make_package({from->image(), old_image}, {to->image(), new_image});
}

base::Result<Package> make_package(const EncodedImage& from, const EncodedImage& to) {
  base::Result<Package> package = plans_for(from, to);
  if (package.ok()) package->image.assign(to.bytes.begin(), to.bytes.end());
  return package;
}

base::Result<base::Bytes> make_short_package(const EncodedImage& from, const EncodedImage& to) {
  base::Result<Package> package = plans_for(from, to);
  if (!package.ok()) return package.error();
  return encode_short(*package, to.bytes, from.bytes);
}

bool leaves_all(const Package& package) {
  const auto does_nothing = [](const Plan& plan) {
    return plan.steps.empty() && plan.calls.empty() && plan.fates.empty();
  };
  return does_nothing(package.forward) && does_nothing(package.inverse);
}

}  // namespace online_change
