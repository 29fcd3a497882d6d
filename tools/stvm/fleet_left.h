// Who is left of a run through a fleet, beside the fleet file ("x.fleet.left"), so that `stvm fleet
// continue` goes on after whatever ended the run (E-27). A list of controllers like any other; its
// first line says what is done to them, and of which file. It is written before the first visit and
// after each; when nobody is left it goes.
#pragma once

#include <string>
#include <vector>

#include "base/hash.h"
#include "tools/stvm/fleet_list.h"

namespace stvm {

class FleetLeft {
 public:
  FleetLeft(const std::string& fleet_file, const base::Digest& digest)
      : path_(fleet_file + ".left"), digest_(digest) {}

  const std::string& path() const { return path_; }
  // The table [broker] that leads to them (fleet_broker.h); before begin().
  void keep_broker(std::string table) { broker_ = std::move(table); }
  // What a run has left: its verb, and who. kNothingToUndo where there is none, or it is of
  // another file.
  base::Result<std::string> read(std::vector<FleetMember>& members) const;
  // `verb` begins on these; those that an earlier run of it has left stay.
  void begin(const std::string& verb, const std::vector<FleetMember>& members);
  // Is good: nothing is left to do there.
  void visited(const FleetMember& member, bool good);
  const std::vector<FleetMember>& members() const { return left_; }
  // Why it could not be written; "" when it could.
  const std::string& complaint() const { return complaint_; }

 private:
  void write();

  std::string path_;
  base::Digest digest_;
  std::string verb_;
  std::vector<FleetMember> left_;
  std::string complaint_;
  std::string broker_;
};

}  // namespace stvm
