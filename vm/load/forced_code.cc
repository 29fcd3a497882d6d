#include "vm/load/forced_code.h"

#include <algorithm>

#include "ir/bytecode/pou_version.h"
#include "vm/exec/execution.h"
#include "vm/exec/handler_numbers.h"
#include "vm/load/decode.h"
#include "vm/native/program.h"

namespace vm {
namespace {

using How = Writer::How;
using ir::Opcode;

Opcode move_of(ir::Class cls) {
  constexpr Opcode kMoves[ir::kClassCount] = {
      Opcode::MOV_B,   Opcode::MOV_8,   Opcode::MOV_16, Opcode::MOV_32, Opcode::MOV_64,
      Opcode::MOV_F32, Opcode::MOV_F64, Opcode::MOV_A,  Opcode::MOV_S,  Opcode::MOV_W};
  return kMoves[static_cast<size_t>(cls)];
}

std::string place_of(const ir::Image& image, const Writer& writer) {
  const ir::LinkedPou& pou = image.pous[writer.pou];
  return "`" + pou.name + "` in line " + std::to_string(line_of(pou, writer.unit));
}

std::string way_of(const Writer& writer) {
  return writer.how == How::kAddress   ? "by VAR_IN_OUT or by a reference"
         : writer.how == How::kIndexed ? "by an index"
                                       : "with other variables";
}

}  // namespace

ir::Unit without_store(const ir::Unit& store) {
  const ir::OpcodeRow& row = ir::opcode_row(store.opcode());
  const bool far = store.opcode() >= Opcode::STFAR_B && store.opcode() <= Opcode::STFAR_F64;
  const ir::Base base = far ? ir::Base::kFrame : store.base_a();
  ir::Unit unit = ir::Unit::make(move_of(row.a.cls), base, base);
  unit.a = unit.b = store.a;
  return unit;
}

std::vector<ir::PouVersion> ForcedCode::rows_of(const Versions& versions) {
  std::vector<ir::PouVersion> rows;
  for (const auto& [pou, version] : versions) {
    rows.push_back({pou, version.units, !version.restoring.empty()});
  }
  return rows;
}

// Writers are sorted by variable and POU.
void ForcedCode::describe(const ir::Image& image, const std::vector<Writer>& writers) {
  std::vector<const Writer*> first(variables_.size());
  std::vector<const Writer*> last(variables_.size());
  std::vector<size_t> pous(variables_.size());
  for (const Writer& writer : writers) {
    if (writer.how == How::kOnly) continue;
    const uint32_t v = writer.variable;
    if (first[v] == nullptr) first[v] = &writer;
    if (last[v] == nullptr || last[v]->pou != writer.pou) ++pous[v];
    last[v] = &writer;
  }
  for (size_t v = 0; v < variables_.size(); ++v) {
    if (pous[v] <= kMostRestoringPous) continue;
    reasons_[v] = place_of(image, *first[v]) + " may write it " + way_of(*first[v]) +
                  ", and so may more than " + std::to_string(kMostRestoringPous - 1) +
                  " other POUs";
  }
}

ForcedCode::Versions ForcedCode::versions_of(const ir::Image& image,
                                             const std::vector<Writer>& writers) const {
  Versions versions;
  for (const bool only : {true, false}) {
    for (const Writer& writer : writers) {
      if (!reasons_[writer.variable].empty() || (writer.how == How::kOnly) != only) continue;
      const ir::LinkedPou& pou = image.pous[writer.pou];
      const auto first = image.code.begin() + pou.first_unit;
      auto [row, is_new] = versions.try_emplace(writer.pou);
      Version& version = row->second;
      if (is_new) version.units.assign(first, first + pou.unit_count);
      ir::Unit& unit = version.units[writer.unit];
      if (only) {
        unit = without_store(first[writer.unit]);
      } else if (unit == first[writer.unit]) {  // else it writes nothing any more
        version.restoring[writer.unit].push_back(writer.variable);
      }
    }
  }
  return versions;
}

// A version that does not pass takes its variables with it. True: there was one.
bool ForcedCode::refuse_versions(const std::vector<ir::PouVersion>& versions,
                                 const std::vector<base::Status>& answers,
                                 const std::vector<Writer>& writers) {
  bool any = false;
  for (size_t i = 0; i < versions.size(); ++i) {
    if (answers[i].ok()) continue;
    for (const Writer& writer : writers) {
      if (writer.pou != versions[i].pou || !reasons_[writer.variable].empty()) continue;
      reasons_[writer.variable] = base::to_string(answers[i].error());
      any = true;
    }
  }
  return any;
}

void ForcedCode::put_aside(const Version& version, std::vector<ir::Unit>& decoded) {
  for (const auto& [unit, variables] : version.restoring) {
    const bool extended = ir::opcode_row(version.units[unit].opcode()).extended;
    StoreAside& aside = asides_.emplace_back();
    aside.units[0] = decoded[unit];
    if (extended) aside.units[1] = decoded[unit + 1];
    aside.units[extended ? 2 : 1] = aside_unit(kRestoreHandler, aside);
    aside.back = &decoded[unit] + (extended ? 2 : 1);
    for (const uint32_t v : variables) {
      const ForcedVariable& row = variables_[v];
      aside.values.push_back({row.place.data, row.place.size, row.value.data(), row.mask});
    }
    decoded[unit] = aside_unit(kAsideHandler, aside);
  }
}

std::shared_ptr<const ForcedCode> ForcedCode::make(const ir::VerifiedImage& verified,
                                                   const CodeTable& own,
                                                   std::span<const ForcedVariable> variables,
                                                   const TierOptions& tier,
                                                   const VerifyVersions& verify) {
  const ir::Image& image = verified.image();
  std::vector<Variable> places;
  for (const ForcedVariable& variable : variables) places.push_back(variable.place);
  if (places.empty()) return nullptr;
  std::vector<Writer> writers = find_writers(image, places);
  for (Writer& writer : writers) {
    const bool bit = variables[writer.variable].mask != 0;
    if (bit && writer.how == How::kOnly) writer.how = How::kPart;
  }
  if (writers.empty()) return nullptr;
  const auto made = std::make_shared<ForcedCode>(Key());
  made->variables_.assign(variables.begin(), variables.end());
  made->reasons_.resize(variables.size());
  made->describe(image, writers);
  Versions versions;
  std::vector<ir::PouVersion> rows;
  do {
    versions = made->versions_of(image, writers);
    rows = rows_of(versions);
  } while (made->refuse_versions(rows, verify(verified, rows), writers));
  made->table_ = {own.pous, nullptr, own.clean_bools};
  for (PouEntry& pou : made->table_.pous) {
    pou.entry = pou.code;
    pou.machine = nullptr;
  }
  const Decoder decoder(image, own.clean_bools, tier);
  made->code_.reserve(versions.size());
  for (const auto& [number, version] : versions) {
    std::vector<ir::Unit>& decoded = made->code_.emplace_back();
    if (version.restoring.empty()) {
      decoder.run(image.pous[number], version.units, decoded);
    } else {
      decoder.run_unfused(version.units, decoded);
      made->put_aside(version, decoded);
    }
    PouEntry& pou = made->table_.pous[number];
    pou.code = pou.entry = decoded.data();
  }
  if (own.native != nullptr) {
    made->table_.native = native::Program::make(image, own.clean_bools, made->table_.pous, tier,
                                                own.native.get(), rows);
  }
  return made;
}

}  // namespace vm
