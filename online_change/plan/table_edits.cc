#include "online_change/plan/table_edits.h"

#include <algorithm>
#include <map>

#include "base/name_case.h"
#include "ir/bytecode/canonical_value.h"
#include "ir/bytecode/located_paths.h"
#include "ir/types/address_text.h"
#include "ir/types/shared_bytes.h"
#include "ir/types/value_text.h"
#include "online_change/plan/type_content.h"

namespace online_change {
namespace {

constexpr size_t kMostNamed = 20;
constexpr const char* kNoAddress = "no address";

// One variable of a table, as far as it counts.
struct TableRow {
  std::string name;
  std::string type;
  std::string content;
  std::string value;  // as people read it; "": too long for a line
  base::Bytes canonical;
  bool retain = false;
  bool constant = false;
  std::string address;
};

// Tables of one image.
class TableRows {
 public:
  explicit TableRows(const ir::Image& image)
      : image_(image), types_(*image.types), content_(types_) {}

  std::vector<TableRow> globals() {
    std::vector<TableRow> rows;
    for (const ir::Member& member : types_[image_.globals].members) {
      if (ir::is_shared(types_, member)) {
        add_shared(member, rows);
      } else {
        add(member, rows);
      }
    }
    return rows;
  }

  std::vector<TableRow> of_program(ir::TypeId type) {
    std::vector<TableRow> rows;
    for (const ir::Member& member : types_[type].members) add(member, rows);
    return rows;
  }

 private:
  // Charts and tests make variables that no source declares.
  bool is_declared(const ir::Member& member) const {
    return ir::is_listed(member) && member.name.find('#') == std::string::npos &&
           !types_.text(member.type).starts_with("__SFC_");
  }

  void add(const ir::Member& member, std::vector<TableRow>& rows) {
    if (!is_declared(member)) return;
    TableRow row;
    row.name = member.name;
    row.type = types_.text(member.type);
    row.content = content_.of(member.type);
    row.value = value_of(member);
    base::ByteWriter out;
    ir::write_canonical(out, types_, image_.constants, member.type, member.init);
    row.canonical = out.take();
    row.retain = member.retain;
    row.constant = member.constant;
    row.address = address_of(member.address);
    rows.push_back(std::move(row));
  }

  // Variables at overlapping addresses are members of one that is hidden.
  void add_shared(const ir::Member& hidden, std::vector<TableRow>& rows) {
    const std::vector<ir::Member>& members = types_[hidden.type].members;
    for (size_t i = 0; i < members.size(); ++i) {
      const size_t known = rows.size();
      add(members[i], rows);
      if (rows.size() == known) continue;
      rows.back().address = address_of(ir::shared_address(types_, hidden, i));
      if (ir::is_shared_bit(members[i])) rows.back().type = rows.back().content = "BOOL";
    }
  }

  static std::string address_of(const ir::DirectAddress& address) {
    if (address.area == ir::DirectArea::kNone) return {};
    return address.bit_offset == ir::kOpenAddress ? std::string("open") : ir::address_text(address);
  }

  // What is not said of an elementary type is zero.
  std::string value_of(const ir::Member& member) const {
    const ir::Kind kind = types_[member.type].kind;
    const bool said = member.init.valid();
    if (types_.is_scalar(member.type)) {
      if (!said && !ir::is_elementary(kind)) return {};
      return ir::scalar_text(types_, member.type, said ? image_.constants[member.init].bits : 0);
    }
    if (kind != ir::Kind::kString) return {};
    return ir::string_text(said ? image_.constants[member.init].text : std::string());
  }

  const ir::Image& image_;
  const ir::TypeTable& types_;
  TypeContent content_;
};

using RowNumbers = std::map<std::string, size_t>;  // by folded name

RowNumbers numbers_of(const std::vector<TableRow>& rows) {
  RowNumbers numbers;
  for (size_t i = 0; i < rows.size(); ++i) numbers.emplace(base::fold_name(rows[i].name), i);
  return numbers;
}

// Of numbers in some order: which stay when as few as possible go, so that the rest ascends.
std::vector<bool> ascending(const std::vector<size_t>& numbers) {
  std::vector<size_t> ends;  // positions; of each length the chain that ends lowest
  std::vector<size_t> before(numbers.size(), numbers.size());
  for (size_t i = 0; i < numbers.size(); ++i) {
    const auto place =
        std::lower_bound(ends.begin(), ends.end(), numbers[i],
                         [&](size_t end, size_t number) { return numbers[end] < number; });
    if (place != ends.begin()) before[i] = *std::prev(place);
    place == ends.end() ? ends.push_back(i) : void(*place = i);
  }
  std::vector<bool> stays(numbers.size());
  for (size_t at = ends.empty() ? numbers.size() : ends.back(); at != numbers.size();) {
    stays[at] = true;
    at = before[at];
  }
  return stays;
}

std::string changed(const std::string& before, const std::string& after, const char* none) {
  return (before.empty() ? none : before) + " -> " + (after.empty() ? none : after);
}

// One table against another.
class TableComparer {
 public:
  TableComparer(std::string program, const std::vector<TableRow>& before,
                const std::vector<TableRow>& after, TableSide side, std::vector<TableEdit>& out)
      : program_(std::move(program)), before_(before), after_(after), side_(side), out_(out) {}

  void run() {
    const RowNumbers numbers = numbers_of(after_);
    std::vector<size_t> common;
    for (const TableRow& row : before_) {
      const auto found = numbers.find(base::fold_name(row.name));
      if (found != numbers.end()) common.push_back(found->second);
    }
    const std::vector<bool> stays = ascending(common);
    size_t next = 0;
    std::string last;
    for (const TableRow& row : before_) {
      const auto found = numbers.find(base::fold_name(row.name));
      if (found == numbers.end()) {
        if (side_ == TableSide::kBefore) add(TableChange::kRemoved, row.name, "removed", last);
        continue;
      }
      const TableRow& now = after_[found->second];
      if (!stays[next++]) {
        add(TableChange::kOrder, row.name,
            last.empty() ? "it was the first" : "it stood behind `" + last + "`", last);
      }
      compare(row, now, last);
      last = now.name;
    }
  }

 private:
  void add(TableChange change, const std::string& name, std::string what, const std::string& last) {
    out_.push_back({change, program_, name, std::move(what), last});
  }

  void compare(const TableRow& before, const TableRow& after, const std::string& last) {
    if (before.type != after.type) {
      add(TableChange::kType, after.name, "type " + before.type + " -> " + after.type, last);
    } else if (before.content != after.content) {
      add(TableChange::kType, after.name, "type " + after.type + " has another content", last);
    } else if (before.canonical != after.canonical &&
               (before.value.empty() || before.value != after.value)) {
      const bool known = !before.value.empty() && !after.value.empty();
      add(TableChange::kInitial, after.name,
          known ? "initial value " + before.value + " -> " + after.value : "another initial value",
          last);
    }
    flag(TableChange::kRetain, "RETAIN", after.name, before.retain, after.retain, last);
    flag(TableChange::kConstant, "CONSTANT", after.name, before.constant, after.constant, last);
    if (before.address != after.address) {
      add(TableChange::kAddress, after.name,
          "address " + changed(before.address, after.address, "none"), last);
    }
  }

  void flag(TableChange change, const char* word, const std::string& name, bool was, bool is,
            const std::string& last) {
    if (was != is) add(change, name, (is ? "now " : "no longer ") + std::string(word), last);
  }

  std::string program_;
  const std::vector<TableRow>& before_;
  const std::vector<TableRow>& after_;
  TableSide side_;
  std::vector<TableEdit>& out_;
};

// By folded name.
std::map<std::string, const ir::Instance*> programs_of(const ir::Image& image) {
  std::map<std::string, const ir::Instance*> out;
  for (const uint32_t id : image.program_ids()) {
    out.emplace(base::fold_name(image.instances[id].name), &image.instances[id]);
  }
  return out;
}

void compare_programs(const ir::Image& before, const ir::Image& after,
                      std::vector<TableEdit>& out) {
  const auto now = programs_of(after);
  TableRows was(before);
  TableRows is(after);
  for (const uint32_t id : before.program_ids()) {
    const ir::Instance& row = before.instances[id];
    const auto found = now.find(base::fold_name(row.name));
    if (found == now.end()) {
      out.push_back({TableChange::kRemoved, row.name, "", "removed, with its variables"});
      continue;
    }
    const std::string type = before.types->text(row.type);
    const std::string other = after.types->text(found->second->type);
    if (!base::same_name(type, other)) {
      out.push_back({TableChange::kType, row.name, "", "type " + type + " -> " + other});
    }
    TableComparer(row.name, was.of_program(row.type), is.of_program(found->second->type),
                  TableSide::kBefore, out)
        .run();
  }
}

void compare_addresses(const ir::Image& before, const ir::Image& after, TableSide side,
                       std::vector<TableEdit>& out) {
  std::map<std::string, std::string> now;
  for (const ir::LocatedPath& row : ir::located_paths(after)) {
    now.emplace(base::fold_name(row.path), ir::address_text(row.address));
  }
  for (const ir::LocatedPath& row : ir::located_paths(before)) {
    const auto found = now.find(base::fold_name(row.path));
    const bool gone = found == now.end();
    if (gone && side == TableSide::kOwn) continue;
    const std::string was = ir::address_text(row.address);
    const std::string is = gone ? kNoAddress : found->second;
    if (was != is) {
      out.push_back({TableChange::kAddress, "", row.path, "address " + was + " -> " + is});
    }
  }
}

}  // namespace

const char* table_change_name(TableChange change) {
  constexpr const char* kNames[kTableChangeCount] = {"removed", "order",    "type",   "initial",
                                                     "retain",  "constant", "address"};
  return kNames[static_cast<size_t>(change)];
}

std::string TableEdit::path() const {
  if (program.empty() || variable.empty()) return program + variable;
  return program + "." + variable;
}

std::vector<TableEdit> table_edits(const ir::Image& before, const ir::Image& after,
                                   TableSide side) {
  std::vector<TableEdit> out;
  const std::vector<TableRow> was = TableRows(before).globals();
  const std::vector<TableRow> is = TableRows(after).globals();
  TableComparer("", was, is, side, out).run();
  if (side == TableSide::kBefore) compare_programs(before, after, out);
  compare_addresses(before, after, side, out);
  return out;
}

std::string table_edits_text(const std::vector<TableEdit>& edits, const PlaceOfEdit& place) {
  std::string text;
  for (size_t i = 0; i < std::min(edits.size(), kMostNamed); ++i) {
    if (i != 0) text += "; ";
    if (place) text += place(edits[i]);
    text += "`" + edits[i].path() + "`: " + edits[i].what;
  }
  if (edits.size() > kMostNamed) {
    text += "; and " + std::to_string(edits.size() - kMostNamed) + " more";
  }
  return text;
}

base::Status check_table(const std::vector<TableEdit>& edits, const std::string& what) {
  if (edits.empty()) return base::Ok{};
  return base::Error{base::Refusal::kTableEdit, what + ": " + table_edits_text(edits)};
}

}  // namespace online_change
