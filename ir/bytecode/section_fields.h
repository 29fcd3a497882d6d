// The sections of an image in stored order, once for both directions (image_fields.h), beside
// another version where one is known (image_beside.h).
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "ir/bytecode/image_beside.h"
#include "ir/bytecode/image_fields.h"

namespace ir {

// What another version of the same program has: what is the same there; nothing, when none is
// known.
struct Beside {
  const KnownImage* known = nullptr;
  ImagePlaces& places;          // of the image itself
  base::ByteSpan content = {};  // of the section, in the other version

  template <class V>
  const V* whole(V Image::*part) const {
    return known == nullptr ? nullptr : &(known->image.*part);
  }
};

// A table that is shared as a whole with its section.
template <class Archive, class I, class V, class Make>
void whole_section(Archive& a, I& image, V Image::*part, const Beside& beside, Make make) {
  const V* const known = beside.whole(part);
  if (known == nullptr || !a.shares(image.*part, *known, beside.content)) make();
}

// A table inside a section.
template <class Archive, class I, class V, class Make>
void shared_table(Archive& a, I& image, V Image::*part, const Beside& beside,
                  ImagePlaces::Table ImagePlaces::*place, Make make) {
  ImagePlaces::Table& now = beside.places.*place;
  now.begin = static_cast<uint32_t>(a.at());
  const V* const known = beside.whole(part);
  base::ByteSpan bytes;
  if (known != nullptr) {
    const ImagePlaces::Table& old = beside.known->places.*place;
    bytes = beside.content.subspan(old.begin, old.end - old.begin);
  }
  if (known == nullptr || !a.shares(image.*part, *known, bytes)) make(image.*part);
  now.end = static_cast<uint32_t>(a.at());
}

inline void types_section(ImageWriter& a, const TypeTable& types) {
  a.list(types.old_names(), 4, a);
  a(types.size() - kElementaryCount);
  for (uint32_t i = kElementaryCount; i < types.size(); ++i) type_fields(a, types[TypeId(i)]);
}

inline bool is_interned(const Type& type) {
  return type.name.empty() && !type.init.valid() && !type.old_name.valid() &&
         (type.kind == Kind::kString || type.kind == Kind::kWstring || type.kind == Kind::kArray ||
          type.kind == Kind::kSubrange || is_reference(type.kind));
}

inline TypeId intern(TypeTable& types, const Type& type) {
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
inline void add_type(TypeTable& types, Type type) {
  const TypeId expected(types.size());
  if (is_interned(type) && intern(types, type) == expected) return;
  types.declare(std::move(type));
}

inline void types_section(ImageReader& a, TypeTable& types) {
  std::vector<std::string> old_names;
  a.list(old_names, 4, a);
  types.set_old_names(std::move(old_names));
  a.each(54, types, [&] {
    Type type;
    type_fields(a, type);
    add_type(types, std::move(type));
  });
}

inline void constants_section(ImageWriter& a, const ConstTable& constants) {
  a(constants.size());
  for (uint32_t i = 0; i < constants.size(); ++i) constant_fields(a, constants[ConstId(i)]);
}

inline void constants_section(ImageReader& a, ConstTable& constants) {
  a.each(16, constants, [&] {
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
  a.last_enumerator(image.schedule, kScheduleCount);
}

// With the places that its tables have here.
template <class Archive, class P>
void pou_tables(Archive& a, P& pou, const LinkedPou* known, base::ByteSpan content,
                const ImagePlaces::Pou& old, ImagePlaces::Pou& now) {
  const auto at = [&] { return static_cast<uint32_t>(a.at()); };
  const auto bytes = [&](uint32_t begin, uint32_t end) {
    return known == nullptr ? base::ByteSpan() : content.subspan(begin, end - begin);
  };
  now.slots = at();
  if (known == nullptr || !a.shares(pou.slots, known->slots, bytes(old.slots, old.merges))) {
    slots_of(a, pou.slots);
  }
  now.merges = at();
  if (known == nullptr || !a.shares(pou.merges, known->merges, bytes(old.merges, old.lines))) {
    merges_of(a, pou.merges);
  }
  now.lines = at();
  if (known == nullptr || !a.shares(pou.lines, known->lines, bytes(old.lines, old.end))) {
    lines_of(a, pou.lines);
  }
  now.end = at();
}

template <class Archive, class I>
void pous_section(Archive& a, I& image, const Beside& beside) {
  const auto* const known = beside.known;
  const size_t both =
      known == nullptr ? 0 : std::min(known->image.pous.size(), known->places.pous.size());
  std::vector<ImagePlaces::Pou>& places = beside.places.pous;
  places.reserve(both);
  a.list(image.pous, 69, [&](auto& pou) {
    pou_fields(a, pou);
    const size_t number = places.size();
    const bool has_other = number < both;
    pou_tables(a, pou, has_other ? &known->image.pous[number] : nullptr, beside.content,
               has_other ? known->places.pous[number] : ImagePlaces::Pou(), places.emplace_back());
  });
  a.last_list(image.unit_members, 8, [&](auto& row) {
    a(row.name);
    a(row.unit);
  });
}

template <class Archive, class I>
void tables_section(Archive& a, I& image, const Beside& beside) {
  a(image.pool);
  shared_table(a, image, &Image::bounds, beside, &ImagePlaces::bounds, [&](auto& bounds) {
    a.list(bounds, 29, [&](auto& bound) { bound_fields(a, bound); });
  });
  shared_table(a, image, &Image::ranges, beside, &ImagePlaces::ranges, [&](auto& ranges) {
    a.list(ranges, 20, [&](auto& range) {
      a(range.low);
      a(range.high);
      a(range.name);
    });
  });
  a.list(image.overrides, 12, [&](auto& row) { override_fields(a, row); });
  shared_table(a, image, &Image::instances, beside, &ImagePlaces::instances, [&](auto& instances) {
    a.list(instances, 29, [&](auto& instance) { instance_fields(a, instance); });
  });
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
  a.last_list(image.charts, 8, [&](auto& chart) { chart_fields(a, chart); });
}

// To be filled, or to be written.
template <class T>
T& content_of(base::Shared<T>& table) {
  return table.own();
}
template <class T>
const T& content_of(const base::Shared<T>& table) {
  return *table;
}

template <class Archive, class I>
void section(Archive& a, I& image, uint32_t number, const Beside& beside) {
  switch (number) {
    case 0:
      return program_section(a, image);
    case 1:
      return whole_section(a, image, &Image::types, beside,
                           [&] { types_section(a, content_of(image.types)); });
    case 2:
      return whole_section(a, image, &Image::constants, beside,
                           [&] { constants_section(a, content_of(image.constants)); });
    case 3:
      return whole_section(a, image, &Image::layouts, beside, [&] {
        a.list(content_of(image.layouts).of, 20, [&](auto& layout) { layout_fields(a, layout); });
      });
    case 4:
      return pous_section(a, image, beside);
    case 5:
      return a.plain_list(image.code);
    case 6:
      return tables_section(a, image, beside);
    case 7:
      return whole_section(a, image, &Image::data, beside, [&] {
        a.list(image.data, 8, [&](auto& run) {
          a(run.offset);
          a(run.bytes);
        });
      });
    default:
      a.list(image.devices, 25, [&](auto& device) { device_fields(a, device); });
      a.last_list(image.contents, sizeof(PouContent), [&](auto& content) { a(content.identity); });
      return a.last_list(image.held, 9, [&](auto& row) {
        a(row.pou);
        a.enumerator(row.what.kind, 3);
        a(row.what.name);
      });
  }
}

}  // namespace ir
