#include "adapters/xml/document.h"

#include "base/diagnostics_render.h"
#include "base/limits.h"

namespace xml {
Document::Document(std::string name, std::string_view bytes, base::SourceMap& sources,
                   Imported& out) {
  if (bytes.size() > base::kMaxXmlBytes) {
    begin_ = sources.add(std::move(name), {}, base::TextUse::kQuoted);
    out.findings.push_back({Code::kXmlLimit,
                            {begin_, begin_},
                            {},
                            0,
                            std::to_string(bytes.size()) + " bytes; the limit is " +
                                std::to_string(base::kMaxXmlBytes),
                            {}});
    return;
  }
  Decoded decoded = to_utf8(bytes);
  const uint32_t file = sources.file_count();
  begin_ = sources.add(std::move(name), std::move(decoded.text), base::TextUse::kQuoted);
  size_ = sources.text(file).size();
  if (!decoded.error.empty()) {
    out.findings.push_back({Code::kBadXml, {begin_, begin_}, {}, 0, decoded.error, {}});
    return;
  }
  if (!parse(std::string(sources.text(file)), out) || !within_depth(out)) return;
  root_ = parsed_.document_element();
}

bool Document::parse(const std::string& text, Imported& out) {
  pugi::xml_parse_result result =
      parsed_.load_buffer(text.data(), text.size(), kAsRead, pugi::encoding_utf8);
  const bool rooted = static_cast<bool>(parsed_.document_element());
  if (result && rooted) return true;
  const size_t at = result ? 0 : static_cast<size_t>(result.offset);
  base::SourcePos place{begin_.offset + static_cast<uint32_t>(std::min(at, size_))};
  std::string what = result ? "the document has no element" : result.description();
  out.findings.push_back({Code::kBadXml, {place, place}, {}, 0, std::move(what), {}});
  return false;
}

// Walks without recursion; everybody after may recurse.
bool Document::within_depth(Imported& out) {
  uint32_t depth = 0;
  Node node = parsed_;
  while (node) {
    if (Node below = node.first_child(); below && depth <= base::kMaxXmlDepth) {
      node = below;
      ++depth;
    } else {
      while (node && !node.next_sibling()) {
        node = node.parent();
        --depth;
      }
      if (node) node = node.next_sibling();
    }
    // Text in the deepest element is no level of its own.
    if (depth > base::kMaxXmlDepth && node.type() == pugi::node_element) {
      base::SourceSpan place = span(node);
      out.findings.push_back(
          {Code::kXmlLimit,
           place,
           {},
           0,
           "elements are nested deeper than " + std::to_string(base::kMaxXmlDepth) + " levels",
           {}});
      return false;
    }
  }
  return true;
}

base::SourceSpan Document::span(Node node) const {
  const ptrdiff_t offset = node ? node.offset_debug() : 0;
  if (offset < 0 || static_cast<size_t>(offset) > size_) return {begin_, begin_};
  base::SourcePos place{begin_.offset + static_cast<uint32_t>(offset)};
  const size_t length =
      node.type() == pugi::node_element ? std::string_view(node.name()).size() : 0;
  return {place, {place.offset + static_cast<uint32_t>(length)}};
}

Node Reporter::origin(Node node) const {
  for (Node at = node; origins_ != nullptr && at; at = at.parent()) {
    auto found = origins_->find(at.internal_object());
    if (found != origins_->end()) return found->second;
  }
  return node;
}

void Reporter::add(Code code, Node at, std::string text, std::string fix) {
  out_.add_finding(
      {code, document_.span(origin(at)), pou_, network_, std::move(text), std::move(fix)});
}

AsFbd Reporter::as_fbd(Node drawing) {
  return [this, drawing](uint32_t network, const std::string& why) {
    set_network(network);
    add(Code::kLadderAsFbd, drawing, why);
    set_network(0);
  };
}

std::string_view Reporter::required(Node node, const char* name) {
  std::string_view value = attribute(node, name);
  if (value.empty()) {
    add(Code::kXmlMissing, node,
        "<" + std::string(local_name(node)) + "> has no attribute `" + name + "`");
  }
  return value;
}

std::string_view Reporter::required_name(Node node, const char* name) {
  std::string_view value = required(node, name);
  if (value.empty() || is_name(value)) return value;
  add(Code::kXmlBadValue, node, "`" + std::string(value) + "` is no name of Structured Text",
      "rename it where the document was made");
  return {};
}

}  // namespace xml
