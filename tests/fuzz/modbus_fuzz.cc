// Requests to a Modbus server, by TCP and by RTU, as libmodbus hands them over: whole, and of any
// content. Each has an answer, and nobody writes points but those that the map lets others write.
//
// An input is {by what and how, then requests of {length, protocol data unit}}.
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "adapters/modbus/request_check.h"
#include "adapters/modbus/server_tables.h"
#include "base/check.h"
#include "vm/io/device_events.h"
#include "vm/io/write_queue.h"

namespace {

using ir::PointTable;

constexpr size_t kTcpHeader = 7;
constexpr size_t kMostPdu = 253;  // bytes
constexpr size_t kQueue = 64;
constexpr uint32_t kFirstWritable = 10;
constexpr uint32_t kFirstCoil = 200;

vm::PointRange range(PointTable table, uint32_t first, uint32_t count, uint32_t byte,
                     ir::DirectAddress at, bool writable = false) {
  return {table, first, count, byte, at, writable};
}

vm::DevicePoints some_points() {
  using ir::DirectArea;
  vm::DevicePoints points;
  points.inputs = {range(PointTable::kHolding, 0, 4, 0, {DirectArea::kInput, 0, 16}),
                   range(PointTable::kCoil, 100, 8, 8, {DirectArea::kInput, 64, 1})};
  points.outputs = {
      range(PointTable::kInput, 0, 2, 0, {DirectArea::kOutput, 0, 16}),
      range(PointTable::kDiscrete, 8, 8, 4, {DirectArea::kOutput, 32, 1}),
      range(PointTable::kHolding, kFirstWritable, 4, 5, {DirectArea::kOutput, 64, 32}, true),
      range(PointTable::kCoil, kFirstCoil, 8, 13, {DirectArea::kOutput, 128, 1}, true),
      range(PointTable::kHolding, 65534, 2, 14, {DirectArea::kOutput, 144, 16})};
  points.input_bytes = 9;
  points.output_bytes = 18;
  return points;
}

// Both ends of a line; what the server sends is taken from the other one.
class Line {
 public:
  Line() { base::check(::socketpair(AF_UNIX, SOCK_DGRAM, 0, ends_) == 0, "a pair of sockets"); }
  int server() const { return ends_[0]; }
  // Bytes of the answer; 0: there is none.
  size_t answer(uint8_t* bytes, size_t size) {
    const ssize_t got = ::recv(ends_[1], bytes, size, MSG_DONTWAIT);
    return got < 0 ? 0 : static_cast<size_t>(got);
  }

 private:
  int ends_[2] = {};
};

class Told : public vm::OutsideEvents {
 public:
  void written(const std::string& who, const std::string& what) override { tell(who, what); }
  void refused(const std::string& who, const std::string& what) override { tell(who, what); }

 private:
  static void tell(const std::string& who, const std::string& what) {
    base::check(!who.empty() && !what.empty(), "an event says who and what");
  }
};

class Server {
 public:
  Server(bool rtu, bool high_first)
      : rtu_(rtu),
        tables_(high_first),
        context_(rtu ? modbus_new_rtu("/dev/null", 9600, 'N', 8, 1)
                     : modbus_new_tcp("127.0.0.1", 1502)) {
    base::check(tables_.ok() && context_ != nullptr, "memory");
    modbus_set_slave(context_, 1);
    modbus_set_socket(context_, line_.server());
    tables_.use(points_);
  }

  void ask(base::ByteSpan pdu) {
    const base::Bytes request = framed(pdu);
    const base::Bytes outputs(points_.output_bytes, 0x5a);
    tables_.show(outputs);
    const bool kept = tables_.answer(context_, request.data(), static_cast<int>(request.size()),
                                     {"fuzz", &writes_, &told_});
    uint8_t answer[512];
    const size_t size = line_.answer(answer, sizeof answer);
    base::check(!kept || pdu.empty() || size > 1, "a request that is understood has an answer");
    const bool function = !pdu.empty() && pdu[0] < 0x80;  // libmodbus adds 0x80 to whatever it is
    if (function && modbus::request_fault(pdu) != 0) {
      const size_t at = rtu_ ? 1 : kTcpHeader;
      base::check(size > at && (answer[at] & 0x80) != 0, "what is wrong is an exception");
    }
    take();
  }

 private:
  base::Bytes framed(base::ByteSpan pdu) const {
    base::Bytes out;
    if (rtu_) {
      out = {1};
    } else {
      const size_t rest = pdu.size() + 1;
      out = {0, 7, 0, 0, static_cast<uint8_t>(rest >> 8), static_cast<uint8_t>(rest), 1};
    }
    out.insert(out.end(), pdu.begin(), pdu.end());
    if (rtu_) out.insert(out.end(), {0, 0});  // a checksum that libmodbus has looked at
    return out;
  }
  void take() {
    writes_.take([](const vm::OutsideWrite& write) {
      const bool number = write.bits == 16 && write.bit >= 64 && write.bit + 16 <= 128;
      const bool coil = write.bits == 1 && write.bit >= 128 && write.bit < 136;
      base::check(write.area == ir::DirectArea::kOutput && (number || coil),
                  "only what others may write is written");
    });
    base::Bytes inputs(points_.input_bytes);
    tables_.fetch(inputs);
  }

  const bool rtu_;
  const vm::DevicePoints points_ = some_points();
  modbus::ServerTables tables_;
  Line line_;
  vm::WriteQueue writes_{kQueue};
  Told told_;
  modbus_t* context_;
};

void check_who(base::ByteSpan pdu) {
  if (!modbus::asks_who(pdu)) return;
  const base::Bytes answer = modbus::who_it_is(pdu);
  base::check(answer.size() >= 2 && answer.size() <= kMostPdu && (answer[0] & 0x7f) == pdu[0],
              "an answer of the function");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  // What was written stays in the tables from input to input: it is data, and nothing follows from
  // it but what is read.
  static Server servers[] = {{false, false}, {false, true}, {true, false}, {true, true}};
  Server& server = servers[data[0] % 4];
  base::ByteSpan input(data + 1, size - 1);
  for (int i = 0; i < 16 && !input.empty(); ++i) {
    const size_t length = std::min<size_t>({input[0], input.size() - 1, kMostPdu});
    const base::ByteSpan pdu = input.subspan(1, length);
    (void)modbus::request_fault(pdu);
    check_who(pdu);
    server.ask(pdu);
    input = input.subspan(1 + length);
  }
  return 0;
}
