#include "tools/stc/map_entry.h"

#include <charconv>

#include "ir/types/address_text.h"

namespace stc {
namespace {

class EntryParser {
 public:
  EntryParser(std::string_view text, ir::DeviceMapping& mapping) : text_(text), mapping_(mapping) {}

  std::optional<MapFault> parse() {
    table() && points() && arrow() && address();
    return std::move(fault_);
  }

 private:
  bool fail(size_t at, std::string text) {
    fault_ = MapFault{at, std::move(text)};
    return false;
  }
  void blanks() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
  }
  std::string_view word() {
    const size_t begin = at_;
    while (at_ < text_.size() && text_[at_] >= 'a' && text_[at_] <= 'z') ++at_;
    return text_.substr(begin, at_ - begin);
  }

  bool table() {
    blanks();
    const size_t begin = at_;
    const std::string_view name = word();
    std::string known;
    for (const ir::TableRow& row : ir::table_rows()) {
      if (row.name == name) {
        mapping_.table = row.id;
        return true;
      }
      known += (known.empty() ? "`" : ", `") + std::string(row.name) + "`";
    }
    return fail(begin, "expected one of " + known + ", as in \"coil 0..15 <- %QX0.0\"");
  }

  bool number(uint32_t& value) {
    blanks();
    const char* begin = text_.data() + at_;
    const auto [end, code] = std::from_chars(begin, text_.data() + text_.size(), value);
    if (code != std::errc() || end == begin) return fail(at_, "expected the number of a point");
    at_ += static_cast<size_t>(end - begin);
    return true;
  }

  bool points() {
    uint32_t last = 0;
    if (!number(mapping_.first)) return false;
    last = mapping_.first;
    const size_t begin = at_;
    blanks();
    if (text_.substr(at_).starts_with("..")) {
      at_ += 2;
      if (!number(last)) return false;
    }
    if (last < mapping_.first) return fail(begin, "the last point comes before the first");
    if (last - mapping_.first == UINT32_MAX) return fail(begin, "too many points");
    mapping_.count = last - mapping_.first + 1;
    return true;
  }

  bool arrow() {
    blanks();
    if (text_.substr(at_).starts_with("<->")) {
      mapping_.to_device = mapping_.writable = true;
      at_ += 3;
      return true;
    }
    const std::string_view sign = text_.substr(at_, 2);
    if (sign != "->" && sign != "<-") {
      return fail(at_, "expected `->` (into the program) or `<-` (to the device)");
    }
    mapping_.to_device = sign == "<-";
    at_ += 2;
    return true;
  }

  bool address() {
    blanks();
    std::string_view rest = text_.substr(at_);
    while (rest.ends_with(' ')) rest.remove_suffix(1);
    const std::optional<ir::DirectAddress> address = ir::parse_address(rest);
    if (!address) return fail(at_, "expected an address: %IX0.0, %IW2, %QD4");
    mapping_.at = *address;
    return true;
  }

  std::string_view text_;
  ir::DeviceMapping& mapping_;
  size_t at_ = 0;
  std::optional<MapFault> fault_;
};

}  // namespace

std::optional<MapFault> parse_map_entry(std::string_view text, ir::DeviceMapping& mapping) {
  return EntryParser(text, mapping).parse();
}

}  // namespace stc
