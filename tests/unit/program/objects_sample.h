// A program with everything of "Objects" and "Caught traps" in ir.h: a chain of blocks
// Base <- Middle <- Leaf, an interface, methods with arguments of all kinds.
#pragma once

#include <string>
#include <string_view>

namespace ir {

// Base.total, Middle.step, Leaf.extra. `add` returns what it added: Base x, Middle 10 * x,
// Leaf has none of its own. `twice` of Base calls `add` of whatever it is. Bodies count in
// total by 1 (Base), 100 + Base (Middle), Leaf has Middle's.
inline constexpr std::string_view kObjectTypes = R"(type Adder = interface
type Wide = interface implements Adder
type Base = function_block
  member local total : DINT
type Middle = function_block extends Base implements Adder
  member local total : DINT
  member input step : DINT
type Leaf = function_block extends Middle implements Adder, Wide
  member local total : DINT
  member input step : DINT
  member local extra : INT
type Other = function_block
  member local total : LINT
)";

inline constexpr std::string_view kObjectPous = R"(pou method 'Adder.add' self Adder
  local input x : DINT
  local return r : DINT
  b0:
    trap reference
pou function_block Base self Base
  b0:
    v0 = load i32 self.total
    v1 = const i32 1
    v2 = add i32 v0, v1
    store i32 self.total, v2
    return
pou method 'Base.add' self Base
  local input x : DINT
  local return r : DINT
  b0:
    v0 = load i32 self.total
    v1 = load i32 local.x
    v2 = add i32 v0, v1
    store i32 self.total, v2
    store i32 local.r, v1
    return
pou method 'Base.twice' self Base
  local input x : DINT
  local return r : DINT
  b0:
    v0 = load i32 local.x
    v1 = this u64
    store i32 arg('Base.add').x, v0
    call_virtual 'Base.add', v1
    v2 = load i32 arg('Base.add').r
    store i32 arg('Base.add').x, v0
    call_virtual 'Base.add', v1
    v3 = load i32 arg('Base.add').r
    v4 = add i32 v2, v3
    store i32 local.r, v4
    return
pou function_block Middle self Middle
  b0:
    call_body Base
    v0 = load i32 self.total
    v1 = load i32 self.step
    v2 = add i32 v0, v1
    store i32 self.total, v2
    return
pou method 'Middle.add' self Middle
  local input amount : DINT
  local return r : DINT
  local temp scaled : DINT
  b0:
    v0 = load i32 local.amount
    v1 = const i32 10
    v2 = mul i32 v0, v1
    store i32 local.scaled, v2
    store i32 arg('Base.add').x, v2
    call_method 'Base.add'
    v3 = load i32 arg('Base.add').r
    store i32 local.r, v3
    return
pou function_block Leaf self Leaf
  b0:
    call_body Middle
    v0 = const i16 7
    store i16 self.extra, v0
    return
pou function_block Other self Other
  b0:
    return
)";

// `globals` and the body of Main as given; `more` are further lines before the POUs.
inline std::string object_program(std::string_view globals, std::string_view body,
                                  std::string_view overrides = "",
                                  std::string_view more_pous = "") {
  return "program P\ntype G = globals\n" + std::string(globals) + std::string(kObjectTypes) +
         "type Main = program\n  member local base : Base\n  member local middle : Middle\n"
         "  member local leaf : Leaf\n  member local leaves : %33\n  member local other : Other\n"
         "type %33 = array Leaf [1..3]\n"
         "globals G\ntask T period 1000000 priority 0\ninstance Main : Main task 0\n" +
         std::string(overrides) + std::string(kObjectPous) + std::string(more_pous) +
         "pou program Main self Main\n" + std::string(body);
}

// What find_overrides() finds for kObjectPous when Base.add and Adder.add are called.
inline constexpr std::string_view kObjectOverrides = R"(override Base : 'Base.add' = 'Base.add'
override Middle : 'Adder.add' = 'Middle.add'
override Middle : 'Base.add' = 'Middle.add'
override Leaf : 'Adder.add' = 'Middle.add'
override Leaf : 'Base.add' = 'Middle.add'
)";

}  // namespace ir
