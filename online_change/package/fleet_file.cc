// The stored form: 8 bytes magic, u32 version, u32 length of the whole, then the parts, each {u32
// length, SHA-256 of the content, content}: what people say of it (two texts, since version 2
// whether its table is free, since version 3 the steps in which it comes), and the two images one
// after the other, packed as one, since most of the second was in the first.
#include "online_change/package/fleet_file.h"

#include <algorithm>

#include "base/limits.h"
#include "base/pack.h"
#include "base/tool_limits.h"

namespace online_change {
namespace {

constexpr uint32_t kFirstFleetVersion = 1;
constexpr uint32_t kFreeVersion = 2;
constexpr uint32_t kFleetVersion = 3;
constexpr uint32_t kMostText = 65536;

base::Error bad(const std::string& text) {
  return {base::Refusal::kBadFormat, "fleet file: " + text};
}

void write_part(base::ByteWriter& out, const base::Bytes& content) {
  out.u32(static_cast<uint32_t>(content.size()));
  out.raw(base::sha256(content));
  out.raw(content);
}

base::Result<base::ByteSpan> read_part(base::ByteReader& in, const char* name) {
  const uint32_t size = in.count(1);
  const base::ByteSpan stored = in.raw(sizeof(base::Digest));
  const base::ByteSpan content = in.raw(size);
  if (in.failed()) return bad(std::string("it ends inside its ") + name);
  const base::Digest actual = base::sha256(content);
  if (std::ranges::equal(actual, stored)) return content;
  return base::Error{base::Refusal::kBadHash,
                     std::string("fleet file: the checksum of its ") + name + " is wrong"};
}

base::Bytes texts_of(const FleetFile& file) {
  base::ByteWriter out;
  out.text(file.author);
  out.text(file.text);
  out.boolean(file.free_table);
  out.u32(static_cast<uint32_t>(file.steps.size()));
  for (const std::string& step : file.steps) out.text(step);
  out.boolean(file.steps_if_needed);
  return out.take();
}

base::Bytes images_of(const FleetFile& file) {
  base::Bytes both = file.original;
  both.insert(both.end(), file.edited.begin(), file.edited.end());
  base::ByteWriter out;
  out.u32(static_cast<uint32_t>(file.original.size()));
  out.u32(static_cast<uint32_t>(file.edited.size()));
  out.blob(base::pack(both));
  return out.take();
}

base::Status read_texts(base::ByteSpan content, uint32_t version, FleetFile& file) {
  base::ByteReader in(content);
  for (std::string* const text : {&file.author, &file.text}) {
    const base::ByteSpan bytes = in.blob();
    if (bytes.size() > kMostText) return bad("a text of more than 65,536 bytes");
    text->assign(bytes.begin(), bytes.end());
  }
  if (version >= kFreeVersion) file.free_table = in.boolean();
  const uint32_t steps = version >= kFleetVersion ? in.count(4) : 0;
  if (steps > base::kMostEditsOnTrial) {
    return bad(std::to_string(steps) + " steps; the limit is " +
               std::to_string(base::kMostEditsOnTrial) + " (kMostEditsOnTrial)");
  }
  for (uint32_t left = steps; left != 0; --left) {
    const base::ByteSpan bytes = in.blob();
    file.steps.emplace_back(bytes.begin(), bytes.end());
  }
  if (version >= kFleetVersion) file.steps_if_needed = in.boolean();
  if (in.failed() || in.left() != 0) return bad("its texts are damaged");
  return base::Ok{};
}

base::Status read_images(base::ByteSpan content, FleetFile& file) {
  base::ByteReader in(content);
  const uint64_t original = in.u32();
  const uint64_t edited = in.u32();
  const base::ByteSpan packed = in.blob();
  if (in.failed() || in.left() != 0) return bad("its versions are damaged");
  if (original > base::kMaxImageBytes || edited > base::kMaxImageBytes) {
    return base::Error{base::Refusal::kTooLarge,
                       "fleet file: a version of " + std::to_string(std::max(original, edited)) +
                           " bytes; the limit is " + std::to_string(base::kMaxImageBytes)};
  }
  if (base::unpacked_size(packed, original + edited) != original + edited) {
    return bad("its versions are not as long as it says");
  }
  const std::optional<base::Bytes> both = base::unpack(packed, original + edited);
  if (!both) return bad("its versions are damaged");
  const auto middle = both->begin() + static_cast<ptrdiff_t>(original);
  file.original.assign(both->begin(), middle);
  file.edited.assign(middle, both->end());
  return base::Ok{};
}

}  // namespace

bool has_fleet_magic(base::ByteSpan bytes) {
  return bytes.size() >= kFleetMagic.size() &&
         std::equal(kFleetMagic.begin(), kFleetMagic.end(), bytes.begin());
}

base::Bytes encode(const FleetFile& file) {
  base::ByteWriter out;
  out.raw(base::as_bytes(kFleetMagic));
  out.u32(kFleetVersion);
  const size_t length = out.size();
  out.u32(0);
  write_part(out, texts_of(file));
  write_part(out, images_of(file));
  out.patch_u32(length, static_cast<uint32_t>(out.size()));
  return out.take();
}

base::Result<FleetFile> decode_fleet_file(base::ByteSpan bytes) {
  if (!has_fleet_magic(bytes)) return bad("no magic number");
  base::ByteReader in(bytes.subspan(kFleetMagic.size()));
  const uint32_t version = in.u32();
  const uint32_t length = in.u32();
  if (in.failed()) return bad("only " + std::to_string(bytes.size()) + " bytes");
  if (version < kFirstFleetVersion || version > kFleetVersion) {
    return bad("version " + std::to_string(version) + ", this program reads " +
               std::to_string(kFirstFleetVersion) + " to " + std::to_string(kFleetVersion));
  }
  if (length != bytes.size()) {
    return bad("header says " + std::to_string(length) + " bytes, there are " +
               std::to_string(bytes.size()));
  }
  FleetFile file;
  base::Result<base::ByteSpan> texts = read_part(in, "texts");
  if (!texts.ok()) return texts.error();
  base::Result<base::ByteSpan> images = read_part(in, "versions");
  if (!images.ok()) return images.error();
  if (in.left() != 0) return bad("there is more after its end");
  if (base::Status good = read_texts(*texts, version, file); !good.ok()) return good.error();
  if (base::Status good = read_images(*images, file); !good.ok()) return good.error();
  return file;
}

base::Digest fleet_digest(base::ByteSpan bytes) { return base::sha256(bytes); }

}  // namespace online_change
