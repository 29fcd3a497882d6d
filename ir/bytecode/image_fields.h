// The fields of an image in stored order, once for both directions: an Archive is
// ImageWriter or ImageReader, so what is written is what is read.
#pragma once

#include "ir/bytecode/image_archive.h"

namespace ir {

// Each `record` below takes `T` or `const T`, as the archive needs.

template <class Archive, class Address>
void address_fields(Archive& a, Address& v) {
  a.enumerator(v.area, 4);
  a(v.bit_offset);
  a(v.bit_size);
}

template <class Archive, class T>
void type_fields(Archive& a, T& v) {
  a.enumerator(v.kind, kKindCount);
  a(v.name);
  a(v.base);
  a(v.low);
  a(v.high);
  a(v.capacity);
  a.list(v.dims, 16, [&](auto& dim) {
    a(dim.low);
    a(dim.high);
  });
  a.list(v.members, 28, [&](auto& member) {
    a(member.name);
    a(member.type);
    a.enumerator(member.section, 6);
    a(member.constant);
    a(member.retain);
    a(member.init);
    address_fields(a, member.address);
    a(member.old_name);
  });
  a(v.overlap);
  a.list(v.literals, 16, [&](auto& literal) {
    a(literal.name);
    a(literal.value);
    a(literal.old_name);
  });
  a.list(v.interfaces, 4, a);
  a(v.init);
  a(v.old_name);
}

template <class Archive, class T>
void constant_fields(Archive& a, T& v) {
  a(v.bits);
  a.text_bytes(v.text);
  a.list(v.elements, 12, [&](auto& element) {
    a(element.first);
    a(element.count);
    a(element.value);
  });
}

template <class Archive, class T>
void layout_fields(Archive& a, T& v) {
  a(v.size);
  a(v.align);
  a.plain_list(v.member_offsets);
  a(v.used);
  a(v.area_capacity);
}

template <class Archive, class R>
void region_fields(Archive& a, R& v) {
  a(v.type);
  a(v.dim);
}

template <class Archive, class T>
void slot_fields(Archive& a, T& v) {
  a(v.offset);
  a.enumerator(v.kind, 3);
  a.enumerator(v.local, 5);
  a(v.aggregate);
  a.enumerator(v.cls, kClassCount);
  region_fields(a, v.region);
  a(v.name);
}

template <class Archive, class T>
void pou_fields(Archive& a, T& v) {
  a(v.name);
  a.enumerator(v.kind, kPouKindCount);
  a(v.self);
  a(v.recursion_depth);
  a(v.file);
  a(v.identity);
  a(v.frame_size);
  a(v.first_unit);
  a(v.unit_count);
}
// The tables of the type follow.
template <class Archive, class T>
void slots_of(Archive& a, T& v) {
  a.list(v, 17, [&](auto& slot) { slot_fields(a, slot); });
}
template <class Archive, class T>
void merges_of(Archive& a, T& v) {
  a.list(v, 8, [&](auto& merge) {
    a(merge.unit);
    a.plain_list(merge.slots);
  });
}
template <class Archive, class T>
void lines_of(Archive& a, T& v) {
  a.plain_list(v);
}

template <class Archive, class T>
void bound_fields(Archive& a, T& v) {
  a(v.low);
  a(v.count);
  a(v.stride);
  region_fields(a, v.from);
  a(v.name);
}

template <class Archive, class T>
void instance_fields(Archive& a, T& v) {
  a(v.type);
  a(v.data);
  a(v.pou);
  a(v.parent);
  a(v.generation);
  a(v.live);
  a(v.name);
  a(v.old_name);
}

template <class Archive, class T>
void policy_fields(Archive& a, T& v) {
  a.enumerators(v.io, 2, v.exchange, kTaskExchangeCount);
  a.enumerators(v.input_buffer, kIoBufferCount, v.output_buffer, kIoBufferCount);
  a.enumerator(v.overrun, 5);
  a.enumerator(v.on_trap, 4);
  a(v.freewheeling);
}

template <class Archive, class T>
void task_fields(Archive& a, T& v) {
  a(v.name);
  a(v.period_ns);
  a(v.watchdog_ns);
  a(v.priority);
  a(v.event);
  a.plain_list(v.programs);
  a(v.once);
  policy_fields(a, v.policy);
}

template <class Archive, class T>
void safe_fields(Archive& a, T& v) {
  a(v.bit_offset);
  a(v.bits);
  a.enumerator(v.kind, 3);
  a(v.value);
  a(v.hold_ns);
}

template <class Archive, class T>
void override_fields(Archive& a, T& v) {
  a(v.type);
  a(v.prototype);
  a(v.target);
}

template <class Archive, class T>
void migration_fields(Archive& a, T& v) {
  a(v.type);
  a(v.pou);
  a.enumerators(v.inverse, 2, v.from_other, 2);
  if (v.from_other) a(v.from);
  a.list(v.values, 9, [&](auto& value) {
    a(value.parameter);
    a(value.member);
    a(value.output);
  });
}

template <class Archive, class T>
void chart_fields(Archive& a, T& v) {
  a(v.pou);
  a.list(v.moves, 8, [&](auto& move) {
    a.plain_list(move.from);
    a.plain_list(move.to);
  });
}

template <class Archive, class T>
void device_fields(Archive& a, T& v) {
  a(v.name);
  a(v.driver);
  a.list(v.settings, 8, [&](auto& setting) {
    a(setting.key);
    a(setting.value);
  });
  a.list(v.map, 20, [&](auto& entry) {
    a.enumerator(entry.table, kPointTableCount);
    a(entry.first);
    a(entry.count);
    a(entry.to_device);
    address_fields(a, entry.at);
    a(entry.writable);
  });
  address_fields(a, v.quality);
}

template <class Archive, class T>
void access_fields(Archive& a, T& v) {
  a(v.name);
  a(v.path);
  a(v.writable);
}

}  // namespace ir
