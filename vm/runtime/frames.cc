#include "vm/runtime/frames.h"

#include <algorithm>
#include <cstring>

namespace vm {
namespace {

constexpr size_t kLengthBytes = 4;

}  // namespace

base::Bytes frame(base::ByteSpan message) {
  base::Bytes out(kLengthBytes + message.size());
  auto length = static_cast<uint32_t>(message.size());
  std::memcpy(out.data(), &length, sizeof length);
  std::copy(message.begin(), message.end(), out.begin() + kLengthBytes);
  return out;
}

size_t FrameReader::room() const { return kLengthBytes + kMaxMessageBytes - buffer_.size(); }

void FrameReader::add(base::ByteSpan bytes) {
  base::check(bytes.size() <= room(), "a frame reader gets more than it has room for");
  buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
}

std::optional<base::Bytes> FrameReader::next() {
  if (broken_ || buffer_.size() < kLengthBytes) return std::nullopt;
  size_t length = base::ByteReader(buffer_).u32();
  if (length > kMaxMessageBytes) {
    broken_ = true;
    return std::nullopt;
  }
  if (buffer_.size() - kLengthBytes < length) return std::nullopt;
  auto begin = buffer_.begin() + kLengthBytes;
  auto end = begin + static_cast<std::ptrdiff_t>(length);
  base::Bytes message(begin, end);
  buffer_.erase(buffer_.begin(), end);
  if (buffer_.empty()) buffer_ = base::Bytes();  // who is idle holds no room either
  return message;
}

}  // namespace vm
