// bench_fusions PAIRS TRIPLES MORE IMAGE...: chooses the rows of vm/exec/fusions.def from what
// images hold, and writes them to standard output. Run by scripts/choose_fusions.sh.
//
// An instruction counts ten times for each loop that it is in, a called body as often as its calls,
// and each image one in all. First come the PAIRS and TRIPLES of instructions that are most
// frequent when each also counts for its relatives. Then all code is covered with as few dispatches
// as the rows allow; the dispatches that most often follow each other become further rows, MORE of
// them, and all is covered anew. All counts 0: what share of dispatches the rows of this build
// leave. An image with a `-` before its name is not counted; it is shown how well the rows of the
// others fit it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "ir/bytecode/verify.h"
#include "vm/exec/fusion.h"
#include "vm/native/facts.h"

namespace {

struct Pou {
  vm::StepLine line;
  std::vector<double> weight;  // by unit
};
struct Code {
  std::string name;
  std::vector<Pou> pous;
};

std::vector<double> loop_weights(const vm::StepLine& line) {
  std::vector<double> weight(line.size(), 1);
  for (uint32_t i = 0; i < line.size(); ++i) {
    if (line.is_extension(i) || !line[i].jumps || line[i].target > i) continue;
    for (uint32_t k = line[i].target; k <= i; ++k) weight[k] *= 10;
  }
  return weight;
}

uint32_t callee_of(const ir::Image& image, const vm::native::ImageFacts& facts,
                   const ir::LinkedPou& pou, const ir::Unit& unit) {
  const ir::Opcode op = unit.opcode();
  if (op == ir::Opcode::CALL || op == ir::Opcode::CALL_OWN) return unit.c;
  if (op == ir::Opcode::CALL_INST || op == ir::Opcode::CALL_INST_AT)
    return vm::native::called_body(image, facts, pou, unit);
  return ~0u;
}

Code read_code(const char* path) {
  std::ifstream in(path, std::ios::binary);
  base::Bytes bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  base::Result<ir::VerifiedImage> verified = ir::verify(std::move(bytes));
  if (!verified.ok()) {
    std::fprintf(stderr, "%s: %s\n", path, verified.error().text.c_str());
    std::exit(1);
  }
  const ir::Image& image = verified->image();
  const vm::native::ImageFacts facts(image, false);
  Code out{path, {}};
  for (const ir::LinkedPou& pou : image.pous) {
    const auto code = std::span(image.code).subspan(pou.first_unit, pou.unit_count);
    vm::StepLine line(code);
    std::vector<double> weight = loop_weights(line);
    out.pous.push_back({std::move(line), std::move(weight)});
  }
  // How often a POU runs: calls are few deep, so a few rounds are enough.
  std::vector<double> runs(image.pous.size(), 0);
  for (int round = 0; round < 6; ++round) {
    std::vector<double> called(image.pous.size(), 0);
    for (uint32_t p = 0; p < image.pous.size(); ++p) {
      const ir::LinkedPou& pou = image.pous[p];
      if (pou.kind == ir::PouKind::kProgram) called[p] = 1;
      for (uint32_t i = 0; i < pou.unit_count; ++i) {
        if (out.pous[p].line.is_extension(i)) continue;
        const uint32_t callee = callee_of(image, facts, pou, image.code[pou.first_unit + i]);
        if (callee < called.size()) called[callee] += runs[p] * out.pous[p].weight[i];
      }
    }
    runs = called;
  }
  double all = 0;
  for (uint32_t p = 0; p < image.pous.size(); ++p) {
    for (double& w : out.pous[p].weight) w *= runs[p];
    for (uint32_t i = 0; i < out.pous[p].line.size(); ++i)
      if (!out.pous[p].line.is_extension(i)) all += out.pous[p].weight[i];
  }
  for (Pou& pou : out.pous)
    for (double& w : pou.weight) w /= std::max(all, 1e-9);
  return out;
}

bool comes_before(const vm::Fusion& x, const vm::Fusion& y) {
  return std::lexicographical_compare(x.keys.begin(), x.keys.begin() + x.length, y.keys.begin(),
                                      y.keys.begin() + y.length);
}

using Table = std::vector<vm::Fusion>;

// A dispatch as `table` has it: steps from a unit on.
struct Dispatch {
  uint32_t unit = 0;
  uint32_t steps = 1;
  uint32_t next = 0;  // of the dispatch behind; kNoFusion: that is known at run time only
  uint32_t row = vm::kNoFusion;
};

// The dispatches that happen, those behind jumps too.
std::vector<Dispatch> cover(const Pou& pou, const Table& table, const vm::FusionTree& tree) {
  const std::vector<uint32_t> chosen = vm::choose_fusions(pou.line, tree);
  std::vector<bool> seen(pou.line.size() + 1, false);
  std::vector<uint32_t> open;
  std::vector<Dispatch> out;
  const auto visit = [&](uint32_t unit) {
    if (unit >= pou.line.size() || seen[unit]) return;
    seen[unit] = true;
    open.push_back(unit);
  };
  visit(0);
  while (!open.empty()) {
    Dispatch d{open.back(), 1, vm::kNoFusion, chosen[open.back()]};
    open.pop_back();
    if (d.row != vm::kNoFusion) d.steps = table[d.row].length;
    vm::StepWalk walk(pou.line, d.unit);
    vm::StepKey key = 0;
    uint32_t last = d.unit;
    for (uint32_t k = 0; k < d.steps && walk.take(key); ++k) {
      last = walk.unit(k);
      if (pou.line[last].may_jump) visit(pou.line[last].target);
    }
    if (pou.line[last].may_jump) visit(pou.line[last].target);
    visit(pou.line[last].next);
    if (!pou.line[last].ends) d.next = pou.line[last].next;
    out.push_back(d);
  }
  return out;
}

struct Round {
  std::vector<double> left;                         // by image: share of the dispatches
  std::vector<double> used;                         // by row
  std::map<std::vector<vm::StepKey>, double> more;  // what a further row would save
};

// What a dispatch costs an image is relative to all that it has left.
Round try_table(const std::vector<Code>& codes, const Table& table) {
  Round out;
  out.used.resize(table.size(), 0);
  const vm::FusionTree tree(table);
  for (const Code& code : codes) {
    std::vector<std::vector<Dispatch>> covers;
    double left = 1e-9;
    for (const Pou& pou : code.pous) {
      covers.emplace_back();
      if (pou.weight.empty() || pou.weight[0] == 0) continue;
      covers.back() = cover(pou, table, tree);
      for (const Dispatch& d : covers.back()) left += pou.weight[d.unit];
    }
    out.left.push_back(left);
    for (size_t p = 0; p < covers.size(); ++p) {
      const Pou& pou = code.pous[p];
      std::vector<uint32_t> steps(pou.line.size(), 0);
      for (const Dispatch& d : covers[p]) steps[d.unit] = d.steps;
      for (const Dispatch& d : covers[p]) {
        const double share = pou.weight[d.unit] / left;
        if (d.row != vm::kNoFusion) out.used[d.row] += share;
        if (d.next >= pou.line.size()) continue;
        const uint32_t together = d.steps + steps[d.next];
        vm::StepWalk walk(pou.line, d.unit);
        std::vector<vm::StepKey> keys(1);
        while (keys.size() <= together && walk.take(keys.back())) keys.push_back(0);
        keys.pop_back();
        if (keys.size() == together) out.more[keys] += share;
      }
    }
  }
  return out;
}

vm::Fusion row_of(const std::vector<vm::StepKey>& keys) {
  vm::Fusion row;
  row.length = static_cast<uint8_t>(keys.size());
  std::copy(keys.begin(), keys.end(), row.keys.begin());
  return row;
}

void sort_rows(Table& table) {
  std::sort(table.begin(), table.end(), comes_before);
  const auto same = [](const vm::Fusion& x, const vm::Fusion& y) {
    return !comes_before(x, y) && !comes_before(y, x);
  };
  table.erase(std::unique(table.begin(), table.end(), same), table.end());
}

// Gives up rows that are hardly used, then adds those that would save most.
void improve(Table& table, const Round& round, double least, size_t count) {
  Table next;
  for (size_t i = 0; i < table.size(); ++i)
    if (round.used[i] > least) next.push_back(table[i]);
  std::vector<std::pair<double, const std::vector<vm::StepKey>*>> best;
  for (const auto& [keys, share] : round.more) best.push_back({share, &keys});
  std::sort(best.begin(), best.end(), [](const auto& x, const auto& y) {
    return x.first != y.first ? x.first > y.first : *x.second < *y.second;
  });
  for (size_t i = 0; i < std::min(count, best.size()); ++i) {
    next.push_back(row_of(*best[i].second));
  }
  sort_rows(next);
  table = std::move(next);
}

struct Decoded {
  ir::Opcode op;
  ir::Base base[3];
};
Decoded decode(vm::StepKey key) {
  const uint32_t handler = key & 0xffff;
  const auto behind = std::upper_bound(vm::kFirstHandler.begin(), vm::kFirstHandler.end(), handler);
  const auto op = static_cast<ir::Opcode>(behind - vm::kFirstHandler.begin() - 1);
  const uint32_t i = handler - vm::kFirstHandler[static_cast<size_t>(op)];
  return {op, {vm::base_of_a(op, i), vm::base_of_b(op, i), vm::base_of_c(op, i)}};
}

std::string step_text(vm::StepKey key) {
  const auto [op, base] = decode(key);
  std::string text[3];
  for (int field = 0; field < 3; ++field) {
    const uint32_t source = key >> (16 + 4 * field) & 15;
    text[field] = source != 0 ? "v" + std::to_string(source - 1)
                              : std::string(1, "fsgc"[static_cast<int>(base[field])]);
  }
  int count = 3;
  while (count > 0 && text[count - 1] == "f") --count;
  std::string out = "S<O::" + std::string(ir::opcode_row(op).name);
  for (int field = 0; field < count; ++field) out += ", " + text[field];
  return out + ">";
}

double mean(const std::vector<double>& shares) {
  double sum = 0;
  for (const double share : shares) sum += share;
  return sum / static_cast<double>(shares.size());
}

// --- rows for code that is not here -------------------------------------------------------------
//
// What two or three instructions in a row are here others will be elsewhere: of another type,
// with globals for variables of the instance, OR for AND. Each sequence speaks for its relatives.

using Keys = std::vector<vm::StepKey>;

constexpr double kOtherKind = 0.15;
constexpr double kOtherType = 0.3;
constexpr double kOtherBase = 0.6;

// "LE_I16" is the kind "LE" of the type "I16".
std::pair<std::string, std::string> kind_and_type(std::string_view name) {
  const size_t at = name.find('_', name.starts_with("INDEX_PLACE") ? 6 : 0);
  if (at == std::string_view::npos) return {std::string(name), ""};
  return {std::string(name.substr(0, at)), std::string(name.substr(at + 1))};
}

std::vector<std::string> relatives(const std::string& kind, const std::string& type) {
  static const std::vector<std::vector<std::string>> kFamilies = {
      {"EQ", "NE", "LT", "LE", "GT", "GE"}, {"ADD", "SUB", "MUL"}, {"JF", "JT"}, {"MIN", "MAX"}};
  if (type == "B" && (kind.starts_with("AND") || kind.starts_with("OR")))
    return {"AND", "ANDN", "OR", "ORN"};
  for (const auto& family : kFamilies)
    if (std::find(family.begin(), family.end(), kind) != family.end()) return family;
  return {kind};
}

// Types as in `names`, in pairs: what becomes what.
const std::vector<std::vector<std::string>> kTypeChanges = {
    {}, {"16", "32", "I16", "I32"}, {"32", "16", "I32", "I16"}, {"F32", "F64"}, {"F64", "F32"}};

// The step with another opcode and globals for the instance or the other way round; kNoFusion:
// there is none.
vm::StepKey related(vm::StepKey key, ir::Opcode op, bool other_base) {
  Decoded d = decode(key);
  const ir::OpcodeRow& row = ir::opcode_row(op);
  const ir::Field* const fields[3] = {&row.a, &row.b, &row.c};
  for (int i = 0; i < 3; ++i) {
    if (other_base && d.base[i] == ir::Base::kSelf)
      d.base[i] = ir::Base::kGlobal;
    else if (other_base && d.base[i] == ir::Base::kGlobal)
      d.base[i] = ir::Base::kSelf;
    if (d.base[i] != ir::Base::kFrame && !fields[i]->allows(d.base[i])) return vm::kNoFusion;
  }
  const uint32_t handler = vm::handler_number(op, d.base[0], d.base[1], d.base[2]);
  return (key & ~0xffffu) | handler;
}

// Has every result the width that is read of it?
bool is_sound(const Keys& keys) {
  for (const vm::StepKey key : keys) {
    const ir::OpcodeRow& row = ir::opcode_row(decode(key).op);
    const ir::Field* const fields[3] = {&row.a, &row.b, &row.c};
    for (int i = 0; i < 3; ++i) {
      const uint32_t source = key >> (16 + 4 * i) & 15;
      if (source == 0) continue;
      const ir::OpcodeRow& from = ir::opcode_row(decode(keys[source - 1]).op);
      if (ir::class_size(from.a.cls) != ir::class_size(fields[i]->cls)) return false;
    }
  }
  return true;
}

// Adds what a sequence speaks for.
void add_relatives(const Keys& keys, double weight, std::map<Keys, double>& scores) {
  for (const auto& change : kTypeChanges) {
    for (const bool other_base : {false, true}) {
      std::vector<std::pair<Keys, double>> made = {
          {{}, weight * (change.empty() ? 1 : kOtherType) * (other_base ? kOtherBase : 1)}};
      bool changes = change.empty();
      for (const vm::StepKey key : keys) {
        auto [kind, type] = kind_and_type(ir::opcode_row(decode(key).op).name);
        for (size_t i = 0; i < change.size(); i += 2) {
          if (type != change[i]) continue;
          type = change[i + 1];
          changes = true;
          break;
        }
        std::vector<std::pair<Keys, double>> longer;
        for (const std::string& other : relatives(kind, type)) {
          const ir::Opcode op = ir::opcode_from_name(other + (type.empty() ? "" : "_" + type));
          if (static_cast<uint32_t>(op) >= ir::kOpcodeCount) continue;
          const vm::StepKey step = related(key, op, other_base);
          if (step == vm::kNoFusion) continue;
          for (const auto& [begin, score] : made) {
            longer.push_back({begin, score * (other == kind ? 1 : kOtherKind)});
            longer.back().first.push_back(step);
          }
        }
        made = std::move(longer);
      }
      if (!changes) continue;
      for (const auto& [row, score] : made)
        if (is_sound(row)) scores[row] += score;
    }
  }
}

Table general_rows(const std::vector<Code>& codes, uint32_t length, size_t count) {
  std::map<Keys, double> seen;
  for (const Code& code : codes) {
    double size = 0;
    for (const Pou& pou : code.pous) size += pou.line.size();
    for (const Pou& pou : code.pous) {
      for (uint32_t i = 0; i < pou.line.size(); ++i) {
        if (pou.line.is_extension(i)) continue;
        vm::StepWalk walk(pou.line, i);
        Keys keys(1);
        while (keys.size() <= length && walk.take(keys.back())) keys.push_back(0);
        keys.pop_back();
        if (keys.size() == length) seen[keys] += pou.weight[i] + 1 / size;
      }
    }
  }
  std::map<Keys, double> scores;
  for (const auto& [keys, weight] : seen) add_relatives(keys, weight, scores);
  std::vector<std::pair<double, const Keys*>> best;
  for (const auto& [keys, score] : scores) best.push_back({score, &keys});
  std::sort(best.begin(), best.end(), [](const auto& x, const auto& y) {
    return x.first != y.first ? x.first > y.first : *x.second < *y.second;
  });
  Table out;
  for (size_t i = 0; i < std::min(count, best.size()); ++i) out.push_back(row_of(*best[i].second));
  return out;
}

// What share of the dispatches the rows leave.
void show(const std::vector<Code>& codes, const Table& table, std::FILE* to) {
  const Round round = try_table(codes, table);
  for (size_t i = 0; i < codes.size(); ++i)
    std::fprintf(to, "%6.3f %s\n", round.left[i], codes[i].name.c_str());
  std::fprintf(to, "%6.3f on average\n", mean(round.left));
}

Table with_general(Table table, const Table& general) {
  table.insert(table.end(), general.begin(), general.end());
  sort_rows(table);
  return table;
}

// `general` stay; up to `most` are added.
Table choose(const std::vector<Code>& codes, const Table& general, size_t most) {
  Table table = general;
  sort_rows(table);
  most += table.size();
  while (table.size() < most) {
    const size_t before = table.size();
    improve(table, try_table(codes, table), -1, std::min<size_t>(10, most - before));
    if (table.size() == before) break;
  }
  // Rows that longer ones have replaced make room for others.
  for (int round = 0; round < 30; ++round) {
    Table next = table;
    improve(next, try_table(codes, table), round < 15 ? 1e-3 : 2e-3, 0);
    next = with_general(std::move(next), general);
    const size_t room = most - std::min(most, next.size());
    improve(next, try_table(codes, next), -1, room);
    table = std::move(next);
  }
  improve(table, try_table(codes, table), 0, 0);
  table = with_general(std::move(table), general);
  std::fprintf(stderr, "%zu rows, %.3f of the dispatches left\n", table.size(),
               mean(try_table(codes, table).left));
  return table;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  size_t counts[3];
  for (int i = 0; i < 3; ++i) counts[i] = std::strtoul(argv[i + 1], nullptr, 10);
  std::vector<Code> codes;
  std::vector<Code> others;
  for (int i = 4; i < argc; ++i) {
    const bool counts_too = argv[i][0] != '-';
    (counts_too ? codes : others).push_back(read_code(argv[i] + (counts_too ? 0 : 1)));
  }
  if (counts[0] + counts[1] + counts[2] == 0) {
    show(codes, Table(vm::fusions().begin(), vm::fusions().end()), stdout);
    return 0;
  }
  Table general = general_rows(codes, 2, counts[0]);
  const Table triples = general_rows(codes, 3, counts[1]);
  general.insert(general.end(), triples.begin(), triples.end());
  const Table table = choose(codes, general, counts[2]);
  if (!others.empty()) show(others, table, stderr);
  std::printf(
      "// Rows of fused handlers, chosen by scripts/choose_fusions.sh; fusion.h says what they\n"
      "// mean. FUSION(part, steps...): which of fused_*.cc; S<opcode, a, b, c>; f s g c are "
      "bases, "
      "v0 the\n// result of step 0.\n#ifndef STC_NO_FUSIONS\n");
  constexpr size_t kParts = 4;
  for (size_t i = 0; i < table.size(); ++i) {
    const vm::Fusion& row = table[i];
    std::string text = std::to_string(i % kParts);
    for (uint32_t k = 0; k < row.length; ++k) text += ", " + step_text(row.keys[k]);
    std::printf("FUSION(%s)\n", text.c_str());
  }
  std::printf("#endif\n");
  return 0;
}
