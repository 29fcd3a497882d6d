#include "tests/golden/runner/modes.h"

#include <sstream>

#include "ir/program/text.h"
#include "tests/golden/runner/compile.h"
#include "tests/golden/runner/engine.h"
#include "tests/golden/runner/evaluator_engine.h"
#include "tests/golden/runner/format_mode.h"
#include "tests/golden/runner/machine_engine.h"
#include "tests/golden/runner/script.h"
#include "tools/stc/image_text.h"

namespace golden {

base::Result<std::unique_ptr<Engine>> make_engine(Tier tier, const Program& program) {
  if (tier == Tier::kEvaluator) return make_evaluator_engine(program);
  return make_machine_engine(tier, program);
}

namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) out.push_back(line);
  return out;
}

// Only POUs of the file itself: the library's are tested on their own.
std::string ir_text(const Program& program) {
  std::string out;
  for (const ir::Pou& pou : program.optimised.pous) {
    if (pou.file[0] != '<') out += ir::print(program.optimised, pou);
  }
  return out;
}

std::string object_text(const Program& program) {
  std::string out;
  for (size_t i = 0; i < program.objects.size(); ++i) {
    if (program.objects[i].file[0] != '<') {
      out += ir::disassemble(program.objects[i], program.optimised);
    }
  }
  return out;
}

std::string link_text(const Program& program, std::vector<std::string>& failures) {
  base::Result<ir::VerifiedImage> image = link(program, nullptr, false);
  if (!image.ok()) {
    failures.push_back(base::to_string(image.error()));
    return {};
  }
  return stc::layout_text(image->image());
}

void produce_check(const TestFile& test, Actual& actual) {
  Outcome outcome;
  base::Result<Program> program = compile(test, 0, outcome);
  if (!program.ok() && !outcome.errors) actual.failures.push_back(base::to_string(program.error()));
  actual.outputs[0] = outcome.messages;
  if (outcome.messages.empty()) actual.outputs[0] = {"nothing is wrong"};
}

void produce_text(const TestFile& test, Actual& actual) {
  Outcome outcome;
  base::Result<Program> program = compile(test, 0, outcome);
  if (!program.ok()) {
    actual.failures.push_back(base::to_string(program.error()));
    return;
  }
  std::string text = test.mode == "ir"         ? ir_text(*program)
                     : test.mode == "bytecode" ? object_text(*program)
                                               : link_text(*program, actual.failures);
  actual.outputs[0] = lines_of(text);
}

bool compile_all(const TestFile& test, std::vector<Program>& versions, Actual& actual) {
  for (size_t i = 0; i < test.versions.size(); ++i) {
    Outcome outcome;
    base::Result<Program> program = compile(test, i, outcome);
    if (!program.ok()) {
      actual.failures.push_back("version " + std::to_string(i + 1) + ": " +
                                base::to_string(program.error()));
      return false;
    }
    versions.push_back(std::move(*program));
  }
  return true;
}

void compare(Tier tier, const Transcript& first, const Transcript& other, Actual& actual) {
  for (size_t i = 0; i < first.states.size(); ++i) {
    if (i < other.states.size() && first.states[i] == other.states[i]) continue;
    actual.failures.push_back(std::string(tier_name(tier)) + ": other state after scan " +
                              std::to_string(i + 1));
    return;
  }
  if (first.outputs != other.outputs || first.scans != other.scans) {
    actual.failures.push_back(std::string(tier_name(tier)) + ": other output");
  }
}

void produce_run(const TestFile& test, Actual& actual) {
  std::vector<Program> versions;
  if (!compile_all(test, versions, actual)) return;
  Transcript first;
  bool have_first = false;
  for (Tier tier : kTiers) {
    bool oracle = tier == Tier::kEvaluator;
    if (oracle && (test.mode == "change" || test.has_option("--no-evaluator"))) continue;
    base::Result<std::unique_ptr<Engine>> engine = make_engine(tier, versions[0]);
    if (!engine.ok()) {
      actual.failures.push_back(std::string(tier_name(tier)) + ": " +
                                base::to_string(engine.error()));
      return;
    }
    base::Result<Transcript> transcript = run_script(test, versions, **engine);
    if (!transcript.ok()) {
      actual.failures.push_back(std::string(tier_name(tier)) + ": " +
                                base::to_string(transcript.error()));
      return;
    }
    if (have_first) {
      compare(tier, first, *transcript, actual);
    } else {
      first = std::move(*transcript);
      have_first = true;
    }
  }
  actual.outputs = first.outputs;
  actual.scans = first.scans;
}

}  // namespace

Actual produce(const TestFile& test) {
  Actual actual;
  actual.outputs.resize(test.steps.size());
  actual.scans.resize(test.scans.size());
  if (test.mode == "tokens") {
    actual.outputs[0] = lines_of(tokens_of(test));
  } else if (test.mode == "parse") {
    Outcome outcome;
    actual.outputs[0] = lines_of(tree_of(test, outcome));
    actual.outputs[0].insert(actual.outputs[0].end(), outcome.messages.begin(),
                             outcome.messages.end());
  } else if (test.mode == "format") {
    produce_format(test, actual);
  } else if (test.mode == "check") {
    produce_check(test, actual);
  } else if (test.mode == "ir" || test.mode == "bytecode" || test.mode == "link") {
    produce_text(test, actual);
  } else if (test.mode == "run" || test.mode == "change") {
    produce_run(test, actual);
  } else {
    actual.failures.push_back("unknown mode " + test.mode);
  }
  return actual;
}

}  // namespace golden
