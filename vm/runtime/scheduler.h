// The control cycle: I/O refresh, release of due tasks, execution by priority with suspension at
// safe points (B1, D6). Tasks are activations on one stack of one thread, so nothing is locked.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "vm/runtime/task_board.h"
#include "vm/runtime/task_tables.h"

namespace vm {

class Scheduler {
 public:
  Scheduler(const ControllerOptions& options, Clock& clock, IoPort& io);

  // At cold start, before the first cycle: the tasks that run once (ir::Task), to their end.
  void run_start_tasks();
  // After a switch: the next cycle begins with them.
  void start_in_next_cycle(bool anew) {
    start_anew_ = anew || starts_anew();
    start_pending_ = true;
  }
  bool start_pending() const { return start_pending_; }
  bool starts_anew() const { return start_pending_ && start_anew_; }  // after a restart
  // At a boundary: them, for instances that leave. A trap, or more than `limit_ns`, ends them, and
  // nothing else: false.
  bool run_exits(int64_t limit_ns);
  // Runs inits of instances that are new, at the time of the next cycle. A trap, or more than a
  // base period, ends them: false.
  bool run_inits();
  // At a boundary, also after a fault: every task runs again, in its phase; none has missed a
  // release until then.
  void restart();
  // All of them, and they are sent. `for_good`: holds for a time are over at once.
  void make_outputs_safe(bool for_good);
  // Other forces hold than `before`, at once: what a stopped task no longer has forced becomes
  // safe.
  void forces_exchanged(const ForcedSet& before);
  // Variables that are sent as these were written from outside.
  void outputs_set(std::span<const WriteSet::OutputBits> outputs);
  void outputs_put_back() { outputs_stale_ = true; }  // all of them
  // What is complete.
  void send_outputs();
  // After a fault: only outputs that are held for a time are looked after. Where a task starts
  // again at once and nothing else is inside a scan, it returns at this boundary in the middle of
  // the cycle, and the next call goes on: a task that is always late would leave no other one.
  void run_cycle();
  bool at_boundary() const { return active_.empty(); }
  bool faulted() const { return faulted_; }
  // Nothing runs before restart(); outputs are safe.
  void fault();
  uint64_t cycles() const { return cycles_; }
  int64_t cycle_start_ns() const { return cycle_start_ns_; }
  // When run_cycle() has something to do again: idle time ends there.
  int64_t next_cycle_ns() const { return paused_ ? looked_ns_ : next_cycle_ns_; }
  const Traps& traps() const { return traps_; }
  uint64_t trap_count() const { return trap_count_; }
  const TaskBoard& board() const { return board_; }  // for any thread

  // At a boundary: these tables and that data from now on. They must live as long as they are used.
  void use(TaskTables& tables, uint8_t* memory);
  // Controller::run_idle.
  void run_idle(const std::function<bool()>& unit);
  // Controller::worked.
  void worked(int64_t expected_ns) { clock_.worked(expected_ns); }
  TaskTables& tables() { return *tables_; }
  const TaskTables& tables() const { return *tables_; }

 private:
  enum class Look : uint8_t { kGoOn, kCycleOver };

  void begin_cycle();
  void send();
  void receive();
  void exchange();
  bool due_is_running() const;
  void finish_start_tasks();
  bool try_start_tasks(int64_t limit_ns);
  void pack_outputs();
  void pack_stale_outputs();
  void take_packed();
  void take_waiting_outputs();
  void take_sendable_outputs();
  void transmit();
  void take_outputs(TaskSlot& task);
  // B12: of one task.
  void receive_for(TaskSlot& task);
  void send_of(TaskSlot& task);
  void offer_inputs();
  void release_due_tasks();
  void release_due_task(TaskSlot& task);
  bool release(TaskSlot& task, int64_t due_ns);
  void start_again(TaskSlot& task);
  bool lengthens_cycle();
  void pause();
  void end_cycle();
  bool is_active(const TaskSlot& task) const;
  // Edges of events (ir::Task) release their tasks.
  void look_at_events();
  void look_at_losses();
  bool event_level(const TaskSlot& task) const;
  TaskSlot* next_released();
  // The activation that has the processor now: a newly begun one or the topmost; nullptr when idle.
  TaskSlot* choose();
  void begin_task(TaskSlot& task);
  void begin_program(TaskSlot& task);
  void run_slice(TaskSlot& task);
  void let_last(TaskSlot& task);
  bool is_too_long(const TaskSlot& task) const;
  void end_program(TaskSlot& task);
  void end_task(TaskSlot& task);
  void note_trap(const TaskSlot& task, const Trap& trap);
  void note_overrun(TaskSlot& task);
  void trap_in(TaskSlot& task, const Trap& trap);
  void find_written(const TaskSlot& task);
  void hand_down(std::span<const uint8_t> mask);
  void roll_back_outputs(const TaskSlot& task);
  void stop_outputs(TaskSlot& task);
  void leave(TaskSlot& task);
  // States for people (scheduler_states.cc).
  void show(const TaskSlot& task);
  void become(TaskSlot& task, TaskState state);
  void rest(TaskSlot& task);
  void rest_all();
  void note_begun(TaskSlot& task);
  void resume(TaskSlot& task);
  void note(Moment moment, int64_t at_ns) const;
  void note(Moment moment, const TaskSlot& task, int64_t at_ns) const;
  void note_sent();
  void refresh_safe_outputs();
  bool end_holds(int64_t now_ns);
  void outputs_to_variables(std::span<const uint8_t> mask);

  void copy_inputs(const TaskSlot& task);
  void copy_outputs(TaskSlot& task);
  void impose(bool inputs_only);
  bool impose_on_outputs();
  void impose_at_boundary();
  uint64_t fuel_left(const TaskSlot& task) const;

  ControllerOptions options_;
  Clock& clock_;
  IoPort& io_;
  uint8_t* memory_ = nullptr;
  TaskTables* tables_ = nullptr;
  std::vector<TaskSlot*> active_;  // suspended ones, the running one last
  Traps traps_;
  std::shared_ptr<const TrapRecord> without_text_;
  uint64_t trap_count_ = 0;
  uint64_t cycles_ = 0;
  int64_t cycle_start_ns_ = 0;
  int64_t next_cycle_ns_ = 0;
  int64_t looked_ns_ = 0;       // when the clock was read last
  int64_t received_ns_ = 0;     // when inputs were
  bool outputs_stale_ = false;  // new tables: pack before the next refresh
  bool starting_ = false;
  bool send_pending_ = false;     // in this cycle, after what is due (ir::Schedule)
  bool receive_pending_ = false;  // then
  bool received_ahead_ = false;   // by the cycle before, for what is due in the next one
  bool receive_now_ = false;      // a version that came in a pause has no inputs yet
  bool start_pending_ = false;
  bool start_anew_ = false;
  bool again_ = false;       // the task that has just ended starts at once again
  bool paused_ = false;      // at a boundary in the middle of a cycle
  bool lengthened_ = false;  // this cycle, for a task that was late
  bool trying_ = false;      // inside try_start_tasks()
  int64_t try_limit_ns_ = 0;
  bool try_failed_ = false;
  bool faulted_ = false;
  TaskBoard board_;
};

}  // namespace vm
