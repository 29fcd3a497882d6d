// Length-prefixed frames over a byte stream: u32 length, then that many bytes. The reader takes
// bytes as they come and never holds more than one frame of at most kMaxMessageBytes.
#pragma once

#include <optional>

#include "vm/runtime/protocol.h"

namespace vm {

base::Bytes frame(base::ByteSpan message);

class FrameReader {
 public:
  // How many bytes may be added now.
  size_t room() const;
  void add(base::ByteSpan bytes);
  // A complete message, once; nullopt while there is none.
  std::optional<base::Bytes> next();
  // A length that no message has: the stream cannot be read any further.
  bool broken() const { return broken_; }
  bool empty() const { return buffer_.empty(); }

 private:
  base::Bytes buffer_;
  bool broken_ = false;
};

}  // namespace vm
