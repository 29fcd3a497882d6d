#include "tools/stc/watch_image.h"
#include "tools/common/outputs.h"

#include "tools/stc/embed.h"
#include "tools/stc/image_output.h"
#include "tools/stc/safe_settings.h"

namespace stc {

void WatchedImage::check(const ir::Image& image, const Project& project,
                         base::Diagnostics& diagnostics) {
  if (online_) online_->check(project, image, diagnostics);
}

void WatchedImage::check(const std::vector<ResourceVersion>& versions, const Project& project,
                         base::Diagnostics& diagnostics) {
  if (online_) check(online_->matching(versions).version.image, project, diagnostics);
}

base::Result<WatchTarget::Next> WatchedImage::take(const ir::Image& image, const Project& project,
                                                   const Built& built) {
  base::Status written = write(image, project);
  if (!written.ok()) return written.error();
  if (with_line_) built.print();
  return Next::kWait;
}

base::Result<WatchTarget::Next> WatchedImage::take(std::vector<ResourceVersion>& versions,
                                                   const Project& project, const Built& built) {
  base::Status written = write_images(versions, output_of(project), project, with_line_);
  if (!written.ok()) return written.error();
  if (with_line_) built.print();
  return Next::kWait;
}

base::Status WatchedImage::write(const ir::Image& image, const Project& project) {
  base::Result<Embedding> embedding = Embedding::of(project);
  if (!embedding.ok()) return embedding.error();
  ir::Image copy;
  const ir::Image& named = embedding->named(image, copy);
  base::Bytes bytes = embedding->encode(named, nullptr).bytes;
  base::Result<std::string> path = image_path(output_of(project), {}, project.name);
  if (!path.ok()) return path.error();
  base::Status free = tools::check_output(*path, project.read_files());
  if (!free.ok()) return free;
  const bool stands = stamp_.seconds != -1 && stamp_of(*path) == stamp_;
  if (stands && bytes == written_) return base::Ok{};
  base::Status written = write_image(*path, image, bytes, with_line_);
  if (!written.ok()) return written;
  written_ = std::move(bytes);
  stamp_ = stamp_of(*path);
  return written;
}

std::string WatchedImage::output_of(const Project& project) const {
  return output_.empty() ? project.name + ".img" : output_;
}

}  // namespace stc
