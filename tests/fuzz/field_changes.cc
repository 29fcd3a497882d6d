#include "tests/fuzz/field_changes.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <string>

namespace fuzz {
namespace {

constexpr size_t kLongest = 300;  // of a string or list that grows

class Counter {
 public:
  explicit Counter(std::vector<ImageField>& fields) : fields_(fields) {}
  void begin(uint32_t section) { section_ = section; }
  template <class T>
  void field(const FieldPlace& place, T&) {
    count(place);
  }
  template <class E>
  void enumerator(const FieldPlace& place, E&, uint32_t) {
    count(place);
  }
  template <class T>
  void list(const FieldPlace& place, std::vector<T>&) {
    count(place);
  }

 private:
  // Fields of one record come one behind the other, so the next one is mostly that of last time.
  void count(const FieldPlace& place) {
    for (size_t tried = 0; tried < fields_.size(); ++tried, next_ = (next_ + 1) % fields_.size()) {
      if (fields_[next_].place != place) continue;
      ++fields_[next_].count;
      next_ = (next_ + 1) % fields_.size();
      return;
    }
    fields_.push_back({place, section_, 1});
    next_ = 0;
  }

  std::vector<ImageField>& fields_;
  uint32_t section_ = 0;
  size_t next_ = 0;
};

// What the same field of another record holds.
struct Other {
  uint64_t number = 0;
  std::string text;
};

template <class T>
void alter_number(T& v, const FieldChange& change, uint64_t limit, const Other& other) {
  auto wide = static_cast<uint64_t>(v);
  const uint64_t highest = std::numeric_limits<T>::max();
  const uint64_t ends[] = {0,       1,           highest,    highest - 1,
                           highest / 2, highest / 2 + 1, 0x0fffffff, uint64_t{1} << 31};
  switch (change.how % 8) {
    case 0:
      wide = change.value % 80;
      break;
    case 1:
      wide ^= uint64_t{1} << change.value % (8 * sizeof v);
      break;
    case 2:
      wide += 1 + change.value % 9;
      break;
    case 3:
      wide -= 1 + change.value % 9;
      break;
    case 4:
      wide = ends[change.value % 8];
      break;
    case 5:
      wide = change.value;
      break;
    default:
      wide = other.number;
  }
  v = static_cast<T>(limit == 0 ? wide : wide % (limit + 1));
}

void alter_text(std::string& v, const FieldChange& change, const Other& other) {
  constexpr char kOdd[] = {'\x1b', '.', '[', '\'', '\xff', ' ', '^', '\0'};
  switch (change.how % 8) {
    case 0:
      return v.clear();
    case 1:
      return v.resize(change.value % kLongest, 'x');
    case 2:
      v.insert(v.size() - std::min<size_t>(v.size(), change.value / 8 % 4), 1,
               kOdd[change.value % 8]);
      return;
    case 3:
      if (!v.empty()) v[change.value / 8 % v.size()] ^= static_cast<char>(1 << change.value % 8);
      return;
    default:
      v = other.text;
  }
}

template <class T>
void alter_list(std::vector<T>& v, const FieldChange& change) {
  const size_t at = v.empty() ? 0 : change.value % v.size();
  const auto place = v.begin() + static_cast<std::ptrdiff_t>(at);
  switch (v.empty() ? 0 : change.how % 6) {
    case 0:
      if (v.size() < kLongest) v.emplace_back();
      return;
    case 1:
      v.erase(place);
      return;
    case 2: {
      const T copy = *place;
      v.push_back(copy);
      return;
    }
    case 3:
      std::swap(v[at], v[change.how / 8 % v.size()]);
      return;
    case 4: {
      const T copy = v[change.how / 8 % v.size()];
      v[at] = copy;
      return;
    }
    default:
      v.erase(place, v.end());
  }
}

// Does it to the record of that number, or only looks at it.
class Changer {
 public:
  Changer(const FieldPlace& place, uint32_t number, const FieldChange& change, Other& other,
          bool look)
      : place_(place), left_(number), change_(change), other_(other), look_(look) {}

  template <class T>
  void field(const FieldPlace& place, T& v) {
    if (is_it(place)) alter(v);
  }
  template <class E>
  void enumerator(const FieldPlace& place, E& v, uint32_t limit) {
    if (!is_it(place)) return;
    auto number = static_cast<uint8_t>(v);
    if (look_) return void(other_.number = number);
    alter_number(number, change_, limit, other_);
    v = static_cast<E>(number);
  }
  template <class T>
  void list(const FieldPlace& place, std::vector<T>& v) {
    const bool whole = kIsRecord<T> || change_.how / 8 % 2 == 0;  // else its items are changed
    if (whole && !look_ && is_it(place)) alter_list(v, change_);
  }

 private:
  bool is_it(const FieldPlace& place) { return place == place_ && left_-- == 0; }

  void alter(bool& v) { v = v == look_; }
  void alter(std::string& v) {
    if (look_) return void(other_.text = v);
    alter_text(v, change_, other_);
  }
  void alter(base::Bytes& v) {
    if (look_) return;
    if (change_.how % 4 == 0 || v.empty()) return alter_list(v, change_);
    alter_number(v[change_.which / 8 % v.size()], change_, 0, other_);
  }
  void alter(base::Digest& v) {
    if (!look_) v[change_.value % v.size()] ^= 1;
  }
  template <class Tag>
  void alter(base::Id<Tag>& v) {
    alter(v.index);
  }
  template <class T>
  void alter(T& v) {
    if (look_) return void(other_.number = static_cast<uint64_t>(v));
    alter_number(v, change_, 0, other_);
  }

  const FieldPlace& place_;
  uint32_t left_;
  const FieldChange& change_;
  Other& other_;
  bool look_;
};

}  // namespace

std::vector<ImageField> fields_of(ir::Image image) {
  std::vector<ImageField> fields;
  Counter counter(fields);
  for (uint32_t number = 0; number < ir::kImageSectionCount; ++number) {
    counter.begin(number);
    walk_section(counter, image, number);
  }
  return fields;
}

// Mixed, so that similar scripts are about different fields.
FieldChange::FieldChange(const uint8_t* bytes, uint64_t number) {
  uint64_t all = 0;
  std::memcpy(&all, bytes, sizeof all);
  all += 0x9E3779B97F4A7C15u * (number + 1);
  all = (all ^ (all >> 30)) * 0xBF58476D1CE4E5B9u;
  all = (all ^ (all >> 27)) * 0x94D049BB133111EBu;
  all ^= all >> 31;
  field = static_cast<uint16_t>(all);
  which = static_cast<uint16_t>(all >> 16);
  value = static_cast<uint16_t>(all >> 32);
  how = static_cast<uint16_t>(all >> 48);
}

void apply(ir::Image& image, const std::vector<ImageField>& fields, const FieldChange& change) {
  const ImageField& field = fields[change.field % fields.size()];
  Other other;
  Changer look(field.place, change.value % field.count, change, other, true);
  walk_section(look, image, field.section);
  Changer changer(field.place, change.which % field.count, change, other, false);
  walk_section(changer, image, field.section);
}

}  // namespace fuzz
