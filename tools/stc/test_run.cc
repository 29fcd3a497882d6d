#include "tools/stc/test_run.h"

#include <charconv>
#include <chrono>
#include <cstring>

#include "frontend/coverage.h"
#include "ir/bytecode/symbols.h"
#include "ir/types/value_text.h"
#include "vm/exec/execution.h"
#include "vm/exec/memory.h"
#include "vm/load/generation.h"

namespace stc {
namespace {

// The program that constructs instances (frontend/sema/objects/start.cc), where there is one.
constexpr const char* kStart = "__START";

uint32_t instance_of(const ir::Image& image, const std::string& name) {
  for (uint32_t id = 1; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (row.live && row.parent == 0 && ir::same_name(row.name, name)) return id;
  }
  return 0;
}

// What a message has between marks, as people would write it in ST.
std::string literal(char sort, std::string_view text) {
  if (sort == '\'') return ir::string_text(text);
  if (sort == '"') {
    std::string wide;
    for (const char c : text) wide += {c, '\0'};
    return ir::wstring_text(wide);
  }
  uint64_t bits = 0;
  std::from_chars(text.data(), text.data() + text.size(), bits);
  char out[24];
  std::snprintf(out, sizeof out, "16#%0*llX", sort == '0' ? 16 : sort - '0',
                static_cast<unsigned long long>(bits));
  return out;
}

// A text may have a mark in it: the value that is wanted ends where the other one is announced.
std::string with_literals(std::string_view message) {
  using frontend::kTestValueBegin, frontend::kTestValueEnd;
  const std::string between{kTestValueEnd, ',', ' ', 'g', 'o', 't', ' ', kTestValueBegin};
  std::string out;
  for (size_t begin; (begin = message.find(kTestValueBegin)) != std::string_view::npos;) {
    out += message.substr(0, begin);
    message.remove_prefix(std::min(begin + 1, message.size()));
    const char sort = message.empty() ? '\'' : message.front();
    if (!message.empty()) message.remove_prefix(1);
    size_t end = message.find(between);
    if (end == std::string_view::npos) end = message.rfind(kTestValueEnd);
    out += literal(sort, message.substr(0, end));
    if (end == std::string_view::npos) out += "...";  // the message has no room for all of it
    message.remove_prefix(end == std::string_view::npos ? message.size() : end + 1);
  }
  return out.append(message);
}

std::string assertion_message(const ir::Image& image, const vm::Memory& memory) {
  base::Result<ir::Symbol> symbol = ir::find_symbol(image, frontend::kTestMessage);
  if (!symbol.ok()) return {};
  const char* text = reinterpret_cast<const char*>(memory.data()) + symbol->data;
  return with_literals({text, ::strnlen(text, image.types[symbol->type].capacity)});
}

void add_hits(const ir::Image& image, const vm::Memory& memory, std::vector<uint64_t>& hits) {
  base::Result<ir::Symbol> counters = ir::find_symbol(image, frontend::kCoverageCounters);
  if (!counters.ok()) return;
  hits.resize(image.types[counters->type].dims[0].count());
  const uint8_t* at = memory.data() + counters->data;
  for (uint64_t& each : hits) {
    uint32_t count = 0;
    std::memcpy(&count, at, sizeof count);
    each += count;
    at += sizeof count;
  }
}

// Where and why a run has ended that did not come to its end.
void note_end(const ir::Image& image, const vm::Memory& memory, const vm::Execution& execution,
              vm::Exit exit, uint64_t fuel, TestResult& result) {
  const vm::Trap trap =
      exit == vm::Exit::kTrap ? execution.trap() : execution.interrupted(ir::TrapKind::kFuel);
  const vm::TrapText text = vm::describe(image, trap);
  const bool assertion = trap.kind == ir::TrapKind::kAssert;
  result.verdict = assertion ? Verdict::kFailed : Verdict::kError;
  result.file = text.file;
  result.line = text.line;
  result.trap = ir::trap_name(trap.kind);
  result.text = assertion ? assertion_message(image, memory) : text.text;
  if (exit == vm::Exit::kSuspended) {
    result.text += " (" + std::to_string(fuel) + " calls and loop rounds, --timeout)";
  }
}

// The test has come behind its SETUP, and there is a TEARDOWN.
bool is_teardown_due(const ir::Image& image, const vm::Memory& memory) {
  const base::Result<ir::Symbol> due = ir::find_symbol(image, frontend::kTestTeardown);
  return due.ok() && memory.data()[due->data] != 0;
}

}  // namespace

base::Result<TestResult> run_test(const ir::VerifiedImage& verified, const frontend::TestCase& test,
                                  uint64_t fuel, std::vector<uint64_t>* hits) {
  base::Result<vm::Memory> memory = vm::Memory::reserve();
  if (!memory.ok()) return memory.error();
  const ir::Image& image = verified.image();
  vm::write_initial_data(image, memory->data());
  const std::unique_ptr<vm::Generation> generation =
      vm::Generation::build(verified, 0, memory->data());
  vm::Execution execution(image.call_depth);
  const auto run = [&](const std::string& instance, int64_t time_ns, TestResult& result) {
    const uint32_t id = instance_of(image, instance);
    if (id == 0) return;
    execution.start(*generation, memory->data(), id, ir::kStackBegin, time_ns);
    const vm::Exit exit = execution.run(fuel);
    if (exit != vm::Exit::kDone) note_end(image, *memory, execution, exit, fuel, result);
  };
  TestResult result;
  result.test = test;
  const auto begin = std::chrono::steady_clock::now();
  run(kStart, 0, result);
  if (result.verdict == Verdict::kPassed) run(test.instance, 0, result);
  TestResult behind;
  if (is_teardown_due(image, *memory)) run(test.instance, execution.task_time_ns(), behind);
  const auto end = std::chrono::steady_clock::now();
  if (behind.verdict != Verdict::kPassed && result.verdict == Verdict::kPassed) {
    behind.test = test;
    result = std::move(behind);
  } else if (behind.verdict != Verdict::kPassed) {
    result.text += "; then TEARDOWN, line " + std::to_string(behind.line) + ": " + behind.text;
  }
  result.seconds = std::chrono::duration<double>(end - begin).count();
  if (hits != nullptr) add_hits(image, *memory, *hits);
  return result;
}

}  // namespace stc
