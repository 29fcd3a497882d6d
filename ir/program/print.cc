// The declarations of a program as text; bodies are in print_body.cc.
#include <algorithm>

#include "ir/program/print_body.h"
#include "ir/program/print_names.h"
#include "ir/program/text.h"
#include "ir/program/text_names.h"
#include "ir/types/value_text.h"

namespace ir {
namespace {

std::string constant_text(const ConstValue& value) {
  std::string text;
  if (value.bits != 0 || (value.text.empty() && value.elements.empty())) {
    text += " " + std::to_string(static_cast<int64_t>(value.bits));
  }
  if (!value.text.empty()) {
    text += " " + string_text(value.text);
  }
  if (!value.elements.empty()) {
    text += " {";
    for (const ConstElement& element : value.elements) {
      text += (text.back() == '{' ? "" : ", ") + std::to_string(element.first) +
              (element.count != 1 ? " * " + std::to_string(element.count) : "") + " = #" +
              std::to_string(element.value.index);
    }
    text += "}";
  }
  return text;
}

class ProgramPrinter {
 public:
  explicit ProgramPrinter(const Program& program) : program_(program), names_(program) {}

  std::string print() {
    text_ = "program " + name_text(program_.name) + "\n";
    if (program_.schedule != Schedule::kSendFirst) {
      text_ += "schedule " + std::string(schedule_text(program_.schedule)) + "\n";
    }
    for (uint32_t i = kElementaryCount; i < program_.types.size(); ++i) {
      print_type(TypeId(i));
    }
    for (uint32_t i = 0; i < program_.constants.size(); ++i) {
      text_ += "const #" + std::to_string(i) + " =" +
               constant_text(program_.constants[ConstId(i)]) + "\n";
    }
    text_ += "globals " + names_.type(program_.globals) + "\n";
    print_tasks();
    print_instances();
    for (const Override& row : program_.overrides) {
      text_ += "override " + names_.type(row.type) + " : " + names_.pou(row.prototype) + " = " +
               names_.pou(row.target) + "\n";
    }
    for (const Pou& pou : program_.pous) {
      print_pou(program_, names_, pou, text_);
    }
    return std::move(text_);
  }

 private:
  static std::string init_text(ConstId init) {
    return init.valid() ? " init #" + std::to_string(init.index) : "";
  }

  std::string renamed_text(OldNameId old) const {
    return old.valid() ? " renamed " + name_text(program_.types.old_name(old)) : "";
  }

  void print_type(TypeId id) {
    const Type& type = program_.types[id];
    text_ += "type " + names_.type(id);
    if (!names_.is_unique_type(id) && !type.name.empty()) {
      text_ += " " + name_text(type.name);
    }
    text_ += " = " + definition(type) + init_text(type.init) + renamed_text(type.old_name) + "\n";
    for (const Member& member : type.members) {
      print_member(member);
    }
  }

  std::string definition(const Type& type) const {
    const std::string word(
        kKindWords[static_cast<size_t>(type.kind) - static_cast<size_t>(Kind::kString)]);
    switch (type.kind) {
      case Kind::kString:
      case Kind::kWstring:
        return word + " " + std::to_string(type.capacity);
      case Kind::kEnum:
        return word + " " + names_.type(type.base) + " (" + literals(type) + ")";
      case Kind::kSubrange:
        return word + " " + names_.type(type.base) + " " + std::to_string(type.low) + ".." +
               std::to_string(type.high);
      case Kind::kPointer:
      case Kind::kRefTo:
      case Kind::kReferenceTo:
        return word + " " + names_.type(type.base);
      case Kind::kStruct:
      case Kind::kUnion:
        return word + (type.overlap && type.kind == Kind::kStruct ? " overlap" : "") +
               (type.capacity != 0 ? " packed " + std::to_string(type.capacity) : "");
      case Kind::kArray:
        return word + " " + names_.type(type.base) + " [" + dimensions(type) + "]";
      case Kind::kFunctionBlock:
      case Kind::kInterface:
        return word + ancestors(type);
      default:
        return word;
    }
  }

  std::string ancestors(const Type& type) const {
    std::string text = type.base.valid() ? " extends " + names_.type(type.base) : "";
    for (const TypeId parent : type.interfaces) {
      text += (parent == type.interfaces[0] ? " implements " : ", ") + names_.type(parent);
    }
    return text;
  }

  std::string literals(const Type& type) const {
    std::string text;
    for (const EnumLiteral& literal : type.literals) {
      text += (text.empty() ? "" : ", ") + name_text(literal.name) + " = " +
              std::to_string(literal.value) + renamed_text(literal.old_name);
    }
    return text;
  }

  static std::string dimensions(const Type& type) {
    std::string text;
    for (const Dimension& dim : type.dims) {
      text +=
          (text.empty() ? "" : ", ") + std::to_string(dim.low) + ".." + std::to_string(dim.high);
    }
    return text;
  }

  void print_member(const Member& member) {
    text_ += "  member " + std::string(kSectionWords[static_cast<size_t>(member.section)]) + " " +
             name_text(member.name) + " : " + names_.type(member.type);
    text_ += member.constant ? " constant" : "";
    text_ += member.retain ? " retain" : "";
    text_ += init_text(member.init);
    if (member.address != DirectAddress{}) {
      text_ += " at " + std::string(kAreaWords[static_cast<size_t>(member.address.area)]) + " " +
               std::to_string(member.address.bit_offset) + " " +
               std::to_string(member.address.bit_size);
    }
    text_ += renamed_text(member.old_name) + "\n";
  }

  void print_tasks() {
    for (const Task& task : program_.tasks) {
      text_ += "task " + name_text(task.name) +
               (task.once ? " once" : " period " + std::to_string(task.period_ns));
      const std::vector<Member>& globals = program_.types[program_.globals].members;
      text_ += task.event < globals.size() ? " event " + name_text(globals[task.event].name) : "";
      text_ += task.watchdog_ns != 0 ? " watchdog " + std::to_string(task.watchdog_ns) : "";
      text_ += " priority " + std::to_string(task.priority) + policy_text(task.policy) + "\n";
    }
  }

  void print_instances() {
    for (const ProgramInstance& instance : program_.instances) {
      text_ += "instance " + name_text(instance.name) + " : " + names_.type(instance.type) +
               " task " + std::to_string(instance.task) + init_text(instance.init) +
               renamed_text(instance.old_name) + "\n";
    }
  }

  const Program& program_;
  PrintNames names_;
  std::string text_;
};

}  // namespace

std::string print(const Program& program) { return ProgramPrinter(program).print(); }

std::string print(const Program& program, const Pou& pou) {
  std::string text;
  print_pou(program, PrintNames(program), pou, text);
  return text;
}

}  // namespace ir
