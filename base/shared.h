// Values whose copies are one in memory until one of them is changed: versions of a program have
// most of their tables in common. A change takes a copy first, if there are others who hold the
// value. Copies may be read and dropped on several threads; one object, as any other, is changed on
// one thread while nobody else uses it.
#pragma once

#include <atomic>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace base {

// Nobody else holds it, and whoever did has read it before.
template <class T>
bool is_alone(const std::shared_ptr<T>& value) {
  if (value.use_count() != 1) return false;
  std::atomic_thread_fence(std::memory_order_acquire);
  return true;
}

template <class T>
class Shared {
 public:
  Shared() : value_(std::make_shared<T>()) {}
  Shared(T value) : value_(std::make_shared<T>(std::move(value))) {}  // NOLINT: as good as one
  // Moved from, it is as good as a copy.
  Shared(const Shared&) = default;
  Shared& operator=(const Shared&) = default;

  operator const T&() const { return *value_; }  // NOLINT: that is what it is
  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  template <class Index>
  const auto& operator[](const Index& i) const {
    return (*value_)[i];
  }
  auto size() const { return value_->size(); }
  template <class Index>
  bool contains(const Index& i) const {
    return value_->contains(i);
  }
  // To be changed.
  T& own() {
    if (!is_alone(value_)) value_ = std::make_shared<T>(*value_);
    return *value_;
  }
  // Are they one, and so equal? False says nothing.
  bool is_one_with(const Shared& other) const { return value_ == other.value_; }

 private:
  std::shared_ptr<T> value_;
};

// The same of a vector: used as one. What is not const takes a copy first, as own() does.
template <class T>
class SharedVector {
 public:
  using value_type = T;
  using iterator = typename std::vector<T>::iterator;
  using const_iterator = typename std::vector<T>::const_iterator;

  SharedVector() = default;
  SharedVector(std::vector<T> all) {  // NOLINT: as good as one
    if (!all.empty()) all_ = std::make_shared<std::vector<T>>(std::move(all));
  }
  SharedVector(std::initializer_list<T> all) : SharedVector(std::vector<T>(all)) {}

  const std::vector<T>& all() const { return all_ == nullptr ? none() : *all_; }
  operator const std::vector<T>&() const { return all(); }  // NOLINT: that is what it is
  size_t size() const { return all().size(); }
  bool empty() const { return all().empty(); }
  const T* data() const { return all().data(); }
  const_iterator begin() const { return all().begin(); }
  const_iterator end() const { return all().end(); }
  const T& operator[](size_t i) const { return all()[i]; }
  const T& front() const { return all().front(); }
  const T& back() const { return all().back(); }

  // To be changed.
  std::vector<T>& own() {
    if (all_ == nullptr) {
      all_ = std::make_shared<std::vector<T>>();
    } else if (!is_alone(all_)) {
      all_ = std::make_shared<std::vector<T>>(*all_);
    }
    return *all_;
  }
  T* data() { return own().data(); }
  iterator begin() { return own().begin(); }
  iterator end() { return own().end(); }
  T& operator[](size_t i) { return own()[i]; }
  T& front() { return own().front(); }
  T& back() { return own().back(); }
  void push_back(T item) { own().push_back(std::move(item)); }
  template <class... Parts>
  T& emplace_back(Parts&&... parts) {
    return own().emplace_back(std::forward<Parts>(parts)...);
  }
  void pop_back() { own().pop_back(); }
  void resize(size_t count) { own().resize(count); }
  void reserve(size_t count) { own().reserve(count); }
  void clear() { all_.reset(); }
  iterator erase(const_iterator at) { return own().erase(at); }
  iterator erase(const_iterator first, const_iterator last) { return own().erase(first, last); }
  iterator insert(const_iterator at, T item) { return own().insert(at, std::move(item)); }

  // Are they one, and so equal? False says nothing.
  bool is_one_with(const SharedVector& other) const { return all_ == other.all_; }

 private:
  static const std::vector<T>& none() {
    static const std::vector<T> kNone;
    return kNone;
  }

  std::shared_ptr<std::vector<T>> all_;  // null: empty
};

}  // namespace base
