// InlineVector<T, N>: a vector whose first N elements lie in the object itself, for short lists of
// plain values of which there are very many. It owns its elements. As with std::vector, growing
// moves them: references into it are valid until then. At most 2^31 elements.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <memory>
#include <span>
#include <type_traits>

namespace base {

template <class T, uint32_t N>
class InlineVector {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
  static_assert(N > 0);

 public:
  using value_type = T;
  using iterator = T*;
  using const_iterator = const T*;

  InlineVector() noexcept {}
  InlineVector(std::initializer_list<T> values) { append(values.begin(), values.size()); }
  // NOLINTNEXTLINE: lists are made of all kinds of lists.
  InlineVector(std::span<const T> values) { append(values.data(), values.size()); }
  InlineVector(const InlineVector& other) { append(other.data(), other.size_); }
  InlineVector(InlineVector&& other) noexcept { take(other); }
  ~InlineVector() { release(); }

  InlineVector& operator=(const InlineVector& other) {
    if (this == &other) return *this;
    size_ = 0;
    append(other.data(), other.size_);
    return *this;
  }
  InlineVector& operator=(InlineVector&& other) noexcept {
    if (this == &other) return *this;
    release();
    take(other);
    return *this;
  }
  InlineVector& operator=(std::initializer_list<T> values) {
    size_ = 0;
    append(values.begin(), values.size());
    return *this;
  }

  size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  T* data() { return in_place() ? inline_ : heap_; }
  const T* data() const { return in_place() ? inline_ : heap_; }
  T* begin() { return data(); }
  T* end() { return data() + size_; }
  const T* begin() const { return data(); }
  const T* end() const { return data() + size_; }
  T& operator[](size_t i) { return data()[i]; }
  const T& operator[](size_t i) const { return data()[i]; }
  T& front() { return data()[0]; }
  const T& front() const { return data()[0]; }
  T& back() { return data()[size_ - 1]; }
  const T& back() const { return data()[size_ - 1]; }

  void push_back(T value) {
    if (size_ == capacity_) grow(size_t{size_} + 1);
    data()[size_++] = value;
  }
  T& emplace_back() {
    push_back(T());
    return back();
  }
  void pop_back() { --size_; }
  void clear() { size_ = 0; }
  // `count` may be more than size(): new elements are T().
  void resize(size_t count) {
    if (count > capacity_) grow(count);
    for (size_t i = size_; i < count; ++i) data()[i] = T();
    size_ = static_cast<uint32_t>(count);
  }
  // Before `at`. The values must not be of this list.
  void insert(const T* at, std::span<const T> values) {
    const size_t front = static_cast<size_t>(at - data());
    append(values.data(), values.size());
    std::rotate(begin() + front, end() - values.size(), end());
  }
  void insert(const T* at, T value) { insert(at, std::span<const T>(&value, 1)); }

  friend bool operator==(const InlineVector& a, const InlineVector& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  }

 private:
  bool in_place() const { return capacity_ == N; }

  void append(const T* values, size_t count) {
    if (count == 0) return;
    if (size_ + count > capacity_) grow(size_ + count);
    std::memcpy(static_cast<void*>(data() + size_), values, count * sizeof(T));
    size_ += static_cast<uint32_t>(count);
  }
  void grow(size_t wanted) {
    const size_t capacity = std::max<size_t>(wanted, size_t{capacity_} * 2);
    T* const made = std::allocator<T>().allocate(capacity);
    std::memcpy(static_cast<void*>(made), data(), size_ * sizeof(T));
    release();
    heap_ = made;
    capacity_ = static_cast<uint32_t>(capacity);
  }
  void release() {
    if (!in_place()) std::allocator<T>().deallocate(heap_, capacity_);
  }
  void take(InlineVector& other) {
    std::memcpy(static_cast<void*>(this), &other, sizeof *this);
    other.size_ = 0;
    other.capacity_ = N;
  }

  uint32_t size_ = 0;
  uint32_t capacity_ = N;  // N: the elements are in place
  union {
    T inline_[N];
    T* heap_;
  };
};

}  // namespace base
