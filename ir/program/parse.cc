// Text -> program: the declarations. Three passes over the lines: names of types
// and POUs, declarations, bodies, so that everything may be used before its line.
#include <array>

#include "base/limits.h"
#include "ir/program/parse_scope.h"
#include "ir/program/text.h"
#include "ir/program/text_names.h"

namespace ir {
namespace {

constexpr uint64_t kMaxValues = 1u << 24;  // of all POUs of one text

class ProgramParser {
 public:
  base::Result<Program> parse(std::string_view text) {
    split(text);
    if (!for_each_line(&ProgramParser::register_names) ||
        !for_each_line(&ProgramParser::parse_declaration) || !parse_bodies()) {
      return base::Error{base::Refusal::kBadFormat,
                         "IR text, line " + std::to_string(line_) + ": " + reason_};
    }
    if (!program_.globals.valid()) {
      return base::Error{base::Refusal::kBadFormat, "IR text has no line `globals TYPE`"};
    }
    return std::move(program_);
  }

 private:
  using LineFunction = void (ProgramParser::*)(LineReader&, std::string_view);

  void split(std::string_view text) {
    while (!text.empty()) {
      const size_t end = std::min(text.find('\n'), text.size());
      lines_.push_back(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  bool for_each_line(LineFunction function) {
    for (line_ = 1; line_ <= lines_.size(); ++line_) {
      LineReader line(lines_[line_ - 1]);
      if (line.at_end()) {
        continue;
      }
      (this->*function)(line, lines_[line_ - 1]);
      if (line.failed()) {
        reason_ = line.reason();
        return false;
      }
    }
    return true;
  }

  void register_names(LineReader& line, std::string_view) {
    if (line.take("type")) {
      scope_.add_type(line);
    } else if (line.take("pou")) {
      line.word();
      scope_.add_pou(line.name());
    }
  }

  void parse_declaration(LineReader& line, std::string_view text) {
    struct Declaration {
      std::string_view word;
      void (ProgramParser::*parse)(LineReader&);
    };
    constexpr std::array<Declaration, 11> kDeclarations = {{
        {"program", &ProgramParser::parse_name},
        {"schedule", &ProgramParser::parse_schedule},
        {"type", &ProgramParser::parse_type},
        {"member", &ProgramParser::parse_member},
        {"const", &ProgramParser::parse_constant},
        {"globals", &ProgramParser::parse_globals},
        {"task", &ProgramParser::parse_task},
        {"instance", &ProgramParser::parse_instance},
        {"override", &ProgramParser::parse_override},
        {"pou", &ProgramParser::parse_pou},
        {"local", &ProgramParser::parse_local},
    }};
    for (const Declaration& declaration : kDeclarations) {
      if (line.take(declaration.word)) {
        (this->*declaration.parse)(line);
        if (!line.at_end()) {
          line.fail("unexpected " + std::string(line.peek()) + " after the declaration");
        }
        return;
      }
    }
    if (bodies_.empty()) {
      line.fail("expected a declaration, found " + std::string(line.peek()));
    } else {
      bodies_.back().push_back({line_, text});
    }
  }

  static ConstId parse_init(LineReader& line) {
    return line.take("init") ? line.constant() : ConstId();
  }

  void parse_name(LineReader& line) { program_.name = line.name(); }
  void parse_schedule(LineReader& line) { program_.schedule = line.schedule(); }
  void parse_globals(LineReader& line) { program_.globals = scope_.type(line); }

  void parse_type(LineReader& line) {
    Type type;
    type.name = scope_.type_label(line);
    line.expect("=");
    type.kind = static_cast<Kind>(static_cast<uint32_t>(Kind::kString) + line.choice(kKindWords));
    parse_definition(line, type);
    const ConstId init = parse_init(line);
    const OldNameId old_name = parse_renamed(line);
    if (!line.failed()) {
      Type& declared = program_.types.edit(declare(std::move(type)));
      declared.init = init;
      declared.old_name = old_name;
    }
  }

  void parse_definition(LineReader& line, Type& type) {
    switch (type.kind) {
      case Kind::kString:
      case Kind::kWstring:
        type.capacity = static_cast<uint32_t>(line.number(base::kMaxStringCapacity));
        break;
      case Kind::kEnum:
        type.base = scope_.type(line);
        parse_literals(line, type);
        break;
      case Kind::kSubrange:
        type.base = scope_.type(line);
        parse_range(line, type.low, type.high);
        break;
      case Kind::kPointer:
      case Kind::kRefTo:
      case Kind::kReferenceTo:
        type.base = scope_.type(line);
        break;
      case Kind::kStruct:
      case Kind::kUnion:
        if (type.kind == Kind::kStruct) type.overlap = line.take("overlap");
        if (line.take("packed")) type.capacity = static_cast<uint32_t>(line.number(8));
        break;
      case Kind::kArray:
        type.base = scope_.type(line);
        parse_dimensions(line, type);
        break;
      case Kind::kFunctionBlock:
      case Kind::kInterface:
        parse_ancestors(line, type);
        break;
      default:
        break;
    }
  }

  void parse_ancestors(LineReader& line, Type& type) {
    if (line.take("extends")) {
      type.base = scope_.type(line);
    }
    if (line.take("implements")) {
      do {
        type.interfaces.push_back(scope_.type(line));
      } while (line.take(","));
    }
  }

  static void parse_range(LineReader& line, int64_t& low, int64_t& high) {
    low = line.signed_number();
    line.expect(".");
    line.expect(".");
    high = line.signed_number();
  }

  OldNameId parse_renamed(LineReader& line) {
    return line.take("renamed") ? program_.types.add_old_name(std::string(line.name()))
                                : OldNameId();
  }

  void parse_literals(LineReader& line, Type& type) {
    line.expect("(");
    while (!line.failed() && !line.take(")")) {
      EnumLiteral literal;
      literal.name = line.name();
      line.expect("=");
      literal.value = line.signed_number();
      literal.old_name = parse_renamed(line);
      type.literals.push_back(std::move(literal));
      if (line.peek() != ")") {
        line.expect(",");
      }
    }
  }

  static void parse_dimensions(LineReader& line, Type& type) {
    line.expect("[");
    do {
      Dimension dim;
      parse_range(line, dim.low, dim.high);
      type.dims.push_back(dim);
    } while (line.take(","));
    line.expect("]");
  }

  // Anonymous strings, arrays and subranges are interned, as the front end does.
  TypeId declare(Type type) {
    const TypeId expected(program_.types.size());
    if (type.name.empty() && intern(type) == expected) {
      return expected;
    }
    return program_.types.declare(std::move(type));
  }

  TypeId intern(const Type& type) {
    switch (type.kind) {
      case Kind::kString:
        return program_.types.string(type.capacity);
      case Kind::kWstring:
        return program_.types.wstring(type.capacity);
      case Kind::kArray:
        return program_.types.array(type.base, type.dims);
      case Kind::kSubrange:
        return program_.types.subrange(type.base, type.low, type.high);
      case Kind::kPointer:
      case Kind::kRefTo:
      case Kind::kReferenceTo:
        return program_.types.reference(type.kind, type.base);
      default:
        return TypeId();
    }
  }

  void parse_member(LineReader& line) {
    Member member;
    member.section = static_cast<Section>(line.choice(kSectionWords));
    member.name = line.name();
    line.expect(":");
    member.type = scope_.type(line);
    member.constant = line.take("constant");
    member.retain = line.take("retain");
    member.init = parse_init(line);
    if (line.take("at")) {
      member.address.area = static_cast<DirectArea>(line.choice(kAreaWords));
      member.address.bit_offset = static_cast<uint32_t>(line.number(0xffffffff));
      member.address.bit_size = static_cast<uint32_t>(line.number(0xffffffff));
    }
    member.old_name = parse_renamed(line);
    const TypeId owner(program_.types.size() - 1);
    if (!program_.types.has_members(owner)) {
      line.fail("member after a type that has none");
    } else {
      program_.types.edit(owner).members.push_back(std::move(member));
    }
  }

  void parse_constant(LineReader& line) {
    if (line.constant() != ConstId(program_.constants.size())) {
      line.fail("constants are numbered in order; this is #" +
                std::to_string(program_.constants.size()));
    }
    line.expect("=");
    ConstValue value;
    const std::string_view first = line.peek();
    if (!first.empty() && first[0] != '\'' && first[0] != '{') {
      value.bits = static_cast<uint64_t>(line.signed_number());
    }
    if (line.peek().starts_with('\'')) {
      value.text = line.string();
    }
    if (line.take("{")) {
      parse_elements(line, value);
    }
    program_.constants.add(std::move(value));
  }

  static void parse_elements(LineReader& line, ConstValue& value) {
    while (!line.failed() && !line.take("}")) {
      ConstElement element;
      element.first = line.index();
      element.count = line.take("*") ? line.index() : 1;
      line.expect("=");
      element.value = line.constant();
      value.elements.push_back(element);
      if (line.peek() != "}") {
        line.expect(",");
      }
    }
  }

  void parse_task(LineReader& line) {
    Task task;
    task.name = line.name();
    task.once = line.take("once");
    task.period_ns = 0;
    if (!task.once) {
      line.expect("period");
      task.period_ns = line.signed_number();
    }
    if (line.take("event")) {
      const int32_t member = program_.types.find_member(program_.globals, line.name());
      if (member < 0) line.fail("the event is no global");
      task.event = static_cast<uint32_t>(member);
    }
    task.watchdog_ns = line.take("watchdog") ? line.signed_number() : 0;
    line.expect("priority");
    task.priority = line.index();
    while (!line.at_end() && !line.failed()) line.policy(task.policy);
    program_.tasks.push_back(std::move(task));
  }

  void parse_instance(LineReader& line) {
    ProgramInstance instance;
    instance.name = line.name();
    line.expect(":");
    instance.type = scope_.type(line);
    line.expect("task");
    instance.task = line.index();
    instance.init = parse_init(line);
    instance.old_name = parse_renamed(line);
    program_.instances.push_back(std::move(instance));
  }

  void parse_override(LineReader& line) {
    Override row;
    row.type = scope_.type(line);
    line.expect(":");
    row.prototype = scope_.pou(line);
    line.expect("=");
    row.target = scope_.pou(line);
    program_.overrides.push_back(row);
  }

  void parse_pou(LineReader& line) {
    Pou pou;
    pou.kind = static_cast<PouKind>(line.choice(kPouWords));
    pou.name = line.name();
    pou.self = line.take("self") ? scope_.type(line) : TypeId();
    pou.recursion_depth = line.take("recursion") ? line.index() : 0;
    if (line.take("file")) {
      pou.file = line.string();
      line.expect("line");
      pou.line = line.index();
    }
    if (line.take("hash") && !base::digest_from_hex(line.token(), pou.content.identity)) {
      line.fail("the hash has not 64 hexadecimal digits");
    }
    program_.pous.push_back(std::move(pou));
    bodies_.emplace_back();
  }

  void parse_local(LineReader& line) {
    Local local;
    local.kind = static_cast<LocalKind>(line.choice(kLocalWords));
    local.name = line.name();
    line.expect(":");
    local.type = scope_.type(line);
    if (program_.pous.empty()) {
      line.fail("local outside of a POU");
      return;
    }
    program_.pous.back().locals.push_back(std::move(local));
  }

  bool parse_bodies() {
    uint64_t value_budget = kMaxValues;
    for (size_t i = 0; i < bodies_.size(); ++i) {
      const BodyError error =
          parse_body(program_, scope_, bodies_[i], value_budget, program_.pous[i]);
      if (!error.reason.empty()) {
        line_ = error.line;
        reason_ = error.reason;
        return false;
      }
    }
    return true;
  }

  Program program_;
  ParseScope scope_;
  std::vector<std::string_view> lines_;
  std::vector<std::vector<BodyLine>> bodies_;  // parallel to Program::pous
  uint32_t line_ = 0;
  std::string reason_;
};

}  // namespace

base::Result<Program> parse_program(std::string_view text) {
  if (text.size() > base::kMaxSourceBytes) {
    return base::Error{base::Refusal::kTooLarge, "IR text of " + std::to_string(text.size()) +
                                                     " bytes; the limit is " +
                                                     std::to_string(base::kMaxSourceBytes)};
  }
  return ProgramParser().parse(text);
}

}  // namespace ir
