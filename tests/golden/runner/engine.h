// What runs a program under test. Every tier and every hard mode must give the
// same states and traps (docs/TESTING.md).
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/result.h"
#include "tests/golden/runner/compile.h"

namespace golden {

enum class Tier : uint8_t {
  kEvaluator,
  kInterpreter,
  kUnfused,   // as kInterpreter, one instruction at a time
  kFuelOne,   // suspended at every safe point
  kIdentity,  // an identity change after every scan
  kMoveAll,   // every instance moved after every scan
  kStandby,   // as kIdentity, and the script's changes too, by the standby strategy
  kNative,
  kNativeFuelOne,
  kFewRegisters,  // native with as few registers as it can do with; a slice has fuel for 7
  kSpills,        // native; registers are taken at random, some POUs interpreted; fuel for 23
  kAlternating,   // as kIdentity; every other generation is interpreted
  kBeside,        // machine code takes its place in the third cycle; suspended at every safe point
};
inline constexpr Tier kTiers[] = {
    Tier::kEvaluator, Tier::kInterpreter, Tier::kUnfused, Tier::kFuelOne,       Tier::kIdentity,
    Tier::kMoveAll,   Tier::kStandby,     Tier::kNative,  Tier::kNativeFuelOne, Tier::kFewRegisters,
    Tier::kSpills,    Tier::kAlternating, Tier::kBeside};
const char* tier_name(Tier tier);

class Engine {
 public:
  virtual ~Engine() = default;
  // One control cycle. A trap is returned as text, "" without one.
  virtual base::Result<std::string> scan() = 0;
  // "path=value" lines of every variable.
  virtual std::string state() const = 0;
  virtual base::Status set(const std::string& path, const std::string& value) = 0;
  virtual base::Status force(const std::string& path, const std::string& value);
  virtual base::Status unforce(const std::string& path);
  // "path everywhere", or why it holds at the boundaries of cycles only.
  virtual std::vector<std::string> forces() const { return {}; }
  enum class Restart : uint8_t { kCold, kWarm, kHot };
  virtual base::Status restart(Restart kind) = 0;
  // Online change; the lines of its report.
  virtual base::Result<std::vector<std::string>> change(const Program& next, bool allow_loss);
  virtual base::Result<std::vector<std::string>> undo(bool allow_loss);
  virtual base::Status accept();
  // Releases that found their task still running or were passed by, and such that a change or an
  // undo has delayed.
  virtual uint64_t missed() const { return 0; }
};

base::Result<std::unique_ptr<Engine>> make_engine(Tier tier, const Program& program);

}  // namespace golden
