// stc check, stc build --online-base (E-19, E-20): what an edit of a running program may not do, as
// diagnostics with a place while somebody edits. The rules are those of the tables in
// online_change/plan (table_edits.h, online_limits.h); the controller checks them again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/diagnostics.h"
#include "base/result.h"
#include "online_change/plan/online_limits.h"
#include "tools/stc/session.h"

namespace stc {

inline constexpr tools::OptionRow kTableOption{
    "--table", "RULE",
    "restricted (default): globals and variables of programs that were there stay as they are; "
    "free: they need not",
    "restricted|free"};
inline constexpr tools::OptionRow kTargetOption{
    "--target",
    "HOST|VERSION",
    "stvm that takes the edit: its version, host or state directory; repeatable",
    "",
    "",
    tools::Times::kMany};

#define STC_ONLINE_OPTIONS                                                                 \
  {"--online-base", "ORIGINAL",                                                            \
   "say what cannot be changed online in the running program: sources, an image, a state " \
   "directory or a host"},                                                                 \
      kTargetOption, kTableOption, tools::kRestrictedOption

// The versions that --target names; "" where a host does not say it.
std::vector<std::string> target_versions(const tools::Options& options);

// The rule of additions only, where it is broken, in one text with the places in the sources.
std::string placed_table_edits(const std::vector<online_change::TableEdit>& edits,
                               const ir::Image& edited, const Project& project);

class OnlineBase {
 public:
  // Null without --online-base; kUsage when one of the other options is there alone.
  static base::Result<std::optional<OnlineBase>> of(const tools::Options& options);

  // What images are compared with, and may be linked against.
  const ir::Image& original() const { return original_.image; }
  // Adds what the rules say of an edited version; errors refuse it.
  void check(const Project& project, const ir::Image& edited, base::Diagnostics& diagnostics) const;
  // Checks a version that was linked against original(): whether a change can be planned, too.
  void check(const Project& project, const Version& edited, base::Diagnostics& diagnostics) const;
  // Among the versions of several resources, the one that original() is of.
  const ResourceVersion& matching(const std::vector<ResourceVersion>& versions) const;

 private:
  Version original_;
  bool free_table_ = false;
  bool restricted_ = false;
  online_change::ChosenLimits limits_;
};

}  // namespace stc
