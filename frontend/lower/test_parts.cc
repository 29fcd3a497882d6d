// Assertions of structures and arrays: member by member, element by element.
#include "frontend/lower/start_code.h"
#include "frontend/lower/test_code.h"
#include "frontend/lower/values.h"
#include "ir/types/parts.h"

namespace frontend {
namespace {

// Two values of one type.
struct Pair {
  ir::Place actual, expected;
  ir::TypeId type;
};

using PerLeaf = std::function<void(const Pair&)>;

// Only what every part has a value of its own in.
bool is_comparable(const ir::TypeTable& types, ir::TypeId id) {
  if (types.is_scalar(id) || is_string(types, id)) return true;
  const ir::Type& type = types[id];
  if (type.kind == ir::Kind::kArray) return is_comparable(types, type.base);
  if (type.kind != ir::Kind::kStruct || types.overlaps(id)) return false;
  return std::ranges::all_of(
      type.members, [&](const ir::Member& member) { return is_comparable(types, member.type); });
}

void each_leaf(StartCode elements, const ir::TypeTable& types, const Pair& pair,
               const PerLeaf& each) {
  const ir::Type type = types[pair.type];
  if (type.kind == ir::Kind::kArray) {
    elements.each_element(pair.actual, pair.type, {}, [&](const ir::Place& one, ir::ConstId) {
      Pair inner{one, pair.expected, type.base};
      for (size_t i = pair.actual.steps.size(); i < one.steps.size(); ++i) {
        inner.expected.steps.push_back(one.steps[i]);
      }
      inner.expected.type = one.type;
      each_leaf(elements, types, inner, each);
    });
    return;
  }
  if (type.kind != ir::Kind::kStruct) return each(pair);
  for (uint32_t i = 0; i < type.members.size(); ++i) {
    Pair inner = pair;
    for (ir::Place* place : {&inner.actual, &inner.expected}) {
      place->steps.push_back(step_to(ir::StepKind::kMember, i));
      place->type = type.members[i].type;
    }
    inner.type = type.members[i].type;
    each_leaf(elements, types, inner, each);
  }
}

}  // namespace

void TestCode::assert_parts(TestCall call, const std::vector<ExprId>& args, ir::TypeId type,
                            ExprId message) {
  const bool equal = call == TestCall::kAssertEq;
  if ((!equal && call != TestCall::kAssertNeq) || !is_comparable(types(), type)) {
    error(DiagnosticCode::kWrongArgument, tree_[args[0]].span,
          "`" + sema_.report.type_text(type) + "` cannot be compared as a whole",
          "compare its members or elements, one ASSERT_EQ for each");
    return;
  }
  const Pair all{place(args[0]), place(args[1]), type};
  const ir::Place differs = temporary_place(elementary(ir::Kind::kBool));
  if (!equal) build_.store(differs, ir::Scalar::kBool, build_.constant(ir::Scalar::kBool, 0));
  each_leaf(ask<StartCode>(), types(), all, [&](const Pair& leaf) {
    const bool text = is_string(types(), leaf.type);
    Typed a{{}, leaf.type};
    Typed b{{}, leaf.type};
    if (!text) {
      a.value = build_.load(leaf.actual, scalar(leaf.type));
      b.value = build_.load(leaf.expected, scalar(leaf.type));
    }
    const BinaryOp op = equal ? BinaryOp::kEq : BinaryOp::kNe;
    const ir::ValueId holds = text ? code_.compare_places(op, leaf.actual, leaf.expected)
                                   : code_.compare_scalars(op, leaf.type, a.value, b.value);
    if (!equal) {
      const ir::ValueId before = build_.load(differs, ir::Scalar::kBool);
      build_.store(differs, ir::Scalar::kBool,
                   build_.binary(ir::Op::kOr, ir::Scalar::kBool, before, holds));
      return;
    }
    fail_unless(holds, message, [&] {
      Pieces actual = text ? literal_of(leaf.actual) : literal_of(a);
      for (const ir::Place& piece : way_to(leaf.actual, all.actual)) actual.push_back(piece);
      return difference("", text ? literal_of(leaf.expected) : literal_of(b), actual);
    });
  });
  if (equal) return;
  fail_unless(build_.load(differs, ir::Scalar::kBool), message,
              [&] { return constant_text("expected a difference, got none"); });
}

// " in .list[3].x"
TestCode::Pieces TestCode::way_to(const ir::Place& leaf, const ir::Place& whole) {
  Pieces out;
  std::string text = " in ";
  ir::TypeId at = whole.type;
  size_t dimension = 0;
  for (size_t i = whole.steps.size(); i < leaf.steps.size(); ++i) {
    const ir::Step& step = leaf.steps[i];
    const ir::Type& type = types()[at];
    if (step.kind == ir::StepKind::kMember) {
      text += "." + type.members[step.index].name;
      at = type.members[step.index].type;
      continue;
    }
    out.push_back(constant_text(text + (dimension == 0 ? "[" : ", ")));
    out.push_back(text_of({step.value, elementary(ir::Kind::kLint)}));
    text.clear();
    if (++dimension < type.dims.size()) continue;
    text = "]";
    dimension = 0;
    at = type.base;
  }
  out.push_back(constant_text(text));
  return out;
}

}  // namespace frontend
