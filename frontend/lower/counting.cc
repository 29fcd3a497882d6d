// Counting, where a build for coverage asks for it (frontend/coverage.h).
#include "frontend/lower/counting.h"

#include "frontend/sema/model.h"

namespace frontend {
namespace {

// The rung or network that a place is in, from `last` on, as code comes in their order. Null: none.
const network::Network* network_at(const network::Body& body, base::SourcePos at,
                                   const network::Network* last) {
  const network::Network* const end = body.networks.data() + body.networks.size();
  const network::Network* network = last == nullptr ? body.networks.data() : last;
  for (; network != end; ++network) {
    if (!(at < network->span.begin) && at < network->span.end) return network;
  }
  return nullptr;
}

}  // namespace

void Counting::begin(Coverage* coverage, const std::string& pou) {
  const base::SourcePos at = info_.decl->span.begin;
  if (coverage == nullptr || !coverage->counts(at)) return;
  coverage_ = coverage;
  count(SiteKind::kPou, at, pou);
}

void Counting::count(SiteKind kind, base::SourcePos at, const std::string& name, uint32_t side) {
  if (coverage_ == nullptr) return;
  const ir::Place counter = coverage_->counter(kind, at, side, name);
  const ir::ValueId before = build_.load(counter, ir::Scalar::kU32);
  build_.store(
      counter, ir::Scalar::kU32,
      build_.binary(ir::Op::kAdd, ir::Scalar::kU32, before, build_.constant(ir::Scalar::kU32, 1)));
}

void Counting::statement(const Stmt& stmt) {
  const bool runs = stmt.kind != StmtKind::kEmpty && stmt.kind != StmtKind::kError &&
                    stmt.kind != StmtKind::kLabel;
  if (coverage_ == nullptr || !runs) return;
  if (info_.decl->diagram != kNoDiagram) {
    const network::Body& body = tree_.diagrams[info_.decl->diagram];
    const network::Network* network = network_at(body, stmt.span.begin, rung_);
    if (network == nullptr || network == rung_) return;
    rung_ = network;
    const auto number = network - body.networks.data() + 1;
    return count(SiteKind::kRung, network->span.begin, std::to_string(number));
  }
  count(SiteKind::kStatement, stmt.span.begin);
}

// In two blocks of their own, whatever else leads to `yes` and `no`.
void Counting::decide(ir::ValueId condition, ir::BlockId yes, ir::BlockId no, base::SourcePos at,
                      const char* what) {
  if (coverage_ == nullptr) return build_.branch(condition, yes, no);
  const ir::BlockId sides[] = {build_.new_block(), build_.new_block()};
  build_.branch(condition, sides[0], sides[1]);
  build_.start(sides[0]);
  count(SiteKind::kBranch, at, std::string(what) + ": TRUE", 0);
  build_.jump(yes);
  build_.start(sides[1]);
  count(SiteKind::kBranch, at, std::string(what) + ": FALSE", 1);
  build_.jump(no);
}

void Counting::power(ir::ValueId power, ExprId target, base::SourcePos at) {
  if (coverage_ == nullptr || info_.decl->diagram == kNoDiagram) return;
  const Expr& expr = tree_[target];
  const bool made = expr.name.text.find('#') != std::string_view::npos;  // what an edge remembers
  if (made || expr.kind == ExprKind::kResult) return;
  const ir::BlockId done = build_.new_block();
  decide(power, done, done, at, "power");
  build_.start(done);
}

}  // namespace frontend
