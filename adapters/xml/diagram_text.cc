#include "adapters/xml/diagram_text.h"

#include "frontend/network/write.h"

namespace xml {
namespace {

// One network makes the whole body FBD.
void report_as_fbd(const frontend::network::Body& body, Node drawing, Reporter& report) {
  bool found = false;
  for (uint32_t i = 0; i < body.networks.size(); ++i) {
    const std::string why = frontend::network::ladder_problem(body.networks[i]);
    if (why.empty()) continue;
    found = true;
    report.set_network(i + 1);
    report.add(Code::kLadderAsFbd, drawing, "the ladder became FBD: " + why);
  }
  report.set_network(0);
  if (!found) {
    report.add(Code::kLadderAsFbd, drawing,
               "the ladder became FBD: its labels and comments would say something else as text");
  }
}

}  // namespace

DiagramText diagram_text(const frontend::network::Body& body, Node drawing, std::string_view taken,
                         Reporter& report) {
  constexpr uint32_t kIndent = 2;
  if (auto rows = frontend::network::write_ladder(body, kIndent)) {
    return {"LADDER\n" + *rows + "END_LADDER\n", {}};
  }
  const std::string rows = frontend::network::write_fbd(body, kIndent, taken);
  const bool ladder = body.language == frontend::network::Language::kLadder;
  if (ladder) report_as_fbd(body, drawing, report);
  return {"FBD\n" + rows + "END_FBD\n", ladder ? rows : std::string()};
}

}  // namespace xml
