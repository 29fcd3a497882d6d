// The one file by which an edit goes to many controllers (E-07): two whole versions of a program,
// before the edit and after. What the edit is, part by part, is what differs between them
// (ir::part_edits); what it needs on a controller with a program of its own is decided there, so
// nothing is left out here. Whoever carries it needs no sources.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "base/bytes.h"
#include "base/hash.h"
#include "base/result.h"

namespace online_change {

struct FleetFile {
  std::string author;       // who made it; may be empty
  std::string text;         // what it is for; may be empty
  bool free_table = false;  // lifts the rule of additions only (E-17; table_edits.h)
  // The parts of the edit one after the other (E-25; linker/edit_steps.h); empty: all at one
  // boundary.
  std::vector<std::string> steps;
  bool steps_if_needed = false;  // only where there is no room for all at once
  base::Bytes original;     // encoded images, without sources
  base::Bytes edited;
};

inline constexpr std::string_view kFleetMagic = "STCFLEET";
bool has_fleet_magic(base::ByteSpan bytes);

// Equal content gives equal bytes.
base::Bytes encode(const FleetFile& file);
// Each part has a checksum of its own: kBadHash names the part. Of a good form; the images are
// verified by whoever uses them. kBadFormat, kTooLarge.
base::Result<FleetFile> decode_fleet_file(base::ByteSpan bytes);
// What journals and people call it by.
base::Digest fleet_digest(base::ByteSpan bytes);

}  // namespace online_change
