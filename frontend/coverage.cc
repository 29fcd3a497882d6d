#include "frontend/coverage.h"

#include "frontend/parse/tree.h"

namespace frontend {
namespace {

constexpr uint32_t kSideBits = 24;
static_assert(kSiteKinds <= 8);

uint64_t key_of(SiteKind kind, base::SourcePos at, uint32_t side) {
  return (uint64_t{at.offset} << 3 | static_cast<uint64_t>(kind)) << kSideBits | side;
}

}  // namespace

void Coverage::begin(const base::SourceMap& sources, const Tree& tree, uint32_t library_file,
                     ir::Program& program) {
  sources_ = &sources;
  library_file_ = library_file;
  for (const PouDecl& decl : tree.tests) {
    if (decl.kind == PouKind::kTest) test_files_.insert(sources.file_of(decl.span.begin));
  }
  number_ = program.types.elementary(ir::Kind::kUdint);
  ir::Member counters;
  counters.name = kCoverageCounters;
  counters.type = program.types.array(number_, {{0, 0}});
  counters.section = ir::Section::kGlobal;
  std::vector<ir::Member>& members = program.types.edit(program.globals).members;
  global_.base = ir::PlaceBase::kGlobal;
  global_.base_type = program.globals;
  global_.type = number_;
  ir::Step& member = global_.steps.emplace_back();
  member.kind = ir::StepKind::kMember;
  member.index = static_cast<uint32_t>(members.size());
  global_.steps.emplace_back().kind = ir::StepKind::kIndex;
  members.push_back(std::move(counters));
}

bool Coverage::counts(base::SourcePos at) const {
  if (!at.valid()) return false;
  const uint32_t file = sources_->file_of(at);
  return file < library_file_ && !test_files_.contains(file);
}

ir::Place Coverage::counter(SiteKind kind, base::SourcePos at, uint32_t side,
                            const std::string& name) {
  const auto next = static_cast<uint32_t>(sites_.size());
  const auto [found, added] = numbers_.emplace(key_of(kind, at, side), next);
  if (added) {
    Site& site = sites_.emplace_back();
    site.kind = kind;
    site.file = sources_->file_of(at);
    site.line = sources_->locate(at).line;
    site.name = name;
    if (kind == SiteKind::kBranch) {
      const auto decision = static_cast<uint32_t>(decisions_.size());
      site.decision = decisions_.emplace(at.offset, decision).first->second;
    }
  }
  ir::Place place = global_;
  place.steps.back().constant_index = found->second;
  return place;
}

void Coverage::finish(ir::Program& program) const {
  if (sites_.empty()) return;
  const ir::TypeId type =
      program.types.array(number_, {{0, static_cast<int64_t>(sites_.size()) - 1}});
  program.types.edit(program.globals).members[global_.steps[0].index].type = type;
}

}  // namespace frontend
