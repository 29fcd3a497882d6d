// Goes through all fields of an image in stored order, as its archives do: it is a third one beside
// those of ir/bytecode/image_archive.h, so no field is stored that it does not see. A field is known
// by the record that holds it and its place in that record.
//
// A visitor has three functions:
//   field(FieldPlace, T&)                of a bool, number, base::Id, string, base::Bytes or Digest
//   enumerator(FieldPlace, E&, limit)
//   list(FieldPlace, std::vector<T>&)    comes before the items, and may change how many there are
#pragma once

#include <string>
#include <type_traits>
#include <typeindex>
#include <vector>

#include "base/check.h"
#include "ir/bytecode/image_sections.h"
#include "ir/bytecode/section_fields.h"

namespace fuzz {

// Of a list of records: the type of the records, kList.
struct FieldPlace {
  static constexpr size_t kList = ~size_t{0};
  std::type_index record = typeid(void);
  size_t offset = 0;
  friend bool operator==(const FieldPlace&, const FieldPlace&) = default;
};

template <class T>
inline constexpr bool kIsRecord = std::is_class_v<T> && !std::is_same_v<T, std::string>;
template <class Tag>
inline constexpr bool kIsRecord<base::Id<Tag>> = false;

template <class Visitor>
class ImageWalk {
 public:
  ImageWalk(Visitor& visitor, ir::Image& image) : visitor_(visitor) { enter(image); }

  template <class T>
  void operator()(T& v) {
    visitor_.field(place_of(v), v);
  }
  template <class E>
  void enumerator(E& v, uint32_t limit) {
    visitor_.enumerator(place_of(v), v, limit);
  }
  template <class L, class U>
  void enumerators(L& lower, uint32_t lower_limit, U& upper, uint32_t upper_limit) {
    enumerator(lower, lower_limit);
    enumerator(upper, upper_limit);
  }
  template <class E>
  void last_enumerator(E& v, uint32_t limit) {
    enumerator(v, limit);
  }
  template <class T, class Each>
  void last_list(base::SharedVector<T>& v, size_t min_size, Each&& each) {
    last_list(v.own(), min_size, each);
  }
  template <class T, class Each>
  void last_list(std::vector<T>& v, size_t min_size, Each&& each) {
    list(v, min_size, each);
  }
  template <class T, class Each>
  void list(std::vector<T>& v, size_t, Each&& each) {
    const ImageWalk outside = *this;
    const FieldPlace whole = kIsRecord<T> ? FieldPlace{typeid(T), FieldPlace::kList} : place_of(v);
    visitor_.list(whole, v);
    for (T& item : v) {
      if constexpr (kIsRecord<T>) {
        enter(item);
      } else {
        items_of_ = whole;
        is_item_ = true;
      }
      each(item);
    }
    enter_again(outside);
  }
  template <class T, class Each>
  void list(base::SharedVector<T>& v, size_t min_size, Each&& each) {
    list(v.own(), min_size, each);
  }
  template <class List>
  void plain_list(List& v) {
    list(v, 1, [&](auto& item) { plain(item); });
  }
  template <class V>
  bool shares(V&, const V&, base::ByteSpan) {
    return false;
  }
  size_t at() const { return 0; }
  void text_bytes(std::string& v) { (*this)(v); }

  // The table that interns types, and that of initial values, do not give their rows away.
  void types(ir::TypeTable& types) {
    const ImageWalk outside = *this;
    std::vector<std::string> old_names = types.old_names();
    items_of_ = {typeid(ir::TypeTable), 0};
    visitor_.list(items_of_, old_names);
    is_item_ = true;
    for (std::string& name : old_names) (*this)(name);
    types.set_old_names(std::move(old_names));
    for (uint32_t i = ir::kElementaryCount; i < types.size(); ++i) {
      ir::Type& type = types.edit(ir::TypeId(i));
      enter(type);
      type_fields(*this, type);
    }
    enter_again(outside);
  }
  void constants(ir::ConstTable& constants) {
    std::vector<ir::ConstValue> values;
    for (uint32_t i = 0; i < constants.size(); ++i) values.push_back(constants[ir::ConstId(i)]);
    list(values, 16, [&](auto& value) { constant_fields(*this, value); });
    constants = {};
    for (ir::ConstValue& value : values) constants.add(std::move(value));
  }

 private:
  template <class T>
  void enter(T& record) {
    record_ = typeid(T);
    begin_ = reinterpret_cast<const char*>(&record);
    size_ = sizeof(T);
    is_item_ = false;
  }
  void enter_again(const ImageWalk& outside) {
    record_ = outside.record_;
    begin_ = outside.begin_;
    size_ = outside.size_;
    items_of_ = outside.items_of_;
    is_item_ = outside.is_item_;
  }
  template <class T>
  FieldPlace place_of(const T& v) const {
    if (is_item_) return items_of_;
    const auto offset = static_cast<size_t>(reinterpret_cast<const char*>(&v) - begin_);
    base::check(offset < size_, "a field is a part of the record that is visited");
    return {record_, offset};
  }

  void plain(ir::Unit& v) {
    (*this)(v.op);
    (*this)(v.a);
    (*this)(v.b);
    (*this)(v.c);
    static_assert(sizeof v == 8);
  }
  void plain(ir::LineEntry& v) {
    (*this)(v.unit);
    (*this)(v.line);
    static_assert(sizeof v == 8);
  }
  template <class T>
  void plain(T& v) {
    static_assert(std::is_integral_v<T>, "a record that is stored as it lies in memory: its fields");
    (*this)(v);
  }

  Visitor& visitor_;
  std::type_index record_ = typeid(void);
  const char* begin_ = nullptr;
  size_t size_ = 0;
  bool is_item_ = false;  // of a list whose items are no records
  FieldPlace items_of_;
};

template <class Visitor>
void types_section(ImageWalk<Visitor>& walk, ir::TypeTable& types) {
  walk.types(types);
}
template <class Visitor>
void constants_section(ImageWalk<Visitor>& walk, ir::ConstTable& constants) {
  walk.constants(constants);
}

template <class Visitor>
void walk_section(Visitor& visitor, ir::Image& image, uint32_t number) {
  ImageWalk<Visitor> walk(visitor, image);
  ir::ImagePlaces places;
  ir::section(walk, image, number, ir::Beside{nullptr, places});
}

template <class Visitor>
void walk_image(Visitor& visitor, ir::Image& image) {
  for (uint32_t number = 0; number < ir::kImageSectionCount; ++number) walk_section(visitor, image, number);
}

}  // namespace fuzz
