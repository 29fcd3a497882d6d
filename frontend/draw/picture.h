// Bodies of POUs as pictures (SVG): ladder, function block diagrams, sequential function charts.
// The same body gives the same bytes everywhere.
#pragma once

#include <string>

#include "frontend/draw/live.h"
#include "frontend/draw/notes.h"
#include "frontend/draw/svg.h"
#include "frontend/parse/tree.h"

namespace frontend::draw {

struct Look {
  const Live* live = nullptr;    // values of a running program; null: none are shown
  const Notes* notes = nullptr;  // addresses and comments of operands; null: none are shown
  double width = 0;              // a longer rung goes on below; 0: it never does
};

// Networks below each other, each under its number, title, label and comments; disabled ones are
// pale. Bridges of ladder, which are no series and parallel branches, have rails and wires that
// meet at dots. Boxes and variables of FBD have the number of their turn in the network.
std::string draw_body(const network::Body& body, std::string_view title, const Look& look);

// `sources` holds the texts of the conditions.
std::string draw_chart(const Tree& tree, const base::SourceMap& sources, const Chart& chart,
                       std::string_view title, const Live* live);

// Paths of the variables that a live picture shows, seen from the POU.
std::vector<std::string> variables(const network::Body& body);
std::vector<std::string> variables(const Tree& tree, const base::SourceMap& sources,
                                   const Chart& chart);

}  // namespace frontend::draw
