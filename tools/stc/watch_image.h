// stc build --watch: an image file that follows the sources.
#pragma once

#include <memory>
#include <optional>

#include "tools/stc/file_stamp.h"
#include "tools/stc/online_base.h"
#include "tools/stc/watch.h"

namespace stc {

class WatchedImage : public WatchTarget {
 public:
  // `output`: as for image_path(). With a line for each build if wanted. `online`: what the image
  // has to be an edit of.
  WatchedImage(std::string output, bool with_line, std::shared_ptr<const ir::Image> base,
               std::optional<OnlineBase> online)
      : output_(std::move(output)),
        with_line_(with_line),
        base_(std::move(base)),
        online_(std::move(online)) {}

  std::shared_ptr<const ir::Image> base() const override { return base_; }
  void check(const ir::Image& image, const Project& project,
             base::Diagnostics& diagnostics) override;
  void check(const std::vector<ResourceVersion>& versions, const Project& project,
             base::Diagnostics& diagnostics) override;
  base::Result<Next> take(const ir::Image& image, const Project& project,
                          const Built& built) override;
  base::Result<Next> take(std::vector<ResourceVersion>& versions, const Project& project,
                          const Built& built) override;

 private:
  base::Status write(const ir::Image& image, const Project& project);
  std::string output_of(const Project& project) const;

  std::string output_;  // "": by the project's name
  bool with_line_;
  std::shared_ptr<const ir::Image> base_;
  std::optional<OnlineBase> online_;
  // What was written last, and what the file was then: it is written again when either is another.
  base::Bytes written_;
  FileStamp stamp_;
};

}  // namespace stc
