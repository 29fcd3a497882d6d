// Case 75: what a change makes anew at %M and %Q gets the bytes that the running version has there,
// if these would go otherwise. Works on a plan that is made by names: takes variables out of the
// steps that initialise them, and out of the rows that drop them.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "online_change/diff/address_bits.h"
#include "online_change/diff/areas.h"
#include "online_change/plan/plan.h"

namespace online_change {

class ByAddress {
 public:
  ByAddress(const ir::Image& old_image, const ir::Image& new_image, Plan& plan);
  void run();

 private:
  struct Range {  // in data memory
    uint64_t begin = 0;
    uint64_t end = 0;
  };
  void find_ranges();
  static bool meets(const std::vector<Range>& sorted, uint64_t begin, uint64_t end);
  bool goes(const GatheredPart& part) const;
  bool make(const AddressedVariable& variable, const AddressBits& before);
  uint32_t row_for(const AddressedVariable& variable, const UpdateStep& step, bool whole);
  void split(size_t number, const AddressedVariable& variable, UpdateStep made);
  void keep_dropped(const std::vector<AddressedVariable>& before);
  void drop_empty_rows();

  const ir::Image& old_;
  const ir::Image& new_;
  Plan& plan_;
  Areas new_areas_;
  std::vector<Range> written_;                       // by steps
  std::vector<Range> read_;                          // by steps
  std::vector<std::pair<uint32_t, size_t>> initial_;  // steps of one value, by place
  TakenBits taken_;
  std::vector<uint32_t> emptied_;                    // rows
  std::vector<UpdateStep> more_;
};

}  // namespace online_change
