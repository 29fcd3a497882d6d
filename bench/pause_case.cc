#include "bench/pause_case.h"

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "linker/link.h"
#include "online_change/apply/deadline.h"
#include "online_change/apply/pace.h"

namespace bench {
namespace {

void insist(bool good, const std::string& what) { base::check(good, what.c_str()); }

template <class T>
T taken(base::Result<T> result) {
  insist(result.ok(), result.ok() ? "" : base::to_string(result.error()));
  return std::move(*result);
}

void done(const base::Status& status) {
  insist(status.ok(), status.ok() ? "" : base::to_string(status.error()));
}

std::string array(const char* name, uint32_t count, const char* type) {
  if (count == 0) return {};
  return std::string(name) + " : ARRAY[1.." + std::to_string(count) + "] OF " + type + "; ";
}

std::string others_of(const Shape& shape, bool second) {
  return array("cells", shape.instances, "Cell") + array("pairs", shape.retyped, "Pair") +
         array("elements", shape.elements, second ? "REAL" : "INT") +
         array("strings", shape.strings, second ? "Long" : "Short") +
         array("modes", shape.modes, "Mode") +
         array("aims", shape.references, "Aim") +
         array("references", shape.references, "REF_TO INT") +
         array("pages", shape.rewritten * 4096, "BYTE");
}

std::string blocks_of(const Shape& shape, bool second) {
  const std::string wider = second ? "DINT" : "INT";
  std::string text = "TYPE Aim : STRUCT a : " + wider + "; b : INT; END_STRUCT;\n" +
                     "Short : STRING[20] := 'sixteen letters.'; Long : STRING[30]; Mode : " +
                     (second ? "(halt, run, wait) := wait" : "(wait, run, halt)") + "; END_TYPE\n";
  text += "FUNCTION_BLOCK Cell VAR a, b, c, d, e, f, g, h, i, j : INT; ";
  if (second && shape.instances != 0) text += "more : INT := 7; ";
  text += "END_VAR a := a + 1; END_FUNCTION_BLOCK\nFUNCTION_BLOCK Pair VAR a : ";
  text += wider + "; b : INT; END_VAR b := b + 1; END_FUNCTION_BLOCK\n"
          "PROGRAM Main VAR n : INT; i : DINT; END_VAR n := n + 1;\n";
  if (shape.references != 0) {
    text += "IF n = 1 THEN FOR i := 1 TO " + std::to_string(shape.references) +
            " DO references[i] := REF(aims[i].b); END_FOR END_IF\n";
  }
  if (shape.rewritten != 0) {
    text += "FOR i := 1 TO " + std::to_string(shape.rewritten * 4096) +
            " BY 4096 DO pages[i] := INT_TO_BYTE(n); END_FOR\n";
  }
  return text + "END_PROGRAM\n";
}

std::string source_of(const Shape& shape, bool second) {
  std::string text = "VAR_GLOBAL\n";
  for (uint32_t i = 0; i < shape.variables; ++i) {
    // The k-th of evenly spread ones begins where i * changed / variables goes up.
    const uint64_t here = uint64_t{i} * shape.changed / shape.variables;
    const uint64_t next = (uint64_t{i} + 1) * shape.changed / shape.variables;
    text += "v" + std::to_string(i) + (second && here != next ? " : DINT;\n" : " : INT;\n");
  }
  return text + others_of(shape, second) + "END_VAR\n" + blocks_of(shape, second);
}

base::Bytes image_of(const std::string& source, const ir::Image* running) {
  base::SourceMap sources;
  sources.add("pause.st", source);
  base::Diagnostics diagnostics;
  std::optional<ir::Program> program = frontend::compile(sources, {}, diagnostics);
  insist(program.has_value(), "the program compiles");
  std::vector<ir::Object> objects;
  for (uint32_t i = 0; i < program->pous.size(); ++i) {
    objects.push_back(taken(ir::lower(*program, ir::PouId(i))));
  }
  linker::Options options;
  options.base = running;
  options.slack.free_bytes = 64u << 20;
  return ir::encode(taken(linker::link(*program, objects, options)));
}

}  // namespace

PauseCase make_case(const Shape& shape) {
  PauseCase made;
  made.image = image_of(source_of(shape, false), nullptr);
  const ir::Image running = taken(ir::decode(made.image));
  const base::Bytes next = image_of(source_of(shape, true), &running);
  const online_change::Package package = taken(online_change::make_package(made.image, next));
  made.steps = package.forward.steps.size();
  made.boundary_bytes = package.forward.boundary_bytes;
  made.predicted_ns = package.forward.predicted_pause_ns;
  made.package = online_change::encode(package);
  return made;
}

PauseRig::PauseRig(const PauseCase& one)
    : case_(one),
      controller_(taken(vm::Controller::start(taken(ir::verify(one.image)), {}, clock_, io_))),
      change_(*controller_) {
  controller_->cycle();
}

void PauseRig::prepare(online_change::Strategy strategy) {
  change_.set_pace(online_change::measured_pace(real_));
  done(change_.stage(case_.package, strategy));
  while (!taken(change_.configure())) controller_->cycle();
  while (!taken(change_.catch_up())) controller_->cycle();
  done(change_.arm(true, true));
  controller_->cycle();
}

int64_t PauseRig::make_switch() {
  online_change::Deadline deadline(real_, INT64_MAX);
  change_.set_interruption(std::ref(deadline));
  const int64_t pause_ns = taken(change_.switch_now()).pause_ns;
  change_.set_interruption(nullptr);
  return pause_ns;
}

void PauseRig::undo() { taken(change_.undo()); }

}  // namespace bench
