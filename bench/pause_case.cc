#include "bench/pause_case.h"

#include "base/diagnostics.h"
#include "frontend/compile.h"
#include "ir/lower/lower.h"
#include "linker/link.h"

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

std::string source_of(const Shape& shape, bool second) {
  std::string text = "VAR_GLOBAL\n";
  for (uint32_t i = 0; i < shape.variables; ++i) {
    // The k-th of evenly spread ones begins where i * changed / variables goes up.
    const uint64_t here = uint64_t{i} * shape.changed / shape.variables;
    const uint64_t next = (uint64_t{i} + 1) * shape.changed / shape.variables;
    text += "v" + std::to_string(i) + (second && here != next ? " : DINT;\n" : " : INT;\n");
  }
  text += "END_VAR\nFUNCTION_BLOCK Cell VAR a, b, c, d, e, f, g, h, i, j : INT; ";
  if (second && shape.instances != 0) text += "more : INT := 7; ";
  text += "END_VAR a := a + 1; END_FUNCTION_BLOCK\nPROGRAM Main VAR n : INT; ";
  if (shape.instances != 0) {
    text += "cells : ARRAY[1.." + std::to_string(shape.instances) + "] OF Cell; ";
  }
  return text + "END_VAR n := n + 1; END_PROGRAM\n";
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
  done(change_.stage(case_.package, strategy));
  while (!taken(change_.configure())) controller_->cycle();
  while (!taken(change_.catch_up())) controller_->cycle();
  done(change_.arm(true, true));
  controller_->cycle();
}

int64_t PauseRig::make_switch() { return taken(change_.switch_now()).pause_ns; }

void PauseRig::undo() { taken(change_.undo()); }

}  // namespace bench
