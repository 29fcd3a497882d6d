#include "tools/stvm/fleet_matrix.h"

#include <algorithm>
#include <map>

#include "base/name_case.h"
#include "tools/common/fleet_parts.h"

namespace stvm {
namespace {

constexpr size_t kScreen = 80;
constexpr size_t kNameColumns = 24;
constexpr size_t kTitleColumns = 14;
constexpr base::Digest kNoPart{};

// "unit A"
std::string part_title(const FleetLine& line) {
  const std::string kind(ir::part_kind_name(line.kind));
  return line.name.empty() ? kind : kind + " " + line.name;
}

std::string cell_text(const FleetCell& cell) { return cell.text + (cell.odd ? "*" : ""); }

void add_edit_lines(const std::vector<const FleetRow*>& rows, FleetMatrix& matrix) {
  for (size_t i = 0; i < rows.front()->parts.size(); ++i) {
    const ir::PartEdit& first = rows.front()->parts[i];
    FleetLine line{first.kind, first.name, first.original, first.edited, {}, {}};
    for (const FleetRow* row : rows) {
      const ir::PartEdit& part = row->parts[i];
      const bool odd =
          part.state == ir::PartState::kMissing || part.state == ir::PartState::kDifferent;
      line.cells.push_back({part.here, std::string(tools::part_state_name(part.state)), odd});
    }
    matrix.lines.push_back(std::move(line));
  }
}

void add_all_lines(const std::vector<const FleetRow*>& rows, FleetMatrix& matrix) {
  std::map<std::pair<ir::PartKind, std::string>, FleetLine> lines;
  for (size_t i = 0; i < rows.size(); ++i) {
    for (const ir::Part& part : rows[i]->has) {
      FleetLine& line = lines[{part.kind, base::fold_name(part.name)}];
      line.kind = part.kind;
      if (line.name.empty()) line.name = part.name;
      line.cells.resize(rows.size());
      line.cells[i].here = part.identity;
    }
  }
  for (auto& [key, line] : lines) {
    line.cells.resize(rows.size());
    for (FleetCell& cell : line.cells) {
      cell.text = cell.here == kNoPart ? "-" : base::short_hex(cell.here).substr(0, 8);
    }
    matrix.lines.push_back(std::move(line));
  }
}

void find_most(FleetLine& line) {
  std::map<base::Digest, size_t> counts;
  for (const FleetCell& cell : line.cells) ++counts[cell.here];
  size_t best = 0;
  for (const auto& [identity, count] : counts) {
    if (count <= best) continue;
    best = count;
    line.most = identity;
  }
}

// Controllers that are alike, as numbers of columns; in the order of their first ones.
std::vector<std::vector<size_t>> alike(const std::vector<const FleetLine*>& shown, size_t count) {
  std::map<std::vector<std::string>, size_t> known;
  std::vector<std::vector<size_t>> groups;
  for (size_t i = 0; i < count; ++i) {
    std::vector<std::string> column;
    for (const FleetLine* line : shown) column.push_back(cell_text(line->cells[i]));
    const auto [found, is_new] = known.emplace(std::move(column), groups.size());
    if (is_new) groups.emplace_back();
    groups[found->second].push_back(i);
  }
  return groups;
}

std::string cut_to(std::string text, size_t width) {
  if (text.size() > width) text.replace(width - 2, std::string::npos, "..");
  return text;
}

std::string group_title(const FleetMatrix& matrix, const std::vector<size_t>& group) {
  const std::string& first = matrix.controllers[group.front()];
  if (group.size() == 1) return cut_to(first, kTitleColumns);
  const std::string more = " +" + std::to_string(group.size() - 1);
  return cut_to(first, kTitleColumns - more.size()) + more;
}

void pad(std::string& line, size_t column) {
  if (line.size() < column) line.resize(column, ' ');
}

void end_line(std::string& out, std::string& line) {
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
  line.clear();
}

using Groups = std::vector<std::vector<size_t>>;

// As many columns as fit, from `first` on; where the next ones begin.
size_t block_text(const FleetMatrix& matrix, const std::vector<const FleetLine*>& shown,
                  const Groups& groups, size_t first, std::string& out) {
  size_t names = 4;
  for (const FleetLine* line : shown) names = std::max(names, part_title(*line).size());
  names = std::min(names, kNameColumns);
  std::vector<size_t> ends = {names};
  size_t end = first;
  for (; end < groups.size(); ++end) {
    size_t width = group_title(matrix, groups[end]).size();
    for (const FleetLine* line : shown) {
      width = std::max(width, cell_text(line->cells[groups[end].front()]).size());
    }
    if (end != first && ends.back() + 2 + width > kScreen) break;
    ends.push_back(ends.back() + 2 + width);
  }
  std::string text = "part";
  for (size_t i = first; i < end; ++i) {
    pad(text, ends[i - first] + 2);
    text += group_title(matrix, groups[i]);
  }
  end_line(out, text);
  for (const FleetLine* line : shown) {
    text = cut_to(part_title(*line), names);
    for (size_t i = first; i < end; ++i) {
      pad(text, ends[i - first] + 2);
      text += cell_text(line->cells[groups[i].front()]);
    }
    end_line(out, text);
  }
  return end;
}

// "line1 +2: line1, line4, line7", wrapped; of a name that was cut, too.
std::string legend(const FleetMatrix& matrix, const std::vector<size_t>& group) {
  const std::string title = group_title(matrix, group);
  if (group.size() == 1 && title == matrix.controllers[group.front()]) return {};
  std::string out = title + ":";
  size_t column = out.size();
  for (size_t i = 0; i < group.size(); ++i) {
    const std::string& name = matrix.controllers[group[i]];
    if (i != 0) out += ",";
    if (column + 3 + name.size() > kScreen) {
      out += "\n ";
      column = 1;
    }
    out += " " + name;
    column += 2 + name.size();
  }
  return out + "\n";
}

}  // namespace

FleetMatrix fleet_matrix(const std::vector<FleetRow>& rows, bool of_edit) {
  FleetMatrix matrix;
  std::vector<const FleetRow*> reached;
  for (const FleetRow& row : rows) {
    if (row.has.empty()) continue;
    reached.push_back(&row);
    matrix.controllers.push_back(row.place);
  }
  if (reached.empty()) return matrix;
  (of_edit ? add_edit_lines : add_all_lines)(reached, matrix);
  for (FleetLine& line : matrix.lines) {
    find_most(line);
    for (FleetCell& cell : line.cells) {
      if (!of_edit) cell.odd = cell.here != line.most;
      matrix.differs = matrix.differs || cell.odd;
    }
  }
  return matrix;
}

std::string matrix_text(const FleetMatrix& matrix, bool of_edit, bool all) {
  std::vector<const FleetLine*> shown;
  for (const FleetLine& line : matrix.lines) {
    const bool odd = std::any_of(line.cells.begin(), line.cells.end(),
                                 [](const FleetCell& cell) { return cell.odd; });
    if (odd || of_edit || all) shown.push_back(&line);
  }
  std::string out;
  if (!shown.empty()) {
    const Groups groups = alike(shown, matrix.controllers.size());
    for (size_t next = 0; next < groups.size();) {
      if (next != 0) out += "\n";
      next = block_text(matrix, shown, groups, next, out);
    }
    for (const std::vector<size_t>& group : groups) out += legend(matrix, group);
  }
  const size_t same = matrix.lines.size() - shown.size();
  if (same != 0) {
    out += std::to_string(same) + " part(s) are the same on all that were reached (--all)\n";
  }
  return out;
}

void matrix_json(const FleetMatrix& matrix, tools::JsonWriter& json) {
  json.begin_array();
  for (const FleetLine& line : matrix.lines) {
    const auto identity = [&](const char* key, const base::Digest& value) {
      json.field(key, value == kNoPart ? std::string() : base::to_hex(value));
    };
    json.begin_object().field("kind", std::string(ir::part_kind_name(line.kind)));
    json.field("name", line.name);
    identity("original", line.original);
    identity("edited", line.edited);
    identity("most", line.most);
    json.key("controllers").begin_array();
    for (size_t i = 0; i < line.cells.size(); ++i) {
      json.begin_object().field("controller", matrix.controllers[i]);
      identity("identity", line.cells[i].here);
      json.field("odd", line.cells[i].odd).end_object();
    }
    json.end_array().end_object();
  }
  json.end_array();
}

}  // namespace stvm
