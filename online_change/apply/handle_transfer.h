// References of live data follow a change: after the last pass of a Transfer each one gets the
// handle that names, in the new version, what it named in the old one; NULL when that is gone
// (diff/place_moves.h). All memory is allocated beforehand; where nothing that can be referred to
// moves or goes, on the way there or back, no reference is looked at.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "online_change/apply/transfer.h"
#include "online_change/diff/place_moves.h"

namespace online_change {

class HandleTransfer {
 public:
  HandleTransfer(const ir::Image& old_image, const ir::Image& new_image);
  // Between versions with the same data.
  explicit HandleTransfer(const ir::Image& both) : old_(both) {}

  // Calls visit(place of the reference in the old version's memory, its type) for each one that
  // lives on while what it names does not.
  void for_each_broken(const uint8_t* memory,
                       const std::function<void(uint32_t at, ir::TypeId type)>& visit) const;
  // Memory is in the new version's layout. nullopt: done. Otherwise restored; the place of the
  // first reference whose target is gone, or kInterrupted.
  std::optional<uint32_t> forward(uint8_t* memory, bool allow_loss, const Interrupted& interrupted);
  // Takes back what forward() did.
  void restore_forward(uint8_t* memory) const;
  // Before the way back reads: references get the old version's handles, those that nobody wrote
  // since forward() exactly the ones that they had. False: interrupted and restored.
  bool back(uint8_t* memory, const Interrupted& interrupted);
  // Takes back what back() did.
  void restore(uint8_t* memory) const;

  static constexpr uint32_t kInterrupted = 0xffffffffu;

 private:
  struct Reference {
    uint32_t at = 0;
    Target there;         // for moves_
    Target back;          // for moves_back_
    uint64_t before = 0;  // the handle that it had
    uint64_t after = 0;   // what forward() made of it; 0 both: untouched
    uint64_t saved = 0;   // by back()
  };

  const ir::Image& old_;
  PlaceMoves moves_;
  PlaceMoves moves_back_;
  std::vector<Reference> references_;  // of the new version
};

}  // namespace online_change
