// "Did you mean": of the names that are known, the one that is nearest to what was written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace base {

// Names further away than a third of the letters of `written` are no help.
uint32_t farthest_name(std::string_view written);
// Keeps `candidate` as `best` when it is nearer to `written` than `distance`, or as near and first
// by its letters. `compared` is the part of the candidate that counts; case does not. Only the
// first 64 bytes of what was written do.
void keep_nearest(std::string_view written, std::string_view compared, std::string_view candidate,
                  std::string& best, uint32_t& distance);

class NearestName {
 public:
  explicit NearestName(std::string_view written)
      : written_(written), distance_(farthest_name(written)) {}
  void offer(std::string_view candidate) {
    keep_nearest(written_, candidate, candidate, best_, distance_);
  }
  const std::string& best() const { return best_; }  // "": none is near
  // "; did you mean `X`?" after a message, or "".
  std::string question() const { return best_.empty() ? "" : "; did you mean `" + best_ + "`?"; }

 private:
  std::string written_;
  std::string best_;
  uint32_t distance_;
};

}  // namespace base
