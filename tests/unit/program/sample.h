// A program in IR text that uses everything that the format has.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <string_view>

#include "ir/program/text.h"
#include "ir/program/verify.h"

namespace ir {

inline constexpr std::string_view kSample = R"(program Line
schedule run_first
type %25 = string 10
type %26 = wstring 5
type Color = enum INT (Red = 0, Green = 5) init #0
type Percent = subrange INT 0..100
type %29 = array INT [1..3, 0..1] init #1
type Motor = struct
  member local speed : INT init #2
  member local name : %25 init #3
  member local table : %29
type Counter = function_block
  member input up : BOOL
  member in_out total : DINT
  member output count : INT
  member local motor : Motor
type Main = program
  member local first : Counter init #4
  member local many : %33
  member local text : %26 init #6
  member local x : INT retain
  member local colour : Color
type %33 = array Counter [0..1]
type Globals = globals
  member global total : DINT
  member global limit : INT constant init #2
  member global '%IX0.1' : BOOL at input 1 1
const #0 = 5
const #1 = {0 = #0, 2 * 3 = #0}
const #2 = -7
const #3 = 'a$'b'
const #4 = {2 = #2}
const #5 = {0 = #4}
const #6 = 'a$00$E4$00'
globals Globals
task Fast period 1000000 watchdog 5000000 priority 0
task Slow period 3000000 priority 1 input_buffer first_unseen output_buffer three overrun lengthen
instance Main : Main task 0 init #5
pou function Limit file 'a b.st' line 7 hash 0101010101010101010101010101010101010101010101010101010101010101
  local input low : INT
  local input value : INT
  local in_out hits : DINT
  local output clipped : BOOL
  local return Limit : INT
  local temp '' : DINT
  b0:
    init local.clipped @8
    v0 = load i16 local.low @9
    v1 = load i16 local.value
    v2 = lt i16 v1, v0
    branch v2, b1(v0), b2(v1)
  b1(v3:i16):
    v4 = const bool TRUE
    store bool local.clipped, v4
    v5 = load i32 local.hits^
    v6 = const i32 1
    v7 = add i32 v5, v6
    store i32 local.hits^, v7
    jump b2(v3)
  b2(v8:i16):
    store i16 local.Limit, v8
    return
pou function_block Counter self Counter
  b0:
    v0 = load bool self.up
    branch v0, b1, b2
  b1:
    v1 = load i32 self.total^
    v2 = const i32 1
    v3 = add i32 v1, v2
    store i32 self.total^, v3
    v4 = load i16 self.motor.table[2][1]
    v5 = check_range i16 v4, -10..10
    store i16 self.count, v5
    jump b2
  b2:
    return
pou program Main self Main
  local temp i : INT
  local temp s : %25
  b0:
    init local.s, #3
    v0 = const i16 1
    v1 = address addr global.total
    store addr self.many[v0]!.total, v1
    v2 = const bool TRUE
    store bool self.many[v0]!.up, v2
    call_instance self.many[v0] @40
    v3 = load i16 self.many[1]!.count
    v4 = const i16 6
    v21 = address addr global.total
    store i16 arg(Limit).low, v4
    store i16 arg(Limit).value, v3
    store addr arg(Limit).hits, v21
    call Limit
    v5 = load i16 arg(Limit).Limit
    store i16 self.x, v5
    v6 = string str local.s
    v7 = string str const(#3 : %25)
    native bool CONCAT/v:SSS v6, v7, v7
    v8 = string str local.s
    v9 = native i32 LEN/i:S v8
    v10 = const f32 2.5
    v11 = const f64 -1.0E-07
    v12 = const f32 16#7fc00001
    v13 = const u64 18446744073709551615
    v14 = wrap i16 v9
    store i16 local.i, v14
    v15 = task_time i64
    v16 = address addr self.x
    v17 = load i16 pointee(v16 : INT)
    copy self.first!.motor.name, local.s
    v18 = eq i16 v17, v14
    branch v18, b1, b2
  b1:
    trap division-by-zero @50
  b2:
    return
)";

inline Program parse_ok(std::string_view text) {
  base::Result<Program> program = parse_program(text);
  if (!program.ok()) {
    ADD_FAILURE() << program.error().text;
    return Program();
  }
  return *std::move(program);
}

inline Program verified(std::string_view text) {
  Program program = parse_ok(text);
  const base::Status status = verify(program);
  EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().text);
  return program;
}

// A program that is one POU: globals as given, body of Main as given.
inline std::string small_program(std::string_view globals, std::string_view body,
                                 std::string_view more = "") {
  return "program P\ntype G = globals\n" + std::string(globals) +
         "type Main = program\nglobals G\ntask T period 1000000 priority 0\n"
         "instance Main : Main task 0\n" +
         "pou program Main self Main\n" + std::string(body) + std::string(more);
}

}  // namespace ir
