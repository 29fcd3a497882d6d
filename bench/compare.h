// Scan times of programs: an image on stvm, on each tier that it has, against the same
// program in C inside this process. All of it runs on one core, in turn.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace bench {

// What stvm can run programs with. `goal`: the geometric mean of the ratios that is aimed at.
struct Tier {
  const char* name;  // as `stvm bench --tier` calls it
  double goal;
  bool against_peers;  // on each program, at least as fast as compiled peers is aimed at, too
};
inline constexpr Tier kTiers[] = {
    {"interp", 8.0, false},
    {"native", 1.25, true},
};
inline constexpr size_t kTierCount = sizeof kTiers / sizeof kTiers[0];

struct Program {
  const char* name;
  const char* source;  // the PROGRAM in its image
  const char* group;
  uint32_t scans;
  double peers;  // ratio of the better compiled peer, 0 where none was measured (programs.def)
  void (*scan)(int64_t now_ns);
  uint32_t (*checksum)();
};
const std::vector<Program>& programs();

struct TierResult {
  bool ran = false;
  double ns = 0;
  double ratio = 0;  // to C
};
struct Result {
  const Program* program = nullptr;
  double c_ns = 0;
  TierResult tiers[kTierCount];
  bool same_state = false;
};

struct CompareOptions {
  std::string stvm;
  std::string images;  // folder of NAME.image
  std::string tier = "all";
  uint32_t repeats = 7;
};

// Names of the programs whose images are not in that folder.
std::vector<std::string> missing_images(const CompareOptions& options,
                                        const std::vector<Program>& programs);

// The tiers that are asked for and that this stvm has, by index of kTiers; one line on
// standard output for each that it has not. Asks with the image of `program`.
std::vector<size_t> present_tiers(const CompareOptions& options, const Program& program);

// First both sides run some scans from power-up and must have the same checksum of their
// state, or it would not be the same work. Then `repeats` measurements of each side in turn;
// a figure is their median. With no repeats, only the state is compared.
Result compare(const CompareOptions& options, const std::vector<size_t>& tiers,
               const Program& program);

// Over the programs of one group ("" for all) that ran on the tier; 0 when there is none.
double geometric_mean(const std::vector<Result>& results, size_t tier, const std::string& group);

}  // namespace bench
