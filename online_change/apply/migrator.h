// Runs the migrations of a plan (diff/migrations.h) on live values. The functions run in a memory
// of their own, which has nothing but their frames and constants: whatever they do, nothing that
// lives is touched. A trap, or a run that does not end in time, is an error and changes nothing.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "online_change/apply/live_value.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"

namespace online_change {

// Safe points (loops and calls) of one call, and of all calls of one run.
inline constexpr uint64_t kMigrationFuel = 200'000;
inline constexpr uint64_t kMigrationsFuel = 5'000'000;

class Migrator {
 public:
  // Fills GivenValue::made in the plan's steps, so the plan outlives it, and so do the
  // images and the generation, which is the new version's on the way back, too. Reserves memory,
  // and so is not for a boundary. Null when there is nothing to migrate.
  static base::Result<std::unique_ptr<Migrator>> make(Plan& plan, const ir::Image& from,
                                                      const ir::Image& to,
                                                      const vm::Generation& code);

  // Takes the inputs of call `first`, and of those after it that make up about `most_bytes` with
  // it, so that a large plan can be looked at over several boundaries. What one call reads is
  // always of one instant. Returns the first call that was not looked at.
  size_t gather(size_t first, size_t most_bytes, const uint8_t* memory);
  size_t calls() const { return calls_.size(); }
  // Runs each call whose inputs, as gathered, are not those of its last run. The first that fails
  // ends it, unless there is `failed` to tell: then what that call would have made is empty.
  using Failed = std::function<void(const base::Error& error)>;
  base::Status run_gathered(const Failed& failed = {});
  // Both, of all calls.
  base::Status run(const uint8_t* memory);
  // Takes the inputs as those of a run without running: on the way back, what nobody has written
  // since needs no migration.
  void note(const uint8_t* memory);
  // Runs migrations by `code`, which is the same version, made anew.
  void run_by(const vm::Generation& code);
  // The fuel of the longest run so far, for predictions, and of the last one.
  uint64_t fuel_used() const { return most_fuel_; }
  uint64_t last_fuel() const { return fuel_; }

  // For make().
  Migrator(Plan& plan, const ir::Image& from, const ir::Image& to, const vm::Generation& code,
           vm::Memory scratch);

 private:
  struct Output {
    uint32_t step = 0;  // of the plan
    uint32_t at = 0;    // in the frame
  };
  struct Input {
    uint32_t from = 0;  // in the memory that is read
    uint32_t size = 0;
    uint32_t slot = 0;  // in the frame
    uint32_t slot_size = 0;
    bool converts = false;
    ConvertedValues conversion;
  };
  struct Call {
    size_t first_byte = 0;  // of its inputs, in bytes_
    std::vector<Input> inputs;
    bool done = false;  // run on the inputs in bytes_, or noted
    std::vector<Output> outputs;
  };

  const ir::LinkedPou& code_of(const MigrationCall& call) const;
  Input input_of(const MigrationInput& input, const ir::LinkedPou& pou,
                 const ir::Image& from) const;
  // How many bytes they are.
  size_t gather_call(size_t number, const uint8_t* memory);
  base::Status run_call(size_t number);
  base::Error failed(const MigrationCall& call, const std::string& why) const;

  Plan& plan_;
  const ir::Image& to_;
  const vm::Generation* code_;
  Conversions conversions_;
  vm::Memory scratch_;
  vm::Execution execution_;
  std::vector<Call> calls_;
  base::Bytes bytes_;  // of all inputs, as they were gathered
  uint64_t fuel_ = 0;
  uint64_t most_fuel_ = 0;
};

}  // namespace online_change
