// SlimVector<T>: a vector that is one pointer large while it is empty, for lists that most owners
// do not have. It owns its elements. Growing moves them: references into it are valid until then.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <new>
#include <utility>

namespace base {

template <class T>
class SlimVector {
 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  SlimVector() = default;
  SlimVector(std::initializer_list<T> values) { append(values.begin(), values.size()); }
  SlimVector(const SlimVector& other) { append(other.begin(), other.size()); }
  SlimVector(SlimVector&& other) noexcept : list_(std::exchange(other.list_, nullptr)) {}
  ~SlimVector() { release(); }
  SlimVector& operator=(SlimVector other) noexcept {
    std::swap(list_, other.list_);
    return *this;
  }

  size_t size() const { return list_ == nullptr ? 0 : list_->size; }
  bool empty() const { return size() == 0; }
  T* begin() { return elements(list_); }
  T* end() { return begin() + size(); }
  const T* begin() const { return elements(list_); }
  const T* end() const { return begin() + size(); }
  T& operator[](size_t i) { return begin()[i]; }
  const T& operator[](size_t i) const { return begin()[i]; }

  void push_back(T value) {
    reserve(size() + 1);
    new (end()) T(std::move(value));
    ++list_->size;
  }
  void reserve(size_t wanted) {
    const size_t capacity = list_ == nullptr ? 0 : list_->capacity;
    if (wanted <= capacity) return;
    const size_t larger = std::max(wanted, capacity * 2);
    List* const made = new (::operator new(sizeof(List) + larger * sizeof(T))) List;
    std::uninitialized_move(begin(), end(), elements(made));
    made->size = static_cast<uint32_t>(size());
    made->capacity = static_cast<uint32_t>(larger);
    release();
    list_ = made;
  }
  void clear() {
    release();
    list_ = nullptr;
  }

 private:
  // In front of its elements.
  struct alignas(std::max(alignof(T), alignof(uint64_t))) List {
    uint32_t size = 0;
    uint32_t capacity = 0;
  };

  static T* elements(List* list) {
    return list == nullptr ? nullptr : reinterpret_cast<T*>(list + 1);
  }
  void append(const T* values, size_t count) {
    if (count == 0) return;
    reserve(count);
    std::uninitialized_copy_n(values, count, begin());
    list_->size = static_cast<uint32_t>(count);
  }
  void release() {
    if (list_ == nullptr) return;
    std::destroy(begin(), end());
    const size_t bytes = sizeof(List) + list_->capacity * sizeof(T);
    ::operator delete(list_, bytes);
  }

  List* list_ = nullptr;
};

}  // namespace base
