// stc package --watch: a change package at each save, for `stvm change --watch`, which brings it to
// a controller and answers what became of it (tools/common/followed_change.h).
#pragma once

#include <memory>

#include "ir/bytecode/image_beside.h"
#include "tools/common/followed_change.h"
#include "tools/stc/watch.h"

namespace stc {

class WatchedPackages : public WatchTarget {
 public:
  // Over `socket`. `restricted`: no edits of interfaces (D7).
  WatchedPackages(int socket, bool restricted) : socket_(socket), restricted_(restricted) {}
  // What runs; before anything else.
  base::Status begin(base::Bytes running);

  std::shared_ptr<const ir::Image> base() const override { return running_; }
  base::Result<Next> take(const ir::Image& image, const Project& project,
                          const Built& built) override;
  base::Result<Next> take(std::vector<ResourceVersion>& versions, const Project& project,
                          const Built& built) override;
  Rest rest(std::chrono::nanoseconds time, int descriptor) override;

 private:
  base::Result<Next> bring(const ir::Image& image, ir::WrittenImage made, const Built& built);
  base::Result<Next> send(const Built& built, base::Bytes package, const ir::Image& image,
                          ir::WrittenImage made);

  int socket_;
  bool restricted_;
  ir::WrittenImage written_;                  // what runs
  std::shared_ptr<const ir::Image> running_;  // the same, decoded
};

}  // namespace stc
