// Bodies of POUs as pictures (SVG): ladder, function block diagrams, sequential function charts.
// The same body gives the same bytes everywhere.
#pragma once

#include <string>

#include "frontend/draw/live.h"
#include "frontend/draw/svg.h"
#include "frontend/parse/tree.h"

namespace frontend::draw {

// Networks below each other, each under its number, label and comments. A network of ladder that
// has no rungs of series and parallel branches is drawn as boxes and wires. `live` may be null.
std::string draw_body(const network::Body& body, std::string_view title, const Live* live);

// `sources` holds the texts of the conditions.
std::string draw_chart(const Tree& tree, const base::SourceMap& sources, const Chart& chart,
                       std::string_view title, const Live* live);

// Paths of the variables that a live picture shows, seen from the POU.
std::vector<std::string> variables(const network::Body& body);
std::vector<std::string> variables(const Tree& tree, const base::SourceMap& sources,
                                   const Chart& chart);

}  // namespace frontend::draw
