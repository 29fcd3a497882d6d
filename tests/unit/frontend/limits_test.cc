// base/limits.def: what a source may just contain, and what is one too many. Depth and height are
// in tests/unit/parse, what only images have in tests/unit/bytecode and tests/unit/linker.
#include <gtest/gtest.h>

#include "base/limits.h"
#include "tests/unit/frontend/harness.h"

namespace frontend_test {
namespace {

std::string errors(const std::string& declarations, const std::string& variables) {
  return compile(declarations + "PROGRAM P VAR " + variables + " END_VAR END_PROGRAM\n").errors();
}

std::string enumeration(uint64_t literals) {
  std::string text = "TYPE E : UDINT (";
  for (uint64_t i = 0; i < literals; ++i) text += (i == 0 ? "e" : ", e") + std::to_string(i);
  return text + "); END_TYPE\n";
}

std::string tries(uint32_t count) {
  std::string text = "PROGRAM P VAR n : INT; END_VAR ";
  for (uint32_t i = 0; i < count; ++i) text += "__TRY ";
  text += "n := 1 / n; ";
  for (uint32_t i = 0; i < count; ++i) text += "__CATCH n := 2; __ENDTRY ";
  return text + "END_PROGRAM\n";
}

TEST(Limits, Tries) {
  EXPECT_EQ(compile(tries(base::kMaxTryDepth)).errors(), "");
  EXPECT_EQ(compile(tries(base::kMaxTryDepth + 1)).errors(), "E6001");
}

// Half of the USINGs at the head of the file, half in the program.
std::string usings(uint32_t count) {
  std::string text;
  std::string inner;
  for (uint32_t i = 0; i < count; ++i) {
    const std::string name = "N" + std::to_string(i);
    text += "NAMESPACE " + name + " TYPE T" + std::to_string(i) + " : INT; END_TYPE END_NAMESPACE ";
    (i % 2 == 0 ? text : inner) += "USING " + name + "; ";
  }
  const std::string last = "T" + std::to_string(base::kMaxUsings - 1);
  return text + "PROGRAM P " + inner + "VAR n : " + last + "; END_VAR n := 1; END_PROGRAM\n";
}

TEST(Limits, kMaxUsings) {
  EXPECT_EQ(compile(usings(base::kMaxUsings)).errors(), "");
  EXPECT_EQ(compile(usings(base::kMaxUsings + 1)).errors(), "E6003 E2003");
}

// The names of namespaces around each other, with their dots, are as long as an identifier may be.
TEST(Limits, NamespacePath) {
  auto space = [](uint32_t length) {
    const std::string first(base::kMaxIdentifier / 2, 'A');
    const std::string second(length - first.size() - 1, 'B');
    return "NAMESPACE " + first + "." + second + " TYPE T : INT; END_TYPE END_NAMESPACE\n";
  };
  EXPECT_EQ(errors(space(base::kMaxIdentifier), "n : INT;"), "");
  EXPECT_EQ(errors(space(base::kMaxIdentifier + 1), "n : INT;"), "E6003");
}

TEST(Limits, Enumerators) {
  EXPECT_EQ(errors(enumeration(base::kMaxEnumerators), "e : E;"), "");
  EXPECT_EQ(errors(enumeration(base::kMaxEnumerators + 1), "e : E;"), "E6003");
}

std::string array(uint32_t dimensions) {
  std::string text = "a : ARRAY[";
  for (uint32_t i = 0; i < dimensions; ++i) text += i == 0 ? "0..1" : ", 0..1";
  return text + "] OF BOOL;";
}

TEST(Limits, Dimensions) {
  EXPECT_EQ(errors("", array(base::kMaxDimensions)), "");
  EXPECT_EQ(errors("", array(base::kMaxDimensions + 1)), "E6006");
}

TEST(Limits, StringCapacity) {
  auto string = [](uint32_t length) { return "s : STRING[" + std::to_string(length) + "];"; };
  EXPECT_EQ(errors("", string(base::kMaxStringCapacity)), "");
  EXPECT_EQ(errors("", string(base::kMaxStringCapacity + 1)), "E6007");
  EXPECT_EQ(errors("", string(0)), "E6007");
}

TEST(Limits, TypeBytes) {
  auto bytes = [](uint64_t count) {
    return "a : ARRAY[1.." + std::to_string(count) + "] OF BYTE;";
  };
  EXPECT_EQ(errors("", bytes(base::kMaxTypeBytes)), "");
  EXPECT_EQ(errors("", bytes(uint64_t{base::kMaxTypeBytes} + 1)), "E6005");
}

std::string tasks(uint32_t count) {
  std::string text = "PROGRAM P END_PROGRAM CONFIGURATION c RESOURCE r ON PLC\n";
  for (uint32_t i = 0; i < count; ++i) {
    text += "TASK t" + std::to_string(i) + "(INTERVAL := T#10ms, PRIORITY := 1);\n";
  }
  return text + "PROGRAM p WITH t0 : P; END_RESOURCE END_CONFIGURATION\n";
}

TEST(Limits, Tasks) {
  EXPECT_EQ(compile(tasks(base::kMaxTasks)).errors(), "");
  EXPECT_EQ(compile(tasks(base::kMaxTasks + 1)).errors(), "E6003");
}

TEST(Limits, Resources) {
  auto resources = [](uint32_t count) {
    std::string text = "PROGRAM P END_PROGRAM CONFIGURATION c ";
    for (uint32_t i = 0; i < count; ++i) {
      text += "RESOURCE r" + std::to_string(i) + " ON cpu PROGRAM p : P; END_RESOURCE ";
    }
    return text + "END_CONFIGURATION";
  };
  EXPECT_EQ(compile(resources(base::kMaxResources)).errors(), "");
  EXPECT_EQ(compile(resources(base::kMaxResources + 1)).errors(), "E6003");
}

TEST(Limits, Identifier) {
  auto variable = [](size_t length) { return std::string(length, 'v') + " : INT;"; };
  EXPECT_EQ(errors("", variable(base::kMaxIdentifier)), "");
  EXPECT_EQ(errors("", variable(base::kMaxIdentifier + 1)), "E6002");
}

// All files together; the standard library does not count.
TEST(Limits, SourceBytes) {
  EXPECT_EQ(frontend::CompileOptions().max_source_bytes, base::kMaxSourceBytes);
  const std::string first = "FUNCTION f : INT f := 1; END_FUNCTION\n";
  const std::string second = "PROGRAM P VAR x : INT; END_VAR x := f(); END_PROGRAM\n";
  auto codes = [&](uint64_t limit) {
    base::SourceMap sources;
    sources.add("a.st", first);
    sources.add("b.st", second);
    frontend::CompileOptions options;
    options.max_source_bytes = limit;
    base::Diagnostics diagnostics;
    frontend::compile(sources, options, diagnostics);
    std::string out;
    for (const base::Diagnostic& message : diagnostics.all()) {
      out += base::diagnostic_row(message.code).code;
    }
    return out;
  };
  EXPECT_EQ(codes(first.size() + second.size()), "");
  EXPECT_EQ(codes(first.size() + second.size() - 1), "E6004");  // kSourceTooLarge
}

}  // namespace
}  // namespace frontend_test
