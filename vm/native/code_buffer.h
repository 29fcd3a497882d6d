// Bytes of machine code with labels in them: what the assemblers of all machines share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace vm::native {

using Label = uint32_t;

class CodeBuffer {
 public:
  const std::vector<uint8_t>& code() const { return code_; }
  void reserve(size_t bytes) { code_.reserve(bytes); }
  uint32_t here() const { return static_cast<uint32_t>(code_.size()); }

  Label label() {
    labels_.push_back(kUnbound);
    return static_cast<Label>(labels_.size() - 1);
  }
  void bind(Label label) { labels_[label] = here(); }
  bool is_bound(Label label) const { return labels_[label] != kUnbound; }
  uint32_t offset_of(Label label) const { return labels_[label]; }
  size_t labels() const { return labels_.size(); }
  // For patched code: labels from number `first` on are given out anew.
  void forget_labels(size_t first) { labels_.resize(first); }

 protected:
  CodeBuffer() = default;
  ~CodeBuffer() = default;

  std::vector<uint8_t> code_;

 private:
  static constexpr uint32_t kUnbound = 0xffffffff;
  std::vector<uint32_t> labels_;
};

}  // namespace vm::native
