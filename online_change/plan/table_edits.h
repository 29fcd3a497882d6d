// The restricted table (E-16 to E-18): what an edit does to variables that were there before. The
// *table* is all that has one place for as long as the program runs and that others know by name:
// every global variable (VAR_GLOBAL anywhere, of CONFIGURATION and RESOURCE too), the variables of
// each program instance, and the addresses that VAR_CONFIG gives. Variables of function blocks are
// no part of it: they belong to their unit, and so do steps and actions of charts. Restricted, a
// table takes additions only.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "ir/bytecode/image.h"

namespace online_change {

enum class TableChange : uint8_t {
  kRemoved,   // a variable, or a program with all of its own
  kOrder,     // one that stood in front of it stands after it now
  kType,      // or what is inside of it: a structure's members, an array's bounds
  kInitial,   //
  kRetain,    //
  kConstant,  //
  kAddress,   // %QX0.0
};
inline constexpr uint32_t kTableChangeCount = 7;
// "type", as people and JSON say it.
const char* table_change_name(TableChange change);

struct TableEdit {
  TableChange change = TableChange::kType;
  std::string path;     // "Main.speed", "level"; "Main" where the program is meant as a whole
  std::string program;  // the instance; "" of a global
  std::string what;     // "type INT -> DINT", "removed"
  // Where it stood: the path of the variable in front of it there that is in both; "": none is.
  std::string after;
};

enum class TableSide : uint8_t {
  kBefore,  // what an edit was made on: whatever is no longer there is removed
  // A controller's own: what it alone has stays there (E-18), and its programs are compared as
  // parts (E-11).
  kOwn,
};
// In the order of the table that was there, globals first. Both images are verified; the names are
// those of `before`. O(n log n).
std::vector<TableEdit> table_edits(const ir::Image& before, const ir::Image& after, TableSide side);

// kTableEdit: the text names the first difference and all others, up to a bound. `what` says whose
// table it is.
base::Status check_table(const std::vector<TableEdit>& edits, std::string_view what);
// "`Main.speed`: type INT -> DINT; `kept`: removed; and 3 more".
std::string table_edits_text(const std::vector<TableEdit>& edits);

}  // namespace online_change
