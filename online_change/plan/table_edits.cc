#include "online_change/plan/table_edits.h"

#include <algorithm>
#include <map>
#include <utility>

#include "base/joined.h"
#include "base/name_case.h"
#include "ir/bytecode/canonical_value.h"
#include "ir/bytecode/located_paths.h"
#include "ir/types/address_text.h"
#include "ir/types/shared_bytes.h"
#include "ir/types/value_text.h"
#include "online_change/plan/type_content.h"

namespace online_change {
namespace {

constexpr size_t kMostNamed = 200;

// What is compared of a variable, in this order; each is a text.
enum Field : uint8_t { kTypeText, kContent, kValue, kHidden, kRetained, kFixed, kPlace, kFields };
struct FieldRow {
  TableChange change;
  const char* label;
  bool shown;  // before and after, after the label
};
constexpr FieldRow kFieldRows[kFields] = {
    {TableChange::kType, "type", true},
    {TableChange::kType, "its type is another one inside", false},
    {TableChange::kInitial, "initial value", true},
    {TableChange::kInitial, "another initial value", false},
    {TableChange::kRetain, "RETAIN", true},
    {TableChange::kConstant, "CONSTANT", true},
    {TableChange::kAddress, "address", true},
};

struct TableRow {
  std::string path;
  std::string program;
  std::string fields[kFields];  // "": none

  // No variable of the table, but an address that VAR_CONFIG gives to any variable.
  bool is_address() const { return fields[kTypeText].empty(); }
  std::string key() const { return base::fold_name(path) + (is_address() ? "@" : ""); }
};

// All variables of an image that are in its table.
class TableRows {
 public:
  TableRows(const ir::Image& image, TableSide side) : image_(image), content_(image.types) {
    for (const ir::Member& member : image.types[image.globals].members) {
      // By it others reach the variables of the program, which are rows of their own.
      if (image.types[member.type].kind == ir::Kind::kProgram) continue;
      ir::is_shared(image.types, member) ? add_shared(member) : void(add(member, ""));
    }
    if (side == TableSide::kBefore) {
      for (const uint32_t id : image.program_ids()) add_program(image.instances[id]);
    }
    for (const ir::LocatedPath& row : ir::located_paths(image)) {
      std::string program = row.path.substr(0, row.path.find('.'));
      new_row(row.path, std::move(program)).fields[kPlace] = ir::address_text(row.address);
    }
  }

  std::vector<TableRow> rows;

 private:
  TableRow& new_row(std::string path, std::string program) {
    rows.push_back({std::move(path), std::move(program), {}});
    return rows.back();
  }

  void add_program(const ir::Instance& program) {
    new_row(program.name, program.name).fields[kTypeText] = image_.types.text(program.type);
    for (const ir::Member& member : image_.types[program.type].members) add(member, program.name);
  }

  // Charts and tests make variables that no source declares. False: it is one of those.
  bool add(const ir::Member& member, const std::string& program) {
    const ir::TypeTable& types = image_.types;
    const std::string type = types.text(member.type);
    if (!ir::is_listed(member) || member.name.find('#') != std::string::npos ||
        type.starts_with("__SFC_")) {
      return false;
    }
    TableRow& row = new_row(
        base::joined({program, std::string_view(".", program.empty() ? 0 : 1), member.name}),
        program);
    row.fields[kTypeText] = type;
    row.fields[kContent] = content_.of(member.type);
    if (!add_value(member, row.fields[kValue])) {
      base::ByteWriter out;
      ir::write_canonical(out, types, image_.constants, member.type, member.init);
      row.fields[kHidden].assign(out.bytes().begin(), out.bytes().end());
    }
    row.fields[kRetained] = member.retain ? "yes" : "no";
    row.fields[kFixed] = member.constant ? "yes" : "no";
    const bool placed = member.address.area != ir::DirectArea::kNone &&
                        member.address.bit_offset != ir::kOpenAddress;
    if (placed) row.fields[kPlace] = ir::address_text(member.address);
    return true;
  }

  // Variables at overlapping addresses are members of one that is hidden.
  void add_shared(const ir::Member& hidden) {
    const std::vector<ir::Member>& members = image_.types[hidden.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      if (!add(members[i], "")) continue;
      std::string* const fields = rows.back().fields;
      fields[kPlace] = ir::address_text(ir::shared_address(image_.types, hidden, i));
      if (!ir::is_shared_bit(members[i])) continue;
      fields[kTypeText] = fields[kContent] = "BOOL";
      fields[kValue] = fields[kValue] == "16#00" ? "FALSE" : "TRUE";
    }
  }

  // As a literal, where it has one; what is not said of an elementary type is zero.
  bool add_value(const ir::Member& member, std::string& text) const {
    const bool said = member.init.valid();
    const bool zero = !said && !ir::is_elementary(image_.types[member.type].kind);
    if (zero || !image_.types.is_scalar(member.type)) return false;
    const uint64_t bits = said ? image_.constants[member.init].bits : 0;
    text = ir::scalar_text(image_.types, member.type, bits);
    return true;
  }

  const ir::Image& image_;
  TypeContent content_;
};

class TableComparer {
 public:
  explicit TableComparer(const std::vector<TableRow>& after) : after_(after) {
    for (uint32_t i = 0; i < after.size(); ++i) numbers_.emplace(after[i].key(), i);
  }

  std::vector<TableEdit> run(const std::vector<TableRow>& before, TableSide side) {
    for (size_t i = 0; i < before.size(); ++i) {
      const TableRow& row = before[i];
      if (i == 0 || row.program != before[i - 1].program) begin_table();
      const TableRow* const now = find(row.key());
      if (now == nullptr) {
        if (side == TableSide::kBefore) add_gone(row);
        continue;
      }
      if (!row.is_address()) compare_place(row, *now);
      compare(row, *now);
      if (row.path != row.program) last_ = now->path;
    }
    return std::move(edits_);
  }

 private:
  const TableRow* find(const std::string& key) const {
    const auto found = numbers_.find(key);
    return found == numbers_.end() ? nullptr : &after_[found->second];
  }

  void begin_table() {
    last_.clear();
    behind_ = nullptr;
  }

  // What stood in front of it stands in front of it now.
  void compare_place(const TableRow& row, const TableRow& now) {
    if (behind_ != nullptr && &now < behind_) {
      add(TableChange::kOrder, row, base::joined({"it stood after `", behind_->path, "`"}));
    } else {
      behind_ = &now;
    }
  }

  // A program takes its variables along.
  void add_gone(const TableRow& row) {
    const bool whole = row.path == row.program;
    if (!row.program.empty() && !whole && find(base::fold_name(row.program)) == nullptr) return;
    if (row.is_address()) {
      add(TableChange::kAddress, row, base::joined({"address ", row.fields[kPlace], " -> none"}));
    } else {
      add(TableChange::kRemoved, row, whole ? "removed, with its variables" : "removed");
    }
  }

  void add(TableChange change, const TableRow& row, std::string what) {
    edits_.push_back({change, row.path, row.program, std::move(what), last_});
  }

  void compare(const TableRow& before, const TableRow& after) {
    for (uint32_t i = 0; i < kFields; ++i) {
      const std::string& was = before.fields[i];
      const std::string& is = after.fields[i];
      if (was == is) continue;
      const FieldRow& field = kFieldRows[i];
      add(field.change, before,
          field.shown ? base::joined({field.label, " ", was.empty() ? "none" : was, " -> ",
                                      is.empty() ? "none" : is})
                      : field.label);
      // Who has another type has another content and value, too.
      if (i < kHidden) i = kHidden;
    }
  }

  const std::vector<TableRow>& after_;
  std::map<std::string, uint32_t> numbers_;  // by folded path
  const TableRow* behind_ = nullptr;         // the last one of those so far that is in both
  std::string last_;
  std::vector<TableEdit> edits_;
};

}  // namespace

const char* table_change_name(TableChange change) {
  constexpr const char* kNames[kTableChangeCount] = {"removed", "order",    "type",   "initial",
                                                     "retain",  "constant", "address"};
  return kNames[static_cast<size_t>(change)];
}

std::vector<TableEdit> table_edits(const ir::Image& before, const ir::Image& after,
                                   TableSide side) {
  const TableRows was(before, side);
  const TableRows is(after, side);
  return TableComparer(is.rows).run(was.rows, side);
}

std::string table_edits_text(const std::vector<TableEdit>& edits) {
  std::string text;
  for (size_t i = 0; i < std::min(edits.size(), kMostNamed); ++i) {
    if (i != 0) text += "; ";
    text += base::joined({"`", edits[i].path, "`: ", edits[i].what});
  }
  if (edits.size() > kMostNamed) {
    text += base::joined({"; and ", std::to_string(edits.size() - kMostNamed), " more"});
  }
  return text;
}

base::Status check_table(const std::vector<TableEdit>& edits, std::string_view what) {
  if (edits.empty()) return base::Ok{};
  return base::Error{base::Refusal::kTableEdit,
                     base::joined({what, ": ", table_edits_text(edits)})};
}

}  // namespace online_change
