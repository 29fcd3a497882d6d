#include "frontend/lex/directions.h"

#include "base/visible_text.h"

namespace frontend {
namespace {

constexpr uint32_t kFirstEmbedding = 0x202a;
constexpr char kLeadByte = '\xe2';
constexpr uint32_t kBytes = 3;

bool turns(uint32_t code) { return code >= kFirstEmbedding; }

}  // namespace

void warn_of_directions(std::string_view text, uint32_t begin, base::Diagnostics& diagnostics) {
  for (size_t at = text.find(kLeadByte); at != text.npos; at = text.find(kLeadByte, at + 1)) {
    const uint32_t code = base::direction_control(text.substr(at));
    if (!turns(code)) continue;
    const uint32_t place = begin + static_cast<uint32_t>(at);
    diagnostics.add(base::DiagnosticCode::kTurnedText, {{place}, {place + kBytes}},
                    base::code_point_text(code) + " turns the direction of what follows",
                    "remove it: what is shown is not what is compiled");
    at = text.find('\n', at);
    if (at == text.npos) return;
  }
}

}  // namespace frontend
