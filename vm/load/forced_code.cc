#include "vm/load/forced_code.h"

#include <algorithm>
#include <map>

#include "ir/bytecode/pou_version.h"
#include "vm/exec/execution.h"
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

std::string reason_of(const ir::Image& image, const Writer& writer) {
  const ir::LinkedPou& pou = image.pous[writer.pou];
  const std::string where =
      "`" + pou.name + "` in line " + std::to_string(line_of(pou, writer.unit));
  switch (writer.how) {
    case How::kShared:
      return where + " writes it, for other instances too";
    case How::kPart:
      return where + " writes it together with what is beside it";
    case How::kIndexed:
      return where + " may write it by an index";
    case How::kText:
      return where + " has a function write it";
    default:
      return where + " may write it by VAR_IN_OUT or by a reference";
  }
}

using Versions = std::map<uint32_t, std::vector<ir::Unit>>;  // by POU, as in an image

// Of writers of variables whose writers are all of kOnly.
Versions versions_of(const ir::Image& image, const std::vector<Writer>& writers,
                     const std::vector<std::string>& reasons) {
  Versions versions;
  for (const Writer& writer : writers) {
    if (!reasons[writer.variable].empty()) continue;
    const ir::LinkedPou& pou = image.pous[writer.pou];
    const auto first = image.code.begin() + pou.first_unit;
    auto [version, is_new] = versions.try_emplace(writer.pou);
    if (is_new) version->second.assign(first, first + pou.unit_count);
    version->second[writer.unit] = without_store(first[writer.unit]);
  }
  return versions;
}

std::vector<ir::PouVersion> rows_of(const Versions& versions) {
  std::vector<ir::PouVersion> rows;
  for (const auto& [pou, units] : versions) rows.push_back({pou, units});
  return rows;
}

// A version that does not pass takes its variables with it. True: there was one.
bool refuse_versions(const ir::VerifiedImage& image, const Versions& versions,
                     const std::vector<Writer>& writers, std::vector<std::string>& reasons) {
  const std::vector<ir::PouVersion> rows = rows_of(versions);
  const std::vector<base::Status> answers = ir::verify_versions(image, rows);
  bool any = false;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (answers[i].ok()) continue;
    for (const Writer& writer : writers) {
      if (writer.pou != rows[i].pou || !reasons[writer.variable].empty()) continue;
      reasons[writer.variable] = base::to_string(answers[i].error());
      any = true;
    }
  }
  return any;
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

std::shared_ptr<const ForcedCode> ForcedCode::make(const ir::VerifiedImage& verified,
                                                   const CodeTable& own,
                                                   std::span<const Variable> variables,
                                                   const TierOptions& tier) {
  if (variables.empty()) return nullptr;
  const ir::Image& image = verified.image();
  const std::vector<Writer> writers = find_writers(image, variables);
  if (writers.empty()) return nullptr;
  const auto made = std::make_shared<ForcedCode>(Key());
  made->reasons_.resize(variables.size());
  for (const Writer& writer : writers) {
    std::string& reason = made->reasons_[writer.variable];
    if (reason.empty() && writer.how != How::kOnly) reason = reason_of(image, writer);
  }
  Versions versions = versions_of(image, writers, made->reasons_);
  while (refuse_versions(verified, versions, writers, made->reasons_)) {
    versions = versions_of(image, writers, made->reasons_);
  }
  made->table_ = {own.pous, nullptr, own.clean_bools};
  for (PouEntry& pou : made->table_.pous) {
    pou.entry = pou.code;
    pou.machine = nullptr;
  }
  const Decoder decoder(image, tier);
  made->code_.reserve(versions.size());
  for (const auto& [number, units] : versions) {
    made->code_.emplace_back();
    decoder.run(units, made->code_.back());
    PouEntry& pou = made->table_.pous[number];
    pou.code = pou.entry = made->code_.back().data();
  }
  if (own.native != nullptr) {
    made->table_.native = native::Program::make(image, own.clean_bools, made->table_.pous, tier,
                                                own.native.get(), rows_of(versions));
  }
  return made;
}

}  // namespace vm
