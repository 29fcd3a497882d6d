// Moves data memory from one version's state to the other's in three passes: read
// all sources into a buffer, save what will be overwritten, write. Sources and
// targets may overlap; until write() begins nothing has happened, and restore()
// takes back what write() did. All memory is allocated beforehand.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "online_change/apply/live_value.h"

namespace online_change {

// Asked before each step; true: stop here (a deadline, a test).
using Interrupted = std::function<bool()>;

struct Loss {  // of one value of a kConvert step
  uint32_t step = 0;
  uint32_t index = 0;
  const char* what = nullptr;
};

class Transfer {
 public:
  enum class Steps : uint8_t { kBoundary, kAll };
  Transfer(const Plan& plan, const ir::Image& from, const ir::Image& to, Steps which);

  // Makes every page that write() needs present, so that the operating system has nothing to do at
  // the boundary. Changes no byte.
  void touch(uint8_t* memory) const;
  // First pass. Losses are handed to `on_loss`; false from it ends the pass. False: ended early.
  bool read(const uint8_t* memory, const std::function<bool(const Loss&)>& on_loss,
            const Interrupted& interrupted);
  // On the way back, before `forward` writes: keeps what this plan will initialise or convert.
  // Memory cannot keep it: version 2 copies whole structures, with the gaps that it has in the
  // place of dropped members. False: interrupted.
  bool remember(const uint8_t* memory, const Interrupted& interrupted);
  // The way back: like read(), but what this plan initialises, and what nobody wrote since
  // `forward` converted it, is what was remembered.
  bool read_back(const uint8_t* memory, const Transfer& forward, const Interrupted& interrupted);
  bool save(const uint8_t* memory, const Interrupted& interrupted);
  // False: interrupted and restored.
  bool write(uint8_t* memory, const Interrupted& interrupted);
  void restore(uint8_t* memory) const { restore_first(memory, work_.size()); }

  const Conversions& conversions() const { return conversions_; }
  const Plan& plan() const { return plan_; }

 private:
  struct Work {
    uint32_t step = 0;
    size_t at = 0;  // in staged_ and saved_
    FastConverter fast = nullptr;
  };
  struct Target {  // one value that was written
    uint32_t to = 0;
    uint32_t size = 0;
    size_t at = 0;
    bool converted = false;
    uint64_t end() const { return uint64_t{to} + size; }
  };

  const UpdateStep& step_of(const Work& work) const { return plan_.steps[work.step]; }
  void read_values(const UpdateStep& step, const uint8_t* memory, uint8_t* out) const;
  bool read_converted(const Work& work, const uint8_t* memory,
                      const std::function<bool(const Loss&)>& on_loss);
  void read_back_converted(const Work& work, const uint8_t* memory, const Transfer& forward);
  void restore_first(uint8_t* memory, size_t count) const;
  // Does memory still hold what this transfer converted to `offset`?
  bool still_as_converted(uint32_t offset, uint32_t size, const uint8_t* memory) const;
  size_t first_target(uint32_t offset, size_t& hint) const;

  const Plan& plan_;
  Conversions conversions_;
  std::vector<Work> work_;
  std::vector<Target> targets_;  // sorted
  // Where the search before ended: offsets go upwards.
  mutable size_t converted_hint_ = 0;
  base::Bytes staged_;
  base::Bytes saved_;
  base::Bytes remembered_;  // of the way back
};

}  // namespace online_change
