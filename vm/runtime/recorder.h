// Records a run: stands between a controller and its clock and devices, and hands on what the
// controller saw of them. Used by the control thread; a thread of its own writes the file. Nothing
// is allocated or locked inside a cycle, and the control thread never waits for the writer: what
// does not fit ends the recording, and the run goes on.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "vm/runtime/ports.h"
#include "vm/runtime/recording.h"
#include "vm/runtime/state_sum.h"

namespace vm {

class Recorder : public Clock, public IoPort {
 public:
  // Begins the file at `path`; kFileUnwritable.
  static base::Result<std::unique_ptr<Recorder>> create(const std::string& path, Clock& clock,
                                                        IoPort& io, const RecordedStart& start);
  Recorder(std::FILE* file, Clock& clock, IoPort& io);  // closes the file
  ~Recorder() override;

  // To a Controller instead of the clock and the devices themselves.
  int64_t now_ns() override;
  void wait_until(int64_t deadline_ns) override { clock_.wait_until(deadline_ns); }
  void consumed(uint64_t safe_points) override { clock_.consumed(safe_points); }
  void worked(int64_t expected_ns) override { clock_.worked(expected_ns); }
  base::Status prepare(const ir::VerifiedImage& version) override { return io_.prepare(version); }
  void use(const base::Digest& version) override { io_.use(version); }
  void settle() override { io_.settle(); }
  std::vector<DeviceStatus> status() const override { return io_.status(); }
  void at_boundary(const ProcessImage& image, uint8_t* memory) override;
  void take_globals(const SharedGlobals& globals, uint8_t* memory) override;
  void publish_globals(const SharedGlobals& globals, const uint8_t* memory) override {
    io_.publish_globals(globals, memory);
  }
  void receive(std::span<uint8_t> inputs) override;
  void lost_tasks(std::span<uint8_t> tasks) override;
  void send(std::span<const uint8_t> outputs) override { io_.send(outputs); }

  // Around Controller::start() (cycle 0), and around each Controller::cycle().
  void begin();
  void end(Controller& controller);
  // Around each job at a boundary. A request can take several: what it does counts as done by the
  // one that switched to another program, else by the last one.
  void begin_job(const Controller& controller);
  void end_job(const Controller& controller);
  // The jobs since the last call were of this request (protocol.h), and it was carried out.
  void note(base::ByteSpan request);
  // Forgets the jobs of a request that changed nothing.
  void forget_jobs();
  bool switched() const { return switched_; }

  // Why nothing more is recorded, while the run goes on; null: it is. Any thread.
  const char* ended_early() const { return ended_.load(std::memory_order_relaxed); }

  // Everything that was recorded is in the file; kFileUnwritable when it is not.
  base::Status close();

 private:
  void end_reception();
  void hand_over(const base::Bytes& record);
  void take_local();
  void write_to_file();

  Clock& clock_;
  IoPort& io_;
  RecordedCycle now_;
  StateSum sum_;
  void note_changes(const base::Bytes& before, const base::Bytes& after, ByteChanges& changes);

  base::Bytes inputs_;          // as seen last
  base::Bytes before_, after_;  // what others can write, around a boundary
  std::vector<int64_t> job_clock_;
  const Generation* before_job_ = nullptr;
  bool switched_ = false;
  RecordedRequest request_;  // cycle and clock of the job that counts
  bool in_cycle_ = false;
  bool in_job_ = false;
  std::atomic<const char*> ended_{nullptr};  // why it ended before the run

  base::Bytes local_;  // of the control thread, not yet handed over
  // A request's first job is done, and note() or forget_jobs() is still to come: what it did is in
  // the cycles after it, so they are not handed over before it.
  std::atomic<bool> holding_{false};

  std::mutex mutex_;  // of what follows; never held while the file is written
  std::condition_variable work_;
  base::Bytes waiting_;
  bool closing_ = false;
  bool failed_ = false;
  std::FILE* file_;
  std::thread writer_;
};

// A job at a boundary.
class RecordedJob {
 public:
  RecordedJob(Recorder& recorder, const Controller& controller)
      : recorder_(recorder), controller_(controller) {
    recorder_.begin_job(controller_);
  }
  ~RecordedJob() { recorder_.end_job(controller_); }
  RecordedJob(const RecordedJob&) = delete;
  RecordedJob& operator=(const RecordedJob&) = delete;

 private:
  Recorder& recorder_;
  const Controller& controller_;
};

}  // namespace vm
