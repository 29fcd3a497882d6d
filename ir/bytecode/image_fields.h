// The fields of an image in stored order, once for both directions: an Archive is
// ImageWriter or ImageReader, so what is written is what is read.
#pragma once

#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/bytes.h"
#include "ir/bytecode/image.h"

namespace ir {

// As base::ByteWriter; the fields of a large image are many, so they are gathered first.
class ImageWriter {
 public:
  // `expected` bytes, or some more: what is not written takes no memory.
  explicit ImageWriter(size_t expected) { bytes_.reserve(expected); }
  ImageWriter(const ImageWriter&) = delete;
  ImageWriter& operator=(const ImageWriter&) = delete;
  void operator()(const bool& v) { number(static_cast<uint8_t>(v ? 1 : 0)); }
  void operator()(const uint8_t& v) { number(v); }
  void operator()(const uint16_t& v) { number(v); }
  void operator()(const uint32_t& v) { number(v); }
  void operator()(const uint64_t& v) { number(v); }
  void operator()(const int64_t& v) { number(v); }
  void operator()(const std::string& v) {
    count(v.size());
    raw(base::as_bytes(v));
  }
  void operator()(const base::Bytes& v) {
    count(v.size());
    raw(v);
  }
  void operator()(const base::Digest& v) { raw(v); }
  template <class Tag>
  void operator()(const base::Id<Tag>& v) {
    number(v.index);
  }
  template <class E>
  void enumerator(const E& v, uint32_t) {
    number(static_cast<uint8_t>(v));
  }
  // `min_size`: bytes of the smallest record.
  template <class T, class Each>
  void list(const std::vector<T>& v, size_t, Each&& each) {
    count(v.size());
    for (const T& item : v) each(item);
  }
  template <class T, class Each>
  void list(const base::SharedVector<T>& v, size_t min_size, Each&& each) {
    list(v.all(), min_size, each);
  }
  // Records that are stored as they lie in memory.
  template <class T>
  void plain_list(const std::vector<T>& v) {
    static_assert(std::has_unique_object_representations_v<T>);
    count(v.size());
    raw({reinterpret_cast<const uint8_t*>(v.data()), v.size() * sizeof(T)});
  }
  template <class T>
  void plain_list(const base::SharedVector<T>& v) {
    plain_list(v.all());
  }
  // `bytes`: of the same value in another version.
  template <class V>
  bool shares(const V& v, const V& known, base::ByteSpan bytes) {
    if (!v.is_one_with(known)) return false;
    raw(bytes);
    return true;
  }

  void raw(base::ByteSpan v) {
    if (v.size() > sizeof gathered_ - used_) flush();
    if (v.size() > sizeof gathered_) {
      bytes_.insert(bytes_.end(), v.begin(), v.end());
    } else if (!v.empty()) {
      std::memcpy(gathered_ + used_, v.data(), v.size());
      used_ += v.size();
    }
  }
  size_t size() const { return bytes_.size() + used_; }
  // The same, from the beginning of the section.
  size_t at() const { return size() - section_; }
  void begin_section() { section_ = size(); }
  // What was written before.
  void patch_u32(size_t at, uint32_t v) {
    flush();
    std::memcpy(bytes_.data() + at, &v, sizeof v);
  }
  base::Bytes take() {
    flush();
    return std::move(bytes_);
  }

 private:
  void count(size_t n) { number(static_cast<uint32_t>(n)); }
  template <class T>
  [[gnu::always_inline]] void number(T v) {
    if (sizeof v > sizeof gathered_ - used_) flush();
    std::memcpy(gathered_ + used_, &v, sizeof v);
    used_ += sizeof v;
  }
  void flush() {
    bytes_.insert(bytes_.end(), gathered_, gathered_ + used_);
    used_ = 0;
  }

  base::Bytes bytes_;
  uint8_t gathered_[4096];
  size_t used_ = 0;     // of these
  size_t section_ = 0;  // where it began
};

class ImageReader {
  template <class T>
  struct Stored {  // at any address
    uint8_t bytes[sizeof(T)];
    operator T() const {  // NOLINT: that is what it is
      T v;
      std::memcpy(&v, bytes, sizeof v);
      return v;
    }
  };

 public:
  // `content`: all that `in` reads.
  ImageReader(base::ByteReader& in, base::ByteSpan content) : in_(in), content_(content) {}
  void operator()(bool& v) { v = in_.boolean(); }
  void operator()(uint8_t& v) { v = in_.u8(); }
  void operator()(uint16_t& v) { v = in_.u16(); }
  void operator()(uint32_t& v) { v = in_.u32(); }
  void operator()(uint64_t& v) { v = in_.u64(); }
  void operator()(int64_t& v) { v = in_.i64(); }
  void operator()(std::string& v) {
    const base::ByteSpan bytes = in_.blob();
    if (!bytes.empty()) v.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void operator()(base::Bytes& v) {
    const base::ByteSpan bytes = in_.blob();
    v.assign(bytes.begin(), bytes.end());
  }
  void operator()(base::Digest& v) {
    const base::ByteSpan bytes = in_.raw(v.size());
    std::copy(bytes.begin(), bytes.end(), v.begin());
  }
  template <class Tag>
  void operator()(base::Id<Tag>& v) {
    v = base::Id<Tag>(in_.u32());
  }
  template <class E>
  void enumerator(E& v, uint32_t limit) {
    v = in_.enumerator<E>(limit);
  }
  template <class T, class Each>
  void list(std::vector<T>& v, size_t min_size, Each each) {
    v.resize(in_.count(min_size));
    for (T& item : v) {
      if (in_.failed()) return;
      each(item);
    }
  }
  template <class T, class Each>
  void list(base::SharedVector<T>& v, size_t min_size, Each each) {
    std::vector<T> all;
    list(all, min_size, each);
    v = std::move(all);
  }
  template <class T>
  void plain_list(std::vector<T>& v) {
    const auto count = in_.count(sizeof(T));
    const base::ByteSpan bytes = in_.raw(size_t{count} * sizeof(T));
    const auto* const first = reinterpret_cast<const Stored<T>*>(bytes.data());
    if (!bytes.empty()) v.assign(first, first + count);  // not made empty first, as by resize()
  }
  template <class T>
  void plain_list(base::SharedVector<T>& v) {
    std::vector<T> all;
    plain_list(all);
    v = std::move(all);
  }
  // `bytes`: of `known` in another version. The same bytes are the same value.
  template <class V>
  bool shares(V& v, const V& known, base::ByteSpan bytes) {
    if (!takes(bytes)) return false;
    v = known;
    return true;
  }
  // Behind bytes that are these; else where it was.
  bool takes(base::ByteSpan bytes) {
    if (in_.left() < bytes.size()) return false;
    if (!std::equal(bytes.begin(), bytes.end(), content_.begin() + in_.at())) return false;
    in_.raw(bytes.size());
    return true;
  }
  size_t at() const { return in_.at(); }
  // A list that goes into `table`, one after the other.
  template <class Table, class Each>
  void each(size_t min_size, Table& table, Each each) {
    uint32_t left = in_.count(min_size);
    for (table.reserve(table.size() + left); left != 0 && !in_.failed(); --left) each();
  }

 private:
  base::ByteReader& in_;
  base::ByteSpan content_;
};

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
  a(v.text);
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
// Its tables follow.
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
void task_fields(Archive& a, T& v) {
  a(v.name);
  a(v.period_ns);
  a(v.watchdog_ns);
  a(v.priority);
  a(v.event);
  a.plain_list(v.programs);
  a(v.once);
  a.enumerator(v.policy.io, 2);
  a.enumerator(v.policy.input_buffer, 5);
  a.enumerator(v.policy.overrun, 3);
  a.enumerator(v.policy.on_trap, 4);
  a(v.policy.freewheeling);
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
  a(v.inverse);
  a.list(v.values, 9, [&](auto& value) {
    a(value.parameter);
    a(value.member);
    a(value.output);
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
