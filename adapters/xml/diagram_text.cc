#include "adapters/xml/diagram_text.h"

#include "frontend/network/write.h"

namespace xml {
namespace {

// One network makes the whole body FBD.
void say_why(const frontend::network::Body& body, const AsFbd& as_fbd) {
  bool found = false;
  for (uint32_t i = 0; i < body.networks.size(); ++i) {
    const std::string why = frontend::network::ladder_problem(body.networks[i]);
    if (why.empty()) continue;
    found = true;
    as_fbd(i + 1, "the ladder became FBD: " + why);
  }
  if (!found) {
    as_fbd(0, "the ladder became FBD: its labels and comments would say something else as text");
  }
}

}  // namespace

DiagramText diagram_text(const frontend::network::Body& body, std::string_view taken,
                         const AsFbd& as_fbd) {
  constexpr uint32_t kIndent = 2;
  if (auto rows = frontend::network::write_ladder(body, kIndent)) {
    return {"LADDER\n" + *rows + "END_LADDER\n", {}};
  }
  const std::string rows = frontend::network::write_fbd(body, kIndent, taken);
  const bool ladder = body.language == frontend::network::Language::kLadder;
  if (ladder) say_why(body, as_fbd);
  return {"FBD\n" + rows + "END_FBD\n", ladder ? rows : std::string()};
}

}  // namespace xml
