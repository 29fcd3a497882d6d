#include "vm/runtime/recorder.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <chrono>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/limits.h"
#include "vm/runtime/descriptor.h"
#include "vm/runtime/process_image.h"
#include "vm/runtime/shared_globals.h"

namespace vm {
namespace {

constexpr size_t kMaxReads = 1u << 16;            // of the clock in one cycle
constexpr size_t kMaxChanged = 1u << 16;          // input bytes in one cycle
constexpr size_t kMaxReceptions = 1u << 12;       // in one cycle
constexpr size_t kMaxLost = 1u << 12;             // tasks in one cycle, each as often as it was
constexpr size_t kMaxWaiting = size_t{64} << 20;  // bytes that the disk is behind

constexpr const char* kTooMuch = "one cycle saw too much";
constexpr const char* kTooSlow = "the disk was too slow";
constexpr const char* kDiskFailed = "the disk failed";
constexpr const char* kFull = "the file reached 1 GiB";

}  // namespace

base::Result<std::unique_ptr<Recorder>> Recorder::create(const std::string& path, Clock& clock,
                                                         IoPort& io, const RecordedStart& start) {
  // For its owner only: it has all that the program knows of the plant.
  Descriptor opened(::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600));
  const int fd = opened.get();
  struct stat info {};
  const bool plain = opened.valid() && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode);
  // What is there is lost only when nothing is left that can be refused.
  const bool kept =
      opened.valid() && (!plain || (::fchmod(fd, 0600) == 0 && ::ftruncate(fd, 0) == 0));
  std::FILE* file = kept ? ::fdopen(fd, "wb") : nullptr;
  if (file == nullptr) {
    return base::Error{base::Refusal::kFileUnwritable, path + ": " + std::strerror(errno)};
  }
  (void)opened.release();
  auto recorder = std::make_unique<Recorder>(file, clock, io);
  recorder->hand_over(encode_record(start));
  return recorder;
}

Recorder::Recorder(std::FILE* file, Clock& clock, IoPort& io)
    : clock_(clock), io_(io), file_(file), writer_([this] { write_to_file(); }) {
  now_.observed.clock.reserve(kMaxReads);
  now_.observed.changed.reserve(kMaxChanged);
  now_.observed.lost.reserve(kMaxLost);
  now_.observed.receptions.reserve(kMaxReceptions);
  job_clock_.reserve(kMaxReads);
  request_.clock.reserve(kMaxReads);
}

Recorder::~Recorder() {
  [[maybe_unused]] const base::Status closed = close();  // whoever wants to know has closed it
}

int64_t Recorder::now_ns() {
  const int64_t now = clock_.now_ns();
  std::vector<int64_t>* reads = in_job_ ? &job_clock_ : in_cycle_ ? &now_.observed.clock : nullptr;
  if (reads == nullptr) return now;
  if (reads->size() < kMaxReads) {
    reads->push_back(now);
  } else {
    ended_ = kTooMuch;
  }
  return now;
}

void Recorder::receive(std::span<uint8_t> inputs) {
  io_.receive(inputs);
  if (inputs_.size() < inputs.size()) inputs_.resize(inputs.size());  // a change made them more
  for (uint32_t i = 0; i < inputs.size(); ++i) {
    if (inputs_[i] == inputs[i]) continue;
    inputs_[i] = inputs[i];
    if (now_.observed.changed.size() < kMaxChanged) {
      now_.observed.changed.push_back({i, inputs[i]});
    } else {
      ended_ = kTooMuch;
    }
  }
  end_reception();
}

void Recorder::lost_tasks(std::span<uint8_t> tasks) {
  io_.lost_tasks(tasks);
  for (uint32_t i = 0; i < tasks.size(); ++i) {
    if (tasks[i] == 0) continue;
    if (now_.observed.lost.size() < kMaxLost) {
      now_.observed.lost.push_back({i, tasks[i]});
    } else {
      ended_ = kTooMuch;
    }
  }
  if (now_.observed.receptions.empty()) return;
  now_.observed.receptions.back().lost = static_cast<uint32_t>(now_.observed.lost.size());
}

void Recorder::end_reception() {
  Observed& seen = now_.observed;
  if (seen.receptions.size() < kMaxReceptions) {
    seen.receptions.push_back(
        {static_cast<uint32_t>(seen.changed.size()), static_cast<uint32_t>(seen.lost.size())});
  } else {
    ended_ = kTooMuch;
  }
}

void Recorder::note_changes(const base::Bytes& before, const base::Bytes& after,
                            ByteChanges& changes) {
  for (uint32_t i = 0; i < after.size(); ++i) {
    if (before[i] == after[i]) continue;
    if (changes.size() < kMaxChanged) {
      changes.push_back({i, after[i]});
    } else {
      ended_ = kTooMuch;
    }
  }
}

void Recorder::at_boundary(const ProcessImage& image, uint8_t* memory) {
  const size_t outputs = image.output_bytes();
  const size_t markers = image.marker_bytes();
  const auto take = [&](base::Bytes& bytes) {
    bytes.assign(outputs + markers, 0);
    image.variables_to_outputs(memory, std::span(bytes).first(outputs));
    image.variables_to_markers(memory, std::span(bytes).subspan(outputs));
  };
  take(before_);
  io_.at_boundary(image, memory);
  take(after_);
  if (before_ == after_) return;
  const auto part = [](const base::Bytes& bytes, size_t begin, size_t size) {
    const auto first = bytes.begin() + static_cast<std::ptrdiff_t>(begin);
    return base::Bytes(first, first + static_cast<std::ptrdiff_t>(size));
  };
  note_changes(part(before_, 0, outputs), part(after_, 0, outputs), now_.observed.outputs);
  note_changes(part(before_, outputs, markers), part(after_, outputs, markers),
               now_.observed.markers);
}

void Recorder::take_globals(const SharedGlobals& globals, uint8_t* memory) {
  before_.resize(globals.read_bytes());
  after_.resize(globals.read_bytes());
  globals.gather_read(memory, before_);
  io_.take_globals(globals, memory);
  globals.gather_read(memory, after_);
  if (before_ != after_) note_changes(before_, after_, now_.observed.globals);
}

void Recorder::begin() { in_cycle_ = true; }

void Recorder::end(Controller& controller) {
  in_cycle_ = false;
  now_.state = sum_.of(controller);
  if (ended_early() == nullptr) hand_over(encode_record(now_));
  ++now_.number;
  now_.observed.clock.clear();
  now_.observed.receptions.clear();
  now_.observed.changed.clear();
  now_.observed.outputs.clear();
  now_.observed.markers.clear();
  now_.observed.globals.clear();
  now_.observed.lost.clear();
}

void Recorder::begin_job(const Controller& controller) {
  in_job_ = true;
  job_clock_.clear();
  before_job_ = &controller.generation();
}

void Recorder::end_job(const Controller& controller) {
  in_job_ = false;
  holding_ = true;
  if (switched_) return;
  switched_ = before_job_ != &controller.generation();
  request_.cycle = now_.number - 1;  // of the last one that ended
  request_.clock.swap(job_clock_);
}

void Recorder::note(base::ByteSpan request) {
  switched_ = false;
  request_.bytes.assign(request.begin(), request.end());
  const base::Bytes record = ended_early() != nullptr ? base::Bytes() : encode_record(request_);
  const std::lock_guard lock(mutex_);
  waiting_.insert(waiting_.end(), record.begin(), record.end());
  holding_ = false;
  work_.notify_one();
}

void Recorder::forget_jobs() {
  switched_ = false;
  holding_ = false;
}

// By the control thread: never waits; what cannot be handed over now is with the next record.
void Recorder::hand_over(const base::Bytes& record) {
  local_.insert(local_.end(), record.begin(), record.end());
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (lock.owns_lock() && !holding_) take_local();
  if (local_.size() > kMaxWaiting) ended_ = kTooSlow;
}

void Recorder::take_local() {
  if (waiting_.empty()) {
    std::swap(waiting_, local_);
  } else {
    waiting_.insert(waiting_.end(), local_.begin(), local_.end());
  }
  local_.clear();
  work_.notify_one();
}

// What led to the end of a controller that dies is in the file, but for the last moment.
void Recorder::write_to_file() {
  constexpr std::chrono::milliseconds kFlush(100);
  base::Bytes batch;
  uint64_t size = 0;
  auto flushed = std::chrono::steady_clock::now() - kFlush;
  bool buffered = false;
  const auto come = [&] { return closing_ || !waiting_.empty(); };
  std::unique_lock lock(mutex_);
  while (!closing_ || !waiting_.empty()) {
    if (buffered) {
      work_.wait_until(lock, flushed + kFlush, come);
    } else {
      work_.wait(lock, come);
    }
    std::swap(batch, waiting_);
    lock.unlock();
    const bool room = size + batch.size() <= kMaxRecordingBytes;
    bool written =
        room && !failed_ && std::fwrite(batch.data(), 1, batch.size(), file_) == batch.size();
    size += batch.size();
    buffered = buffered || !batch.empty();
    batch.clear();
    if (written && buffered && std::chrono::steady_clock::now() >= flushed + kFlush) {
      written = std::fflush(file_) == 0;
      flushed = std::chrono::steady_clock::now();
      buffered = false;
    }
    if (!written && ended_early() == nullptr) ended_ = room ? kDiskFailed : kFull;
    lock.lock();
    failed_ = failed_ || !written;
    buffered = buffered && !failed_;
  }
}

base::Status Recorder::close() {
  if (file_ == nullptr) return base::Ok{};
  {
    const std::lock_guard lock(mutex_);
    if (ended_early() == nullptr) {
      const base::Bytes end = encode_end();
      local_.insert(local_.end(), end.begin(), end.end());
    }
    take_local();
    closing_ = true;
    work_.notify_one();
  }
  writer_.join();
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  const char* const why = ended_early();
  if (closed && !failed_ && why == nullptr) return base::Ok{};
  return base::Error{base::Refusal::kFileUnwritable,
                     std::string("the recording ended before the run: ") +
                         (why != nullptr ? why : kDiskFailed) + "; it can be replayed up to there"};
}

}  // namespace vm
