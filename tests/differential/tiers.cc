#include "tests/differential/tiers.h"

#include <string_view>

#include "ir/opt/optimise.h"
#include "tests/differential/compiled.h"
#include "tests/differential/random.h"
#include "tests/golden/runner/engine.h"

namespace differential {
namespace {

struct Run {
  std::vector<std::string> states;
  std::string trap;
};

base::Result<Run> run_on(golden::Tier tier, const golden::Program& program, int scans) {
  auto engine = golden::make_engine(tier, program);
  if (!engine.ok()) return engine.error();
  Run out;
  for (int i = 0; i < scans && out.trap.empty(); ++i) {
    base::Result<std::string> trap = (*engine)->scan();
    if (!trap.ok()) return trap.error();
    out.trap = *trap;
    out.states.push_back((*engine)->state());
  }
  return out;
}

std::string_view next_line(std::string_view& rest) {
  size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
  return line;
}

void compare(const Run& oracle, const Run& other, const std::string& tier, Finding& out) {
  for (size_t i = 0; i < oracle.states.size() && i < other.states.size(); ++i) {
    if (oracle.states[i] == other.states[i]) continue;
    out = first_difference(oracle.states[i], other.states[i]);
    out.failed = true;
    out.key = "state " + tier;
    out.scan = i + 1;
    out.text = tier + ", scan " + std::to_string(i + 1) + ": " + out.text;
    return;
  }
  if (oracle.trap == other.trap && oracle.states.size() == other.states.size()) return;
  out.failed = true;
  out.key = "trap " + tier;
  out.text = tier + ": trap `" + oracle.trap + "` | `" + other.trap + "`";
}

// "1:2: error[E3001]: text" -> "E3001"; otherwise the refusal's own code.
std::string code_of(const std::string& text) {
  size_t at = text.find("error[");
  return at == std::string::npos ? text.substr(0, 5) : text.substr(at + 6, 5);
}

}  // namespace

Finding failure(std::string key, std::string text) {
  Finding out;
  out.failed = true;
  out.key = std::move(key);
  out.text = std::move(text);
  return out;
}

Finding skipped() {
  Finding out;
  out.key = "skipped";
  return out;
}

Finding first_difference(const std::string& oracle, const std::string& other) {
  Finding out;
  std::string_view left = oracle;
  std::string_view right = other;
  while (!left.empty() || !right.empty()) {
    std::string_view l = next_line(left);
    std::string_view r = next_line(right);
    if (l == r) continue;
    out.expected = l;
    out.text = std::string(l) + " | " + std::string(r);
    break;
  }
  return out;
}

std::string random_passes(uint64_t seed) {
  Random random(seed ^ 0x0b71);
  const uint32_t kind = random.below(8);
  const uint32_t bits = static_cast<uint32_t>(random.next());
  return kind < 4 ? "all" : kind == 4 ? "none" : ir::PassSet::from_bits(bits).text();
}

Finding examine(const std::string& source, int scans, const Build& build) {
  Finding out;
  base::Result<golden::Program> program = compiled(source, build);
  if (!program.ok()) {
    const std::string text = base::to_string(program.error());
    return failure("compile " + code_of(text), text);
  }
  Run oracle;
  for (golden::Tier tier : golden::kTiers) {
    base::Result<Run> run = run_on(tier, *program, scans);
    if (!run.ok()) {
      const std::string text =
          std::string(golden::tier_name(tier)) + ": " + base::to_string(run.error());
      return failure(std::string("refused ") + golden::tier_name(tier) + code_of(text), text);
    }
    if (tier == golden::Tier::kEvaluator) {
      oracle = std::move(*run);
      out.trap = oracle.trap;
      if (!out.trap.empty()) out.scan = oracle.states.size();
    } else {
      compare(oracle, *run, golden::tier_name(tier), out);
      if (out.failed) return out;
    }
  }
  return out;
}

}  // namespace differential
