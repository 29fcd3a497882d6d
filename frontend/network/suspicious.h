// What a diagram may say, but hardly means: a second coil or writer of a variable (W0035), a
// timer, counter or edge box whose input gets no power (W0036).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.h"
#include "frontend/network/network.h"

namespace frontend::network {

// A coil ( ) or (/) that writes the same place in every scan.
struct PlainCoil {
  const Element* element;  // of the body
  std::string place;       // its operand, folded, without blanks
};
// None of a body with JMP or RETURN, which may leave coils out on purpose.
std::vector<PlainCoil> plain_coils(const Body& body);

void report_suspicious(const Body& body, base::Diagnostics& diagnostics);

// --- its parts
// The operand, folded, when it is the same place whatever else is going on (no index varies); else
// "".
std::string fixed_place(std::string_view operand);
// A jump or RETURN may leave out what follows.
bool may_skip(const Body& body);
void report_second_writers(const Body& body, base::Diagnostics& diagnostics);

}  // namespace frontend::network
