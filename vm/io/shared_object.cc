#include "vm/io/shared_object.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace vm {
namespace {

constexpr mode_t kOthersWrite = S_IWGRP | S_IWOTH;

std::string octal(mode_t mode) {
  char text[16];
  std::snprintf(text, sizeof text, "%04o", static_cast<unsigned>(mode & 07777));
  return text;
}

}  // namespace

SharedObject::SharedObject(std::string name, size_t size, mode_t mode)
    : name_(std::move(name)), size_(size), mode_(mode) {}

base::Error SharedObject::failed(const std::string& what) const {
  return {base::Refusal::kDeviceFailed, "shared memory " + name_ + ": " + what};
}

base::Error SharedObject::call_failed(const char* call) const {
  return failed(std::string(call) + ": " + std::strerror(errno));
}

base::Status SharedObject::open() {
  base::Status done = make_or_take();
  if (done.ok()) done = make_room();
  if (done.ok()) done = check();
  if (!done.ok()) close();
  return done;
}

// Only what is made here gets `mode_`: the umask does not take from it, and what somebody else has
// made stays as it is and is checked.
base::Status SharedObject::make_or_take() {
  file_ = Descriptor(::shm_open(name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, 0600));
  if (file_.valid()) {
    return ::fchmod(file_.get(), mode_) == 0 ? base::Status(base::Ok{}) : call_failed("protect");
  }
  if (errno != EEXIST) return call_failed("make");
  file_ = Descriptor(::shm_open(name_.c_str(), O_RDWR | O_CLOEXEC, 0));
  return file_.valid() ? base::Status(base::Ok{}) : call_failed("open");
}

base::Status SharedObject::make_room() const {
  struct stat facts {};
  if (::fstat(file_.get(), &facts) != 0) return call_failed("look at");
  if (base::Status ours = check_owner(facts.st_uid, facts.st_mode); !ours.ok()) return ours;
  const bool small = facts.st_size < static_cast<off_t>(size_);
  if (small && ::ftruncate(file_.get(), static_cast<off_t>(size_)) != 0) {
    return call_failed("make room");
  }
  return base::Ok{};
}

base::Status SharedObject::check_owner(uid_t owner, mode_t mode) const {
  const std::string way_out = "; remove /dev/shm" + name_;
  if (!S_ISREG(mode)) return failed("is no memory" + way_out);
  if (owner != ::geteuid() && owner != 0) {
    return failed("belongs to user " + std::to_string(owner) + way_out + ", or use another name");
  }
  if ((mode & kOthersWrite & ~mode_) != 0) {
    return failed("others can write it (mode " + octal(mode) + ")" + way_out +
                  ", or permit that by `access`");
  }
  return base::Ok{};
}

base::Status SharedObject::check() const {
  struct stat facts {};
  if (::fstat(file_.get(), &facts) != 0) return call_failed("look at");
  if (facts.st_nlink == 0) return failed("was removed or replaced");
  if (facts.st_size < static_cast<off_t>(size_)) return failed("was made smaller");
  return check_owner(facts.st_uid, facts.st_mode);
}

base::Status SharedObject::read(uint64_t at, std::span<uint8_t> bytes) const {
  const ssize_t got = ::pread(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
  if (got < 0) return call_failed("read");
  return got == static_cast<ssize_t>(bytes.size()) ? base::Status(base::Ok{})
                                                   : failed("was made smaller");
}

base::Status SharedObject::write(uint64_t at, base::ByteSpan bytes) const {
  const ssize_t put = ::pwrite(file_.get(), bytes.data(), bytes.size(), static_cast<off_t>(at));
  if (put < 0) return call_failed("write");
  return put == static_cast<ssize_t>(bytes.size()) ? base::Status(base::Ok{})
                                                   : failed("has no room any more");
}

}  // namespace vm
