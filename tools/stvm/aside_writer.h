// Writes an image to the store on a thread of its own, beside its verification. Where no thread can
// be had nothing is written: begin_trial() does it then.
#pragma once

#include <pthread.h>

#include <memory>
#include <optional>

#include "online_change/store/store.h"

namespace stvm {

// One thread at a time calls it. The storage must allow that threads use different files at once.
class AsideWriter {
 public:
  explicit AsideWriter(online_change::Store& store) : store_(store) {}
  ~AsideWriter() { wait(); }
  AsideWriter(const AsideWriter&) = delete;
  AsideWriter& operator=(const AsideWriter&) = delete;

  // Waits for the one before.
  void start(std::shared_ptr<const base::Bytes> image);
  // After it nothing is written.
  void wait();

 private:
  static void* enter(void* writer);

  online_change::Store& store_;
  std::shared_ptr<const base::Bytes> image_;  // until wait()
  std::optional<pthread_t> thread_;  // a POSIX one: that none can be had is an answer there
};

}  // namespace stvm
