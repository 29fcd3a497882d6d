// The stored form of an image:
//   8 bytes magic, u32 version, u32 length of the whole, SHA-256 of all that follows,
//   then the sections in the order of Section, each {u32 number, u32 length, content}.
#include "ir/bytecode/image.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/limits.h"
#include "base/memory_limit.h"
#include "base/parallel.h"
#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/image_beside.h"
#include "ir/bytecode/image_sections.h"
#include "ir/bytecode/image_versions.h"
#include "ir/bytecode/section_fields.h"

namespace ir {
namespace {

constexpr size_t kDigestAt = 16;
constexpr size_t kHeaderBytes = kDigestAt + sizeof(base::Digest);

constexpr const char* kSectionNames[] = {"program", "types",  "constants", "layouts", "pous",
                                         "code",    "tables", "data",      "devices", "sources"};
constexpr size_t kBytesForThreads = 1 << 20;  // below, threads cost more than they save

base::Error bad_format(std::string text) {
  return {base::Refusal::kBadFormat, "image: " + std::move(text)};
}

bool has_task_exchange(const Image& image) {
  for (const ImageTask& task : image.tasks) {
    if (task.policy.output_buffer != IoBuffer::kCopied) return true;
    if (task.policy.exchange != TaskExchange::kOfCycle) return true;
  }
  return false;
}

bool has_other_types(const Image& image) {
  return std::any_of(image.migrations.begin(), image.migrations.end(),
                     [](const LinkedMigration& row) { return row.from_other; });
}

uint32_t version_without_sources(const Image& image) {
  if (!image.unit_members.empty()) return kImageVersionOfUnits;
  if (has_other_types(image)) return kImageVersionOfOtherTypes;
  if (has_task_exchange(image)) return kImageVersionOfTaskExchange;
  if (!image.held.empty()) return kImageVersionOfHeld;
  if (!image.contents.empty()) return kImageVersionOfContents;
  if (!image.charts.empty()) return kImageVersionOfCharts;
  return image.schedule == Schedule::kSendFirst ? kFirstImageVersion : kImageVersionOfSchedules;
}

uint32_t version_of(const Image& image, bool has_sources) {
  const uint32_t version = version_without_sources(image);
  if (!has_sources) return version;
  return version < kImageVersionOfSources ? kImageVersionOfSources : version + 1;
}

uint32_t sections_of(uint32_t version) {
  return version_has_sources(version) ? kImageSectionCount + 1 : kImageSectionCount;
}

// The version in a header that is there.
uint32_t stored_version(base::ByteSpan bytes) {
  return base::ByteReader(bytes.subspan(kImageMagic.size())).u32();
}

base::Status check_header(base::ByteSpan bytes) {
  base::ByteReader in(bytes);
  const base::ByteSpan magic = in.raw(kImageMagic.size());
  const uint32_t version = in.u32();
  const uint32_t length = in.u32();
  in.raw(sizeof(base::Digest));
  if (in.failed()) return bad_format("only " + std::to_string(bytes.size()) + " bytes");
  if (!std::equal(magic.begin(), magic.end(), kImageMagic.begin()))
    return bad_format("no magic number");
  if (version < kFirstImageVersion || version > kLastImageVersion) {
    return bad_format("version " + std::to_string(version) + ", this program reads " +
                      std::to_string(kFirstImageVersion) + " to " +
                      std::to_string(kLastImageVersion));
  }
  if (length > base::kMaxImageBytes) {
    return base::Error{base::Refusal::kTooLarge, "image of " + std::to_string(length) +
                                                     " bytes; the limit is " +
                                                     std::to_string(base::kMaxImageBytes)};
  }
  if (length != bytes.size()) {
    return bad_format("header says " + std::to_string(length) + " bytes, there are " +
                      std::to_string(bytes.size()));
  }
  return base::Ok{};
}

// How many bytes at the beginning are known to be equal in both; more may be.
size_t same_bytes(base::ByteSpan a, base::ByteSpan b) {
  constexpr size_t kStep = base::Sha256Trail::kStep;
  const size_t most = std::min(a.size(), b.size());
  size_t same = 0;
  while (same + kStep <= most && std::memcmp(a.data() + same, b.data() + same, kStep) == 0) {
    same += kStep;
  }
  return same;
}

// What the header should say; with its trail.
base::Digest sum_of(base::ByteSpan bytes, const KnownImage* known, base::Sha256Trail& trail) {
  bytes = bytes.subspan(kHeaderBytes);
  if (known == nullptr) return base::sha256(bytes, {}, 0, trail);
  const size_t same = same_bytes(bytes, known->bytes.subspan(kHeaderBytes));
  return base::sha256(bytes, known->places.trail, same, trail);
}

base::Status check_sum(base::ByteSpan bytes, const KnownImage* known, base::Sha256Trail& trail) {
  const base::Digest actual = sum_of(bytes, known, trail);
  if (actual == digest(bytes)) return base::Ok{};
  return base::Error{base::Refusal::kBadHash, "image: content hash is " + base::short_hex(actual) +
                                                  ", header says " +
                                                  base::short_hex(digest(bytes))};
}

// A part of the work of decoding, and what came of it.
struct WorkShare {
  uint32_t first = 0;  // section
  uint32_t end = 0;
  base::Status done = base::Ok{};
  bool no_memory = false;
};

std::string name_of(uint32_t section) {
  return std::string("section `") + kSectionNames[section] + "`";
}

using Contents = std::array<base::ByteSpan, kImageSectionCount + 1>;

// What they are, and the error of the first that is not there.
base::Status split(base::ByteSpan bytes, Contents& contents, uint32_t& count) {
  base::ByteReader in(bytes.subspan(kHeaderBytes));
  const uint32_t sections = sections_of(stored_version(bytes));
  for (count = 0; count < sections; ++count) {
    if (in.u32() != count) return bad_format(name_of(count) + " is missing");
    contents[count] = in.blob();
    if (in.failed()) return bad_format(name_of(count) + " is cut off");
  }
  if (!in.done()) return bad_format("bytes after the last section");
  return base::Ok{};
}

// The contents of an image that was made here or decoded.
Contents contents_of(const KnownImage* known) {
  Contents contents;
  uint32_t count = 0;
  if (known != nullptr) (void)split(known->bytes, contents, count).ok();
  return contents;
}

base::Status decode_sections(const Contents& contents, const WorkShare& part,
                             const KnownImage* known, const Contents& known_contents,
                             DecodedImage& out) {
  for (uint32_t number = part.first; number < part.end; ++number) {
    base::ByteReader content(contents[number]);
    ImageReader archive(content, contents[number]);
    section(archive, out.image, number, Beside{known, out.places, known_contents[number]});
    if (content.done()) continue;
    return bad_format(name_of(number) + " is damaged at its byte " + std::to_string(content.at()));
  }
  return base::Ok{};
}

// More than most images take, from how much there is of what takes most.
size_t rough_bytes(const Image& image) {
  size_t bytes = 4096 + image.code.size() * sizeof(Unit) + image.constants.size() * 64 +
                 image.instances.size() * 64 + image.pool.size();
  for (uint32_t i = 0; i < image.types.size(); ++i) {
    bytes += 128 + image.types[TypeId(i)].members.size() * 64;
  }
  for (const LinkedPou& pou : image.pous) {
    bytes += 192 + pou.slots.size() * 48 + pou.merges.size() * 48 + pou.lines.size() * 8;
  }
  for (const DataRun& run : image.data) bytes += 8 + run.bytes.size();
  return bytes;
}

}  // namespace

base::Bytes encode(const Image& image) { return encode(image, nullptr).bytes; }

WrittenImage encode(const Image& image, const KnownImage* known, base::ByteSpan sources) {
  WrittenImage made;
  ImageWriter out(sources.size() +
                  (known == nullptr ? rough_bytes(image) : known->bytes.size() + kBytesForThreads));
  const Contents known_contents = contents_of(known);
  out.raw(base::as_bytes(kImageMagic));
  out(version_of(image, !sources.empty()));
  out(0u);
  out.raw(base::Digest{});
  for (uint32_t number = 0; number < kImageSectionCount; ++number) {
    out(number);
    const size_t length_at = out.size();
    out(0u);
    out.begin_section();
    section(out, image, number, Beside{known, made.places, known_contents[number]});
    out.patch_u32(length_at, static_cast<uint32_t>(out.size() - length_at - 4));
  }
  if (!sources.empty()) {
    out(static_cast<uint32_t>(ImageSection::kSources));
    out(static_cast<uint32_t>(sources.size()));
    out.raw(sources);
  }
  out.patch_u32(kImageMagic.size() + 4, static_cast<uint32_t>(out.size()));
  made.bytes = out.take();
  const base::Digest sum = sum_of(made.bytes, known, made.places.trail);
  std::copy(sum.begin(), sum.end(), made.bytes.begin() + kDigestAt);
  return made;
}

base::Result<Image> decode(base::ByteSpan bytes) {
  base::Result<DecodedImage> decoded = decode(bytes, nullptr);
  if (!decoded.ok()) return decoded.error();
  return std::move(decoded->image);
}

// Checks the checksum and decodes the tables at once where that pays; the answer is that of one
// after the other. Of two threads the caller's makes all tables: other threads take memory from
// heaps of their own, which grow page by page.
base::Result<DecodedImage> decode(base::ByteSpan bytes, const KnownImage* known) {
  if (base::Status header = check_header(bytes); !header) return header.error();
  DecodedImage out;
  Contents contents;
  uint32_t count = 0;
  const base::Status whole = split(bytes, contents, count);
  const bool has_sources = count > kImageSectionCount;
  count = std::min(count, kImageSectionCount);
  const Contents known_contents = contents_of(known);
  const uint32_t jobs = bytes.size() < kBytesForThreads ? 1 : base::usable_cores();
  const uint32_t pous =
      jobs == 2 ? count : std::min(count, static_cast<uint32_t>(ImageSection::kPous));
  // The checksum, two parts of the sections: in the order of their errors.
  std::array<WorkShare, 3> parts = {WorkShare{}, WorkShare{.end = pous},
                                    WorkShare{.first = pous, .end = count}};
  const auto work = [&](size_t number) {
    WorkShare& part = parts[number];
    if (jobs == 1 && !parts[0].done.ok()) return;
    part.done = number == 0 ? check_sum(bytes, known, out.places.trail)
                            : decode_sections(contents, part, known, known_contents, out);
  };
  constexpr uint8_t kTurns[][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}};  // of 1, 2, more threads
  const auto& turns = kTurns[std::min(jobs, 3u) - 1];
  base::for_each_index(parts.size(), jobs, 1, [&](size_t turn) {
    const size_t number = turns[turn];
    parts[number].no_memory =
        base::within_memory([&] { return work(number), false; }, [] { return true; });
  });
  if (std::any_of(parts.begin(), parts.end(), [](const WorkShare& p) { return p.no_memory; })) {
    out = DecodedImage();  // once more, in the caller's memory limit
    for (size_t number = 0; number < parts.size(); ++number) work(number);
  }
  for (const WorkShare& part : parts) {
    if (!part.done.ok()) return part.done.error();
  }
  if (!whole.ok()) return whole.error();
  if (has_sources) {
    if (auto sources = decode_sources(contents.back()); !sources.ok()) return sources.error();
  }
  const uint32_t stored = stored_version(bytes);
  const uint32_t actual = version_of(out.image, has_sources);
  if (stored != actual) {  // the checksum does not cover it
    return bad_format("version " + std::to_string(stored) + ", its sections are of version " +
                      std::to_string(actual));
  }
  return out;
}

base::ByteSpan section_of(base::ByteSpan encoded, ImageSection section) {
  base::ByteReader in(encoded.subspan(std::min(kHeaderBytes, encoded.size())));
  base::ByteSpan content;
  for (uint32_t number = 0; number <= static_cast<uint32_t>(section) && !in.failed(); ++number) {
    in.u32();
    content = in.blob();
  }
  return in.failed() ? base::ByteSpan() : content;
}

base::ByteSpan sealed_part(base::ByteSpan encoded) {
  return encoded.subspan(std::min(kHeaderBytes, encoded.size()));
}

size_t layout_end(base::ByteSpan encoded) {
  const base::ByteSpan last = section_of(encoded, ImageSection::kLayouts);
  if (last.data() == nullptr) return encoded.size();
  return static_cast<size_t>(last.data() - encoded.data()) + last.size();
}

bool has_image_magic(base::ByteSpan bytes) {
  return bytes.size() >= kImageMagic.size() &&
         std::equal(kImageMagic.begin(), kImageMagic.end(), bytes.begin());
}

base::Digest digest(base::ByteSpan encoded) {
  base::Digest sum{};
  if (encoded.size() >= kHeaderBytes) {
    std::copy_n(encoded.begin() + kDigestAt, sum.size(), sum.begin());
  }
  return sum;
}

}  // namespace ir
