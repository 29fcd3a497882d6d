#include "tests/unit/store/lives.h"

#include <algorithm>

namespace plc {

std::string source(int version) {
  const char* const variables[] = {
      "r : DINT; s : DINT; only1 : INT;",
      "more : ARRAY[0..9] OF LINT; s : LINT; r : DINT;",
      "s : DINT; r : LINT; x : STRING;",
      "r : INT; s : INT;",
  };
  return std::string("VAR_GLOBAL RETAIN ") + variables[version - 1] +
         " END_VAR PROGRAM P VAR n : DINT; END_VAR n := n + 1; END_PROGRAM";
}

bool set_and_save(Plc& plc, int value) {
  plc.set("r", std::to_string(value));
  plc.set("s", std::to_string(value));
  return plc.save().ok();
}

std::vector<Step> life() {
  auto set = [](int value) {
    return [value](std::unique_ptr<Plc>& plc, vm::Storage&) { return set_and_save(*plc, value); };
  };
  auto change = [](int version, uint32_t flags) {
    return [version, flags](std::unique_ptr<Plc>& plc, vm::Storage&) {
      return plc->change(source(version), flags | vm::kAllowLoss).ok();
    };
  };
  auto boot = [](int version) {
    return [version](std::unique_ptr<Plc>& plc, vm::Storage& storage) {
      std::optional<ir::VerifiedImage> given;
      if (version != 0) given = build(source(version), plc ? &plc->controller().image() : nullptr);
      plc = std::make_unique<Plc>(storage);
      return plc->boot(given).ok();
    };
  };
  auto undo = [](std::unique_ptr<Plc>& plc, vm::Storage&) { return plc->undo().ok(); };
  auto accept = [](std::unique_ptr<Plc>& plc, vm::Storage&) { return plc->accept().ok(); };
  auto accept_to = [](const char* edit) {
    return [edit](std::unique_ptr<Plc>& plc, vm::Storage&) {
      return plc->ask({.command = vm::Command::kAccept, .names = {edit}}).ok();
    };
  };
  return {
      {boot(1), {0, 1}, {0}},
      {set(5), {1}, {0, 5}},
      {change(2, 0), {1}, {5}},
      {set(6), {1}, {5, 6}},
      {undo, {1}, {6}},
      {change(2, 0), {1}, {6}},
      {set(7), {1}, {6, 7}},
      {accept, {1, 2}, {7}},
      {set(8), {2}, {7, 8}},
      {change(3, vm::kPermanent), {2, 3}, {8}},
      {set(9), {3}, {8, 9}},
      {change(2, 0), {3}, {9}},
      {boot(0), {3}, {9}},  // the trial is lost
      {boot(4), {3, 4}, {9}},
      {set(10), {4}, {9, 10}},
      // D3, case 77: edits on top of each other.
      {change(1, 0), {4}, {10}},
      {set(11), {4}, {10, 11}},
      {change(2, 0), {4}, {11}},
      {set(12), {4}, {11, 12}},
      {change(3, 0), {4}, {12}},
      {undo, {4}, {12}},
      {set(13), {4}, {12, 13}},
      {change(4, 0), {4}, {13}},
      {undo, {4}, {13}},
      {undo, {4}, {13}},
      {change(3, 0), {4}, {13}},
      {set(14), {4}, {13, 14}},
      {accept_to("E1"), {4, 1}, {14}},
      {set(15), {1}, {14, 15}},
      {accept, {1, 3}, {15}},
  };
}

namespace {

template <class T>
bool holds(const std::vector<T>& list, const T& value) {
  return std::find(list.begin(), list.end(), value) != list.end();
}

}  // namespace

int version_of(const Plc& plc) {
  if (plc.get("only1") != "no only1") return 1;
  if (plc.get("more[0]") != "no more[0]") return 2;
  return plc.get("x") != "no x" ? 3 : 4;
}

std::string found(vm::Storage& storage, const Step& step) {
  Plc plc(storage);
  const base::Status booted = plc.boot();
  if (!booted.ok()) {
    const bool nothing = booted.error().refusal == base::Refusal::kFileNotFound;
    return nothing && holds(step.boots, 0) ? "" : base::to_string(booted.error());
  }
  const int version = version_of(plc);
  if (!holds(step.boots, version)) return "version " + std::to_string(version) + " boots";
  if (plc.get("r") != plc.get("s")) return "a mixture: r " + plc.get("r") + ", s " + plc.get("s");
  if (!holds(step.values, std::stoi(plc.get("r")))) return "r is " + plc.get("r");
  // It is a controller: it takes a change.
  if (!plc.change(source(version == 2 ? 3 : 2)).ok()) return "no change is possible any more";
  return "";
}

}  // namespace plc
