// Parser, writers and pictures over arbitrary bytes: whatever diagrams and charts come out of a
// text, they can be written as text and drawn, with values and without. What follows a line
// `(* values *)` is a file of values, as `stc draw --values` takes it.
#include <cstddef>
#include <cstdint>
#include <string>

#include "base/check.h"
#include "frontend/draw/picture.h"
#include "frontend/fbd/read.h"
#include "frontend/ladder/read.h"
#include "frontend/network/same.h"
#include "frontend/network/write.h"
#include "frontend/parse/parse.h"
#include "tools/stc/live_values.h"

namespace {

using namespace frontend;

void check_text(const network::Body& body) {
  std::optional<std::string> ladder = network::write_ladder(body, 2);
  if (ladder) {
    base::Diagnostics diagnostics;
    network::Body again = ladder::read(*ladder, base::SourcePos{0}, diagnostics);
    base::check(network::write_ladder(again, 2) == ladder, "written again, ladder is the same");
  }
  base::Diagnostics diagnostics;
  fbd::read(network::write_fbd(body, 2), base::SourcePos{0}, diagnostics);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  constexpr std::string_view kValues = "(* values *)\n";
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const size_t values_at = text.find(kValues);
  base::SourceMap sources;
  sources.add("fuzz.st", std::string(text.substr(0, values_at)));
  base::Diagnostics diagnostics;
  Tree tree;
  parse(sources, 0, tree, diagnostics);
  draw::Live live("p");
  for (const char* name : {"a", "b", "Start", "S1.X", "t.Q"}) live.set(name, "TRUE");
  if (values_at != text.npos) stc::set_values(text.substr(values_at + kValues.size()), live);
  for (const network::Body& body : tree.diagrams) {
    check_text(body);
    for (const draw::Live* values :
         {static_cast<const draw::Live*>(nullptr), static_cast<const draw::Live*>(&live)}) {
      draw::Notes notes;
      for (const network::Network& each : body.networks) {
        for (const network::Element& one : each.elements) {
          notes.set(one.operand.text, {"%QX0.0", one.operand.text});
        }
      }
      const double width = values != nullptr ? 0 : 100;  // every column in a strip of its own
      std::string svg = draw::draw_body(body, "fuzz", {values, &notes, width});
      base::check(svg.ends_with("</svg>\n"), "a whole picture");
    }
    draw::variables(body);
  }
  for (const Chart& chart : tree.charts) {
    base::check(draw::draw_chart(tree, sources, chart, "fuzz", nullptr).ends_with("</svg>\n"),
                "a whole picture");
    draw::draw_chart(tree, sources, chart, "fuzz", &live);
    draw::variables(tree, sources, chart);
  }
  return 0;
}
