// What the product does with pairs of programs, for the oracle of fates (main.py), which knows
// nothing of the product. Reads pairs from standard input, each as lines
//
//   PAIR NAME [standby]
//   OLD BYTES / NEW BYTES              the sources behind the line, of so many bytes
//   SAFE old|new BIT BITS VALUE        an output's safe value: bit of %Q, bits, value
//   SET PATH HEX                       bytes that a variable has before the change
//   WRITE PATH HEX                     ... that it gets after the switch, before undo
//   GO
//
// and writes a line of JSON for each: the variables before the change, behind it and behind its
// undo (path, type, text, bytes), the report as `stvm change --all --format json` has it, and
// whether the switch wants leave. Everything is done by the production service and its client.
#include <cstdio>
#include <cstring>
#include <iostream>
#include <string>

#include "online_change/package/package.h"
#include "online_change/store/boot.h"
#include "linker/link.h"
#include "tests/golden/runner/compile.h"
#include "tests/sim/faulty_transport.h"
#include "tests/sim/stepped_boundary.h"
#include "tests/unit/store/sim_storage.h"
#include "tools/stvm/controller_client.h"
#include "tools/stvm/controller_service.h"
#include "tools/stvm/fate_view.h"
#include "vm/runtime/io.h"

namespace {

struct Value {
  std::string path;
  base::Bytes bytes;
};

struct Side {
  std::string source;
  std::vector<ir::SafeOutput> safe;
};

struct Pair {
  std::string name;
  bool standby = false;
  Side old_side;
  Side new_side;
  std::vector<Value> before;
  std::vector<Value> behind;
};

base::Bytes from_hex(const std::string& text) {
  base::Bytes out;
  for (size_t i = 0; i + 1 < text.size(); i += 2) {
    out.push_back(static_cast<uint8_t>(std::stoul(text.substr(i, 2), nullptr, 16)));
  }
  return out;
}

std::string to_hex(std::span<const uint8_t> bytes) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (uint8_t byte : bytes) {
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15];
  }
  return out;
}

std::string source_text(std::istream& in, size_t bytes) {
  std::string out(bytes, '\0');
  in.read(out.data(), static_cast<std::streamsize>(bytes));
  in.ignore();  // the end of its last line
  return out;
}

bool read_pair(std::istream& in, Pair& pair) {
  std::string word;
  while (in >> word) {
    std::string text;
    if (word == "PAIR") {
      std::getline(in >> std::ws, text);
      pair.standby = text.find(" standby") != std::string::npos;
      pair.name = text.substr(0, text.find(' '));
    } else if (word == "OLD" || word == "NEW") {
      size_t bytes = 0;
      in >> bytes;
      in.ignore();
      (word == "OLD" ? pair.old_side : pair.new_side).source = source_text(in, bytes);
    } else if (word == "SAFE") {
      ir::SafeOutput row;
      in >> text >> row.bit_offset >> row.bits >> row.value;
      (text == "old" ? pair.old_side : pair.new_side).safe.push_back(row);
    } else if (word == "SET" || word == "WRITE") {
      Value value;
      in >> value.path >> text;
      value.bytes = from_hex(text);
      (word == "SET" ? pair.before : pair.behind).push_back(std::move(value));
    } else if (word == "GO") {
      return true;
    } else {
      return false;
    }
  }
  return false;
}

base::Result<ir::VerifiedImage> image_of(const Side& side, const ir::Image* base_image) {
  golden::TestFile test;
  test.name = "pair.st";
  test.versions.push_back(side.source);
  golden::Outcome outcome;
  base::Result<golden::Program> program = golden::compile(test, 0, outcome);
  if (!program.ok()) return program.error();
  linker::Options options;
  options.base = base_image;
  options.safe = side.safe;
  base::Result<ir::Image> image = linker::link(program->program, program->objects, options);
  if (!image.ok()) return image.error();
  return ir::verify(ir::encode(*image));
}

// A controller with its service, in this thread.
class Host {
 public:
  static base::Result<std::unique_ptr<Host>> start(const ir::VerifiedImage& image) {
    auto out = std::make_unique<Host>();
    out->store_ = std::make_unique<online_change::Store>(out->disk_);
    auto boot = online_change::boot(*out->store_, image, "fates", 0);
    if (!boot.ok()) return boot.error();
    vm::ControllerOptions options;
    options.fuel_budget = 20'000'000;
    auto controller = vm::Controller::start(boot->image, options, out->clock_, out->devices_,
                                            boot->retained);
    if (!controller.ok()) return controller.error();
    out->controller_ = std::move(*controller);
    out->boundary_ = std::make_unique<sim::SteppedBoundary>(*out->controller_, out->clock_);
    out->service_ = std::make_unique<stvm::ControllerService>(
        *out->controller_, out->clock_, *out->store_, *out->boundary_, stvm::StartReport{},
        [] { return int64_t{0}; });
    out->boundary_->cycle();
    return out;
  }

  stvm::ControllerClient connect() {
    stvm::ControllerClient client(std::make_unique<sim::FaultyTransport>(*service_));
    (void)client.status().ok();
    return client;
  }
  const vm::Controller& controller() const { return *controller_; }

  base::Status set(const std::vector<Value>& values) {
    for (const Value& value : values) {
      base::Result<ir::Symbol> symbol = ir::find_symbol(controller_->image(), value.path);
      if (!symbol.ok()) return symbol.error();
      std::memcpy(controller_->memory().data() + symbol->data, value.bytes.data(),
                  value.bytes.size());
    }
    return base::Ok{};
  }

  void variables(const char* name, tools::JsonWriter& json) const {
    const ir::Image& image = controller_->image();
    const std::span<const uint8_t> memory = controller_->memory().view();
    json.key(name).begin_object();
    ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
      json.key(path).begin_array().value(image.types.text(symbol.type));
      json.value(ir::format_value(image, symbol, memory));
      json.value(to_hex(memory.subspan(symbol.data, image.layouts[symbol.type].size)));
      json.end_array();
    });
    json.end_object();
  }

 private:
  vm::VirtualClock clock_;
  vm::NullIo devices_;
  sim::SimStorage disk_;
  std::unique_ptr<online_change::Store> store_;
  std::unique_ptr<vm::Controller> controller_;
  std::unique_ptr<sim::SteppedBoundary> boundary_;
  std::unique_ptr<stvm::ControllerService> service_;
};

void losses(const stvm::FatePage& page, tools::JsonWriter& json) {
  json.field("loss_count", page.loss_count).key("losses").begin_array();
  for (const stvm::LossLine& line : page.losses) {
    json.begin_object().field("variable", line.loss.path).field("live", line.loss.old_value);
    json.field("after", line.loss.new_value).field("what", line.loss.what).end_object();
  }
  json.end_array();
}

base::Status stage(Host& host, stvm::ControllerClient& client, const Pair& pair) {
  base::Result<ir::VerifiedImage> next = image_of(pair.new_side, &host.controller().image());
  if (!next.ok()) return next.error();
  auto package = online_change::make_package(host.controller().verified().encoded(),
                                             next->encoded());
  if (!package.ok()) return package.error();
  return client.stage(online_change::encode(*package), pair.standby ? vm::kByStandby : 0u);
}

base::Status change(Host& host, const Pair& pair, tools::JsonWriter& json) {
  stvm::ControllerClient client = host.connect();
  base::Status staged = stage(host, client, pair);
  if (!staged.ok()) return staged;
  base::Result<stvm::FatePage> page = client.fates();
  if (!page.ok()) return page.error();
  auto every = client.every_fate();
  if (!every.ok()) return every.error();
  stvm::fates_json(*page, json);
  losses(*page, json);
  tools::every_fate(*every, json);
  auto without_leave = client.make_switch(vm::kAllowOverrun);
  json.field("switched_without_leave", without_leave.ok());
  if (!without_leave.ok()) {
    json.field("refused", base::to_string(without_leave.error()));
    (void)client.call({.command = vm::Command::kCancel}).ok();
    base::Status again = stage(host, client, pair);
    if (!again.ok()) return again;
    auto report = client.make_switch(vm::kAllowOverrun | vm::kAllowLoss);
    if (!report.ok()) return report.error();
  }
  host.variables("after", json);
  base::Status written = host.set(pair.behind);
  if (!written.ok()) return written;
  auto undone = host.connect().undo("", {vm::kWithLoss});
  if (!undone.ok()) return undone.error();
  host.variables("undone", json);
  return base::Ok{};
}

base::Status run(const Pair& pair, tools::JsonWriter& json) {
  base::Result<ir::VerifiedImage> image = image_of(pair.old_side, nullptr);
  if (!image.ok()) return image.error();
  base::Result<std::unique_ptr<Host>> host = Host::start(*image);
  if (!host.ok()) return host.error();
  base::Status set = (*host)->set(pair.before);
  if (!set.ok()) return set;
  (*host)->variables("before", json);
  return change(**host, pair, json);
}

}  // namespace

int main() {
  std::ios::sync_with_stdio(false);
  for (Pair pair; read_pair(std::cin, pair); pair = {}) {
    tools::JsonWriter json;
    json.begin_object().field("pair", pair.name);
    base::Status done = run(pair, json);
    if (!done.ok()) json.field("error", base::to_string(done.error()));
    json.end_object();
    std::fputs(json.finish().c_str(), stdout);
    std::fflush(stdout);
  }
  return 0;
}
