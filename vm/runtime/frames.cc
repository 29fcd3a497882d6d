#include "vm/runtime/frames.h"

namespace vm {
namespace {

constexpr size_t kLengthBytes = 4;

}  // namespace

base::Bytes frame(base::ByteSpan message) {
  base::ByteWriter writer;
  writer.blob(message);
  return writer.take();
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
  return message;
}

}  // namespace vm
