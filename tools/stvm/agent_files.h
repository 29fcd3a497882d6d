// A file that comes in pieces over a broker that nobody trusts: its size and hash are known before,
// from a signed order, so nothing is kept that does not belong to it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tools/stvm/agent_order.h"

namespace stvm {

class AgentPieces {
 public:
  AgentPieces() = default;
  // Of at most kMostAgentFile bytes.
  explicit AgentPieces(const AgentFile& file);
  const AgentFile& file() const { return file_; }
  // One piece, by the number that its topic ends with. False: it is none of these, or here already.
  bool add(std::string_view number, base::ByteSpan bytes);
  bool whole() const { return left_ == 0; }
  // Once it is whole; kBadHash.
  base::Result<base::Bytes> take();

 private:
  AgentFile file_;
  base::Bytes bytes_;
  std::vector<bool> here_;
  size_t left_ = 0;
};

// From "file:///folder/..." or, by curl, "https://...". The caller checks the hash. kUsage: another
// URL; kFileNotFound, kFileUnreadable.
base::Result<base::Bytes> fetch_file(const std::string& url, uint64_t size);

}  // namespace stvm
