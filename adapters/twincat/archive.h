// <XmlArchive>: what an editor of TwinCAT keeps, as objects with members. An object is <o
// t="Type">; its members have their names in `n` and are values <v>, objects <o> or lists <l2>; <n>
// says that there is none. A list says the type of its items once, in `cet`, and an item with
// another one in its own `t`. Texts stand in quotes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "adapters/xml/document.h"

namespace twincat {

struct Item {
  xml::Node node;
  std::string_view type;  // empty: none, <n>; "?": it says none, or is no object
  explicit operator bool() const { return !type.empty(); }
};

// The only one of `type`, anywhere below; empty: there is none, or there are several.
xml::Node find_object(xml::Node archive, std::string_view type);
xml::Node member(xml::Node object, std::string_view name);  // empty: none
Item object_member(xml::Node object, std::string_view name);
std::string member_text(xml::Node object, std::string_view name);  // of <v>; "" where there is none
bool is_true(xml::Node object, std::string_view name);
std::vector<Item> items(xml::Node object, std::string_view list);
std::vector<std::string> texts(xml::Node object, std::string_view list);

// The member `Flags`, an object with a number. A coil that resets is kNegation and kSet.
enum Flag : uint32_t {
  kNegation = 1,
  kSet = 2,
  kJump = 4,
  kReturn = 8,
  kRising = 16,
  kFalling = 32,
};
// kUnreadable: no number, or a larger one.
inline constexpr uint32_t kUnreadable = ~0u;
uint32_t flags_of(xml::Node object);

// What of the objects below has no meaning: two members of one name, a list of other things than
// objects and texts. Empty: nothing.
struct ArchiveProblem {
  xml::Node node;
  std::string text;
};
ArchiveProblem archive_problem(xml::Node object);

}  // namespace twincat
