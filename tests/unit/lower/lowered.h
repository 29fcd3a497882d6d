// IR text -> object, as text.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "ir/lower/lower.h"
#include "ir/program/text.h"
#include "ir/program/verify.h"

namespace ir {

inline Program parsed(std::string_view text) {
  base::Result<Program> program = parse_program(text);
  EXPECT_TRUE(program.ok()) << (program.ok() ? "" : program.error().text);
  if (!program.ok()) return Program();
  const base::Status status = verify(program.value());
  EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().text);
  return *std::move(program);
}

inline Object lowered(const Program& program, std::string_view pou) {
  base::Result<Object> object = lower(program, program.find_pou(pou));
  EXPECT_TRUE(object.ok()) << (object.ok() ? "" : object.error().text);
  return object.ok() ? *std::move(object) : Object();
}

// The instructions alone, one per line, without unit numbers, merges and lines.
inline std::string instructions(std::string_view text, std::string_view pou) {
  const Program program = parsed(text);
  const std::string all = disassemble(lowered(program, pou), program);
  std::string out;
  size_t at = 0;
  while (at < all.size()) {
    const size_t end = all.find('\n', at);
    const std::string line = all.substr(at, end - at);
    at = end + 1;
    if (!line.starts_with("  ")) continue;
    out += line.substr(line.find(": ") + 2) + "\n";
  }
  return out;
}

// A program whose Main has these members and this body.
inline std::string main_with(std::string_view members, std::string_view body,
                             std::string_view types = "", std::string_view pous = "") {
  return "program P\n" + std::string(types) + "type G = globals\n  member global g1 : INT\n" +
         "type Main = program\n" + std::string(members) +
         "globals G\ntask T period 1000000 priority 0\ninstance Main : Main task 0\n" +
         std::string(pous) + "pou program Main self Main\n" + std::string(body);
}

inline std::string main_code(std::string_view members, std::string_view body,
                             std::string_view types = "", std::string_view pous = "") {
  return instructions(main_with(members, body, types, pous), "Main");
}

}  // namespace ir
