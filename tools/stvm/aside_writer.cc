#include "tools/stvm/aside_writer.h"

#include <utility>

#include "base/memory_limit.h"

namespace stvm {

void AsideWriter::start(std::shared_ptr<const base::Bytes> image) {
  wait();
  image_ = std::move(image);
  pthread_t thread;
  if (::pthread_create(&thread, nullptr, enter, this) != 0) return image_.reset();
  thread_ = thread;
}

void AsideWriter::wait() {
  if (thread_) ::pthread_join(*thread_, nullptr);
  thread_.reset();
  image_.reset();
}

void* AsideWriter::enter(void* writer) {
  const auto& own = *static_cast<const AsideWriter*>(writer);
  base::within_memory([&] { return own.store_.lay_aside(own.image_), true; }, [] { return false; });
  return nullptr;
}

}  // namespace stvm
