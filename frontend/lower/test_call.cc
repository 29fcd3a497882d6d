// Assertions and the other calls of tests. A failed assertion leaves its message in a global
// and traps, which ends the test; stc test shows both.
#include "frontend/lower/conversions.h"
#include "frontend/lower/mock_code.h"
#include "frontend/lower/test_code.h"
#include "frontend/lower/values.h"
#include "frontend/sema/constants/constants.h"
#include "frontend/sema/expressions/operator_types.h"
#include "frontend/sema/expressions/operators.h"
#include "frontend/sema/expressions/width.h"

namespace frontend {
namespace {

using stdlib::NativeId;

constexpr uint32_t kMessageText = 400;
constexpr uint32_t kValueText = 80;

struct Relation {
  BinaryOp op;
  const char* wanted;  // completes "expected X" in front of the second argument
};

Relation relation_of(TestCall call) {
  switch (call) {
    case TestCall::kAssertNeq:
      return {BinaryOp::kNe, "anything but "};
    case TestCall::kAssertGt:
      return {BinaryOp::kGt, "more than "};
    case TestCall::kAssertLt:
      return {BinaryOp::kLt, "less than "};
    case TestCall::kAssertGe:
      return {BinaryOp::kGe, "at least "};
    case TestCall::kAssertLe:
      return {BinaryOp::kLe, "at most "};
    default:
      return {BinaryOp::kEq, ""};
  }
}

}  // namespace

void TestCode::test_call(const Expr& call, const TestCallRow& row) {
  std::vector<ExprId> args;
  for (uint32_t i = 0; i < call.list.count; ++i) {
    const Arg& arg = tree_.args[call.list.first + i];
    if (arg.value.valid() && arg.name.empty()) args.push_back(arg.value);
  }
  const bool named = args.size() != call.list.count;
  if (args.size() < row.fewest || args.size() > row.most || named) {
    error(DiagnosticCode::kWrongArgumentCount, call.span,
          std::string(row.name) + " with " + std::to_string(call.list.count) +
              (named ? " arguments, not all of them values without a name" : " arguments"),
          "it takes, in this order: " + std::string(row.parameters));
    return;
  }
  const ExprId message = args.size() == row.most && row.most > 1 ? args.back() : ExprId();
  if (message.valid() && !is_message(message)) return;
  switch (row.call) {
    case TestCall::kAdvanceTime:
      if (is_time_ahead(args[0])) advance_time(args[0]);
      return;
    case TestCall::kAssert:
    case TestCall::kAssertTrue:
    case TestCall::kAssertFalse: {
      const bool wanted = row.call != TestCall::kAssertFalse;
      ir::ValueId given = ask<Values>().condition(args[0]);
      if (!wanted) given = build_.unary(ir::Op::kNot, ir::Scalar::kBool, given);
      fail_unless(given, message, [&] {
        return constant_text(wanted ? "expected TRUE, got FALSE" : "expected FALSE, got TRUE");
      });
      return;
    }
    case TestCall::kAssertNear:
      return assert_near(args, message);
    case TestCall::kVerifyCalled:
    case TestCall::kVerifyCallCount:
      return verify_calls(args, row.call == TestCall::kVerifyCallCount, message);
    default:
      return assert_relation(row.call, args, message);
  }
}

bool TestCode::is_message(ExprId message) {
  const Note& note = infer(message);
  if (!note.type.valid() || is_string(types(), note.type)) return note.type.valid();
  error(DiagnosticCode::kWrongArgument, tree_[message].span,
        "the message is `" + sema_.report.type_text(note.type) + "`",
        "the last argument is the text that a failure shows: 'pump is off'");
  return false;
}

bool TestCode::is_time_ahead(ExprId duration) {
  const Note& note = infer(duration);
  if (!note.type.valid()) return false;
  const bool time = traits_of(types(), note.type).duration;
  const bool back =
      time && note.constant &&
      static_cast<int64_t>(
          ask<Constants>().fold_bits(duration, elementary(ir::Kind::kLtime)).value_or(0)) < 0;
  if (time && !back) return true;
  error(DiagnosticCode::kWrongArgument, tree_[duration].span,
        back ? std::string("time does not go back")
             : "the duration is `" + sema_.report.type_text(note.type) + "`",
        back ? "every test begins anew at time 0; advance by what is missing"
             : "write a TIME: ADVANCE_TIME(T#5s)");
  return false;
}

void TestCode::advance_time(ExprId duration) {
  const Typed ns{value(duration, elementary(ir::Kind::kLtime)), elementary(ir::Kind::kLtime)};
  if (!infer(duration).constant) {
    const ir::ValueId zero = build_.constant(ir::Scalar::kI64, 0);
    const ir::ValueId ahead = build_.compare(ir::Op::kLe, ir::Scalar::kI64, zero, ns.value);
    fail_unless(ahead, {}, [&] {
      return joined(constant_text("time does not go back: ADVANCE_TIME got "), text_of(ns));
    });
  }
  build_.advance_time(ns.value);
}

void TestCode::assert_relation(TestCall call, const std::vector<ExprId>& args, ExprId message) {
  const Relation relation = relation_of(call);
  const Note common =
      ask<OperatorTypes>().unify(infer(args[0]), infer(args[1]), tree_[args[1]].span);
  if (!common.type.valid()) return;
  if (is_string(types(), common.type)) {
    const ir::Place a = place(args[0]);
    const ir::Place b = place(args[1]);
    fail_unless(code_.compare_places(relation.op, a, b), message,
                [&] { return difference(relation.wanted, literal_of(b), literal_of(a)); });
  } else if (!types().is_scalar(common.type)) {
    assert_parts(call, args, common.type, message);
  } else {
    const ir::TypeId type = compared_type(*this, common.type, {args[0], args[1]});
    const Typed a{value(args[0], type), type};
    const Typed b{value(args[1], type), type};
    fail_unless(code_.compare_scalars(relation.op, type, a.value, b.value), message,
                [&] { return difference(relation.wanted, literal_of(b), literal_of(a)); });
  }
}

// NaN is near nothing.
void TestCode::assert_near(const std::vector<ExprId>& args, ExprId message) {
  const ir::TypeId lreal = elementary(ir::Kind::kLreal);
  const ir::ValueId actual = value(args[0], lreal);
  const ir::ValueId expected = value(args[1], lreal);
  const ir::ValueId tolerance = value(args[2], lreal);
  ir::ValueId distance = build_.binary(ir::Op::kSub, ir::Scalar::kF64, actual, expected);
  distance = build_.unary(ir::Op::kAbs, ir::Scalar::kF64, distance);
  const ir::ValueId holds = build_.compare(ir::Op::kLe, ir::Scalar::kF64, distance, tolerance);
  fail_unless(holds, message, [&] {
    ir::Place text = joined(constant_text("expected "), text_of({expected, lreal}));
    text = joined(joined(text, constant_text(" within ")), text_of({tolerance, lreal}));
    return joined(joined(text, constant_text(", got ")), text_of({actual, lreal}));
  });
}

void TestCode::verify_calls(const std::vector<ExprId>& args, bool exact, ExprId message) {
  const auto calls = ask<MockCode>().mock_slot(args[0], &MockSlots::calls);
  if (!calls) return;
  const ir::TypeId udint = elementary(ir::Kind::kUdint);
  const Typed count{build_.load(*calls, ir::Scalar::kU32), udint};
  const Typed wanted{exact ? value(args[1], udint) : build_.constant(ir::Scalar::kU32, 1), udint};
  const ir::ValueId holds = build_.compare(exact ? ir::Op::kEq : ir::Op::kLe, ir::Scalar::kU32,
                                           wanted.value, count.value);
  fail_unless(holds, message, [&] {
    ir::Place text =
        joined(constant_text(exact ? "expected " : "expected at least "), text_of(wanted));
    return joined(joined(text, constant_text(" calls, got ")), text_of(count));
  });
}

// `what` is built where the assertion has failed.
void TestCode::fail_unless(ir::ValueId holds, ExprId message,
                           const std::function<ir::Place()>& what) {
  const ir::BlockId failed = build_.new_block();
  const ir::BlockId passed = build_.new_block();
  build_.branch(holds, passed, failed);
  build_.start(failed);
  if (sema_.for_tests()) {
    ir::Place text = what();
    if (message.valid()) {
      const ir::Place words = place(message);
      if (is_string(types(), words.type)) {
        text = joined(ask<Conversions>().narrow_string(words, wide(words.type)),
                      joined(constant_text(": "), text));
      }
    }
    build_.copy(global_place(sema_.tests.message), text);
  }
  build_.trap(ir::TrapKind::kAssert);
  build_.start(passed);
}

ir::Place TestCode::constant_text(std::string text) {
  ir::Place place;
  place.base = ir::PlaceBase::kConst;
  place.base_type = place.type =
      sema_.program.types.string(static_cast<uint32_t>(std::max<size_t>(text.size(), 1)));
  place.constant = sema_.program.constants.add({0, std::move(text), {}});
  return place;
}

// expected X, got Y
ir::Place TestCode::difference(const char* wanted, const Pieces& expected, const Pieces& actual) {
  ir::Place text = constant_text(std::string("expected ") + wanted);
  for (const ir::Place& piece : expected) text = joined(text, piece);
  text = joined(text, constant_text(", got "));
  for (const ir::Place& piece : actual) text = joined(text, piece);
  return text;
}

// A name, a number, a time; of others the text between marks, which stc test makes a literal of.
TestCode::Pieces TestCode::literal_of(Typed value) {
  const Traits traits = traits_of(types(), value.type);
  if (traits.enumeration) {
    const ir::Place text = temporary_place(sema_.program.types.string(kValueText));
    ask<Conversions>().write_enumerator_name(text, value);
    return {text};
  }
  const ir::Place text = text_of(value);
  if (traits.character) {
    return marked(types().root_kind(value.type) == ir::Kind::kChar ? '\'' : '"', text);
  }
  if (!traits.bits) return {text};
  // The digits of a byte are two.
  return marked(static_cast<char>('0' + ir::scalar_size(scalar(value.type)) * 2 % 16), text);
}

TestCode::Pieces TestCode::literal_of(const ir::Place& text) {
  const bool is_wide = wide(text.type);
  return marked(is_wide ? '"' : '\'', ask<Conversions>().narrow_string(text, is_wide));
}

TestCode::Pieces TestCode::marked(char sort, const ir::Place& text) {
  return {constant_text({kTestValueBegin, sort}), text, constant_text({kTestValueEnd})};
}

// Longer than any number, time, date or name of an enumerator that fits a message.
ir::Place TestCode::text_of(Typed value) {
  ir::Place text = temporary_place(sema_.program.types.string(kValueText));
  ask<Conversions>().write_text(text, value);
  return text;
}

// Three buffers serve all messages of a body; neither operand is overwritten.
ir::Place TestCode::joined(const ir::Place& first, const ir::Place& second) {
  if (body_.message_buffers[0] == Lowering::kNoLocal) {
    for (uint32_t& buffer : body_.message_buffers) {
      buffer = build_.temporary(sema_.program.types.string(kMessageText));
    }
  }
  auto holds = [](const ir::Place& place, uint32_t buffer) {
    return place.base == ir::PlaceBase::kLocal && place.base_index == buffer;
  };
  size_t free = 0;
  while (holds(first, body_.message_buffers[free]) || holds(second, body_.message_buffers[free]))
    ++free;
  const ir::Place out = local_place(body_.message_buffers[free]);
  code_.native(NativeId::kConcatS,
               {code_.string_value(out), code_.string_value(first), code_.string_value(second)});
  return out;
}

}  // namespace frontend
