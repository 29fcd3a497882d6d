#include "tools/stvm/agent_files.h"

#include <algorithm>
#include <charconv>

#include "tools/common/child.h"
#include "tools/common/files.h"
#include "tools/stvm/agent_answer.h"

namespace stvm {

AgentPieces::AgentPieces(const AgentFile& file) : file_(file) {
  const uint64_t size = std::min(file.size, kMostAgentFile);
  left_ = static_cast<size_t>((size + kAgentPiece - 1) / kAgentPiece);
  bytes_.resize(static_cast<size_t>(size));
  here_.assign(left_, false);
}

bool AgentPieces::add(std::string_view number, base::ByteSpan bytes) {
  size_t at = 0;
  const char* const end = number.data() + number.size();
  const auto read = std::from_chars(number.data(), end, at);
  if (read.ec != std::errc() || read.ptr != end || at >= here_.size() || here_[at]) return false;
  const size_t begin = at * kAgentPiece;
  if (bytes.size() != std::min<size_t>(kAgentPiece, bytes_.size() - begin)) return false;
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<ptrdiff_t>(begin));
  here_[at] = true;
  --left_;
  return true;
}

base::Result<base::Bytes> AgentPieces::take() {
  if (base::sha256(bytes_) == file_.digest) return std::move(bytes_);
  return base::Error{base::Refusal::kBadHash,
                     "file " + base::short_hex(file_.digest) + " came with another content"};
}

base::Result<base::Bytes> fetch_file(const std::string& url, uint64_t size) {
  constexpr std::string_view kFile = "file://";
  if (url.starts_with(kFile)) return tools::read_bytes(url.substr(kFile.size()), size);
  if (!url.starts_with("https://")) {
    return base::Error{base::Refusal::kUsage, url + ": only https and file are taken"};
  }
  base::Result<tools::TemporaryFolder> folder = tools::TemporaryFolder::make();
  if (!folder.ok()) return folder.error();
  const std::string file = folder->file("file");
  base::Result<tools::ConnectedChild> curl = tools::ConnectedChild::start(
      {"curl", "--fail", "--silent", "--show-error", "--proto", "=https", "--max-time", "600",
       "--max-filesize", std::to_string(size), "--output", file, "--", url},
      tools::ConnectedChild::Errors::kVisible);
  if (!curl.ok()) return curl.error();
  if (const int code = curl->wait(); code != 0) {
    return base::Error{
        base::Refusal::kFileUnreadable,
        url + ": curl says " + std::to_string(code) + " (`man curl`; 127: it is not installed)"};
  }
  return tools::read_bytes(file, size);
}

}  // namespace stvm
