// The stored form of an image:
//   8 bytes magic, u32 version, u32 length of the whole, SHA-256 of all that follows,
//   then the sections in the order of Section, each {u32 number, u32 length, content}.
#include "ir/bytecode/image.h"

#include <algorithm>
#include <array>

#include "base/limits.h"
#include "base/memory_limit.h"
#include "base/parallel.h"
#include "ir/bytecode/image_fields.h"
#include "ir/bytecode/image_sections.h"

namespace ir {
namespace {

constexpr uint32_t kVersion = 7;
constexpr size_t kDigestAt = 16;
constexpr size_t kHeaderBytes = kDigestAt + sizeof(base::Digest);

constexpr const char* kSectionNames[] = {"program", "types",  "constants", "layouts", "pous",
                                         "code",    "tables", "data",      "devices"};
constexpr uint32_t kSectionCount = 9;
constexpr size_t kBytesForThreads = 1 << 20;  // below, threads cost more than they save

base::Error bad_format(std::string text) {
  return {base::Refusal::kBadFormat, "image: " + std::move(text)};
}

void types_section(ImageWriter& a, const TypeTable& types) {
  a.list(types.old_names(), 4, a);
  a(types.size() - kElementaryCount);
  for (uint32_t i = kElementaryCount; i < types.size(); ++i) type_fields(a, types[TypeId(i)]);
}

bool is_interned(const Type& type) {
  return type.name.empty() && !type.init.valid() && !type.old_name.valid() &&
         (type.kind == Kind::kString || type.kind == Kind::kWstring || type.kind == Kind::kArray ||
          type.kind == Kind::kSubrange || is_reference(type.kind));
}

TypeId intern(TypeTable& types, const Type& type) {
  switch (type.kind) {
    case Kind::kString:
      return types.string(type.capacity);
    case Kind::kWstring:
      return types.wstring(type.capacity);
    case Kind::kArray:
      return types.array(type.base, type.dims);
    case Kind::kPointer:
    case Kind::kRefTo:
    case Kind::kReferenceTo:
      return types.reference(type.kind, type.base);
    default:
      return types.subrange(type.base, type.low, type.high);
  }
}

// Type numbers stay as they are stored; anonymous types are found by content again.
void add_type(TypeTable& types, Type type) {
  const TypeId expected(types.size());
  if (is_interned(type) && intern(types, type) == expected) return;
  types.declare(std::move(type));
}

void types_section(ImageReader& a, TypeTable& types) {
  std::vector<std::string> old_names;
  a.list(old_names, 4, a);
  types.set_old_names(std::move(old_names));
  a.each(54, [&] {
    Type type;
    type_fields(a, type);
    add_type(types, std::move(type));
  });
}

void constants_section(ImageWriter& a, const ConstTable& constants) {
  a(constants.size());
  for (uint32_t i = 0; i < constants.size(); ++i) constant_fields(a, constants[ConstId(i)]);
}

void constants_section(ImageReader& a, ConstTable& constants) {
  a.each(16, [&] {
    ConstValue value;
    constant_fields(a, value);
    constants.add(std::move(value));
  });
}

template <class Archive, class I>
void program_section(Archive& a, I& image) {
  a(image.name);
  a(image.globals);
  a(image.data_capacity);
  a(image.stack_bytes);
  a(image.call_depth);
  a(image.input_bytes);
  a(image.output_bytes);
}

template <class Archive, class I>
void tables_section(Archive& a, I& image) {
  a(image.pool);
  a.list(image.bounds, 29, [&](auto& bound) { bound_fields(a, bound); });
  a.list(image.ranges, 20, [&](auto& range) {
    a(range.low);
    a(range.high);
    a(range.name);
  });
  a.list(image.overrides, 12, [&](auto& row) { override_fields(a, row); });
  a.list(image.instances, 29, [&](auto& instance) { instance_fields(a, instance); });
  a.list(image.free, 8, [&](auto& extent) {
    a(extent.offset);
    a(extent.size);
  });
  a.list(image.tasks, 38, [&](auto& task) { task_fields(a, task); });
  a.list(image.access, 9, [&](auto& access) { access_fields(a, access); });
  a.list(image.migrations, 13, [&](auto& row) { migration_fields(a, row); });
  a.list(image.io, 17, [&](auto& binding) {
    address_fields(a, binding.address);
    a(binding.data);
    a(binding.type);
  });
  a.list(image.safe, 25, [&](auto& row) { safe_fields(a, row); });
  a.list(image.retain, 8, [&](auto& range) {
    a(range.data);
    a(range.size);
  });
  a.list(image.shared, 5, [&](auto& global) {
    a(global.member);
    a(global.written);
  });
}

template <class Archive, class I>
void section(Archive& a, I& image, uint32_t number) {
  switch (number) {
    case 0:
      return program_section(a, image);
    case 1:
      return types_section(a, image.types);
    case 2:
      return constants_section(a, image.constants);
    case 3:
      return a.list(image.layouts.of, 20, [&](auto& layout) { layout_fields(a, layout); });
    case 4:
      return a.list(image.pous, 69, [&](auto& pou) { pou_fields(a, pou); });
    case 5:
      return a(image.code);
    case 6:
      return tables_section(a, image);
    case 7:
      return a.list(image.data, 8, [&](auto& run) {
        a(run.offset);
        a(run.bytes);
      });
    default:
      return a.list(image.devices, 25, [&](auto& device) { device_fields(a, device); });
  }
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
  if (version != kVersion) {
    return bad_format("version " + std::to_string(version) + ", this program reads " +
                      std::to_string(kVersion));
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

base::Status check_sum(base::ByteSpan bytes) {
  const base::Digest actual = base::sha256(bytes.subspan(kHeaderBytes));
  if (actual == digest(bytes)) return base::Ok{};
  return base::Error{base::Refusal::kBadHash, "image: content hash is " + base::short_hex(actual) +
                                                  ", header says " +
                                                  base::short_hex(digest(bytes))};
}

// A part of the work of decoding, and what came of it.
struct Part {
  uint32_t first = 0;  // section
  uint32_t end = 0;
  base::Status done = base::Ok{};
  bool no_memory = false;
};

std::string name_of(uint32_t section) {
  return std::string("section `") + kSectionNames[section] + "`";
}

using Contents = std::array<base::ByteSpan, kSectionCount>;

// What they are, and the error of the first that is not there.
base::Status split(base::ByteSpan bytes, Contents& contents, uint32_t& count) {
  base::ByteReader in(bytes.subspan(kHeaderBytes));
  for (count = 0; count < kSectionCount; ++count) {
    if (in.u32() != count) return bad_format(name_of(count) + " is missing");
    contents[count] = in.blob();
    if (in.failed()) return bad_format(name_of(count) + " is cut off");
  }
  if (!in.done()) return bad_format("bytes behind the last section");
  return base::Ok{};
}

base::Status decode_sections(const Contents& contents, const Part& part, Image& image) {
  for (uint32_t number = part.first; number < part.end; ++number) {
    base::ByteReader content(contents[number]);
    ImageReader archive(content);
    section(archive, image, number);
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

base::Bytes encode(const Image& image) {
  ImageWriter out(rough_bytes(image));
  out.raw(base::as_bytes(kImageMagic));
  out(kVersion);
  out(0u);
  out.raw(base::Digest{});
  for (uint32_t number = 0; number < kSectionCount; ++number) {
    out(number);
    const size_t length_at = out.size();
    out(0u);
    section(out, image, number);
    out.patch_u32(length_at, static_cast<uint32_t>(out.size() - length_at - 4));
  }
  out.patch_u32(kImageMagic.size() + 4, static_cast<uint32_t>(out.size()));
  base::Bytes bytes = out.take();
  const base::Digest sum = base::sha256(base::ByteSpan(bytes).subspan(kHeaderBytes));
  std::copy(sum.begin(), sum.end(), bytes.begin() + kDigestAt);
  return bytes;
}

// Its checksum, types and code at once where that pays; the answer is that of one after the other.
base::Result<Image> decode(base::ByteSpan bytes) {
  if (base::Status header = check_header(bytes); !header) return header.error();
  Image image;
  Contents contents;
  uint32_t count = 0;
  const base::Status whole = split(bytes, contents, count);
  const uint32_t pous = std::min(count, static_cast<uint32_t>(ImageSection::kPous));
  std::array<Part, 3> parts = {Part{}, Part{.end = pous}, Part{.first = pous, .end = count}};
  const uint32_t jobs = bytes.size() < kBytesForThreads ? 1 : base::usable_cores();
  const auto work = [&](size_t number) {
    Part& part = parts[number];
    if (jobs == 1 && !parts[0].done.ok()) return;
    part.done = number == 0 ? check_sum(bytes) : decode_sections(contents, part, image);
  };
  base::for_each_index(parts.size(), jobs, 1, [&](size_t number) {
    parts[number].no_memory =
        base::within_memory([&] { return work(number), false; }, [] { return true; });
  });
  if (std::any_of(parts.begin(), parts.end(), [](const Part& p) { return p.no_memory; })) {
    image = Image();  // once more, in the caller's memory limit
    for (size_t number = 0; number < parts.size(); ++number) work(number);
  }
  for (const Part& part : parts) {
    if (!part.done.ok()) return part.done.error();
  }
  if (!whole.ok()) return whole.error();
  return image;
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

std::vector<uint32_t> Image::program_ids() const {
  std::vector<uint32_t> ids;
  for (uint32_t id = 1; id < instances.size(); ++id) {
    const Instance& row = instances[id];
    if (row.live && types.contains(row.type) && types[row.type].kind == Kind::kProgram) {
      ids.push_back(id);
    }
  }
  return ids;
}

std::string Image::instance_path(uint32_t id) const {
  std::string path;
  for (uint32_t depth = 0; id != 0 && id < instances.size() && depth < base::kMaxCallDepth;
       ++depth) {
    path = path.empty() ? instances[id].name : instances[id].name + "." + path;
    id = instances[id].parent;
  }
  return path;
}

void read_initial(const Image& image, uint32_t offset, std::span<uint8_t> out) {
  std::fill(out.begin(), out.end(), uint8_t{0});
  const uint64_t end = uint64_t{offset} + out.size();
  auto run = std::upper_bound(image.data.begin(), image.data.end(), offset,
                              [](uint32_t at, const DataRun& r) { return at < r.offset; });
  if (run != image.data.begin()) --run;
  for (; run != image.data.end() && run->offset < end; ++run) {
    const uint64_t from = std::max<uint64_t>(offset, run->offset);
    const uint64_t to = std::min<uint64_t>(end, uint64_t{run->offset} + run->bytes.size());
    if (from < to) std::memcpy(&out[from - offset], &run->bytes[from - run->offset], to - from);
  }
}

uint32_t initial_id(const Image& image, uint32_t slot) {
  uint8_t bytes[4];
  read_initial(image, slot, bytes);
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

}  // namespace ir
