// What a Modbus server shows and takes: libmodbus' tables, and which points of them are mapped.
// Points with `->` are written by others and read by the program, points with `<-` the other way
// round; points with `<->` are the program's and can be written by others: such a write goes to the
// control thread. Whatever else a request touches is answered with exception 02, what is wrong by
// its form with 01 or 03 (request_check.h), and 06 when more is written than a cycle takes.
#pragma once

#include <modbus.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "vm/io/driver.h"

namespace modbus {

class ServerTables {
 public:
  explicit ServerTables(bool high_first);
  bool ok() const { return tables_ != nullptr; }  // false: no memory

  // Values of points that stay mapped stay.
  void use(const vm::DevicePoints& points);
  void show(base::ByteSpan outputs);
  void fetch(std::span<uint8_t> inputs) const;
  // Who asks, and what becomes of what is written to the program's points; null: nothing.
  struct Asking {
    const std::string& who;
    vm::WriteQueue* writes = nullptr;
    vm::OutsideEvents* events = nullptr;
  };
  // Answers a request that libmodbus received; false: the connection is of no use any more.
  bool answer(modbus_t* context, const uint8_t* request, int length, const Asking& asking);

 private:
  static constexpr uint32_t kPoints = 65536;
  struct Permission {
    std::vector<bool> read = std::vector<bool>(kPoints);
    std::vector<bool> write = std::vector<bool>(kPoints);
  };
  struct Written {  // by one request
    ir::PointTable table = ir::PointTable::kCoil;
    uint32_t first = 0;
    uint32_t count = 0;
  };
  static Written written_by(const uint8_t* pdu, int length);
  static std::string text_of(const Written& written);
  struct Free {
    void operator()(modbus_mapping_t* tables) const { modbus_mapping_free(tables); }
  };
  Permission& of(ir::PointTable table);
  bool may(ir::PointTable table, bool write, uint32_t first, uint32_t count);
  bool permits(const uint8_t* pdu, int length);
  void pass_on(const Written& written, const Asking& asking) const;

  const bool high_first_;
  std::unique_ptr<modbus_mapping_t, Free> tables_;
  std::array<Permission, 4> permissions_;  // coil, discrete, input, holding
  vm::DevicePoints points_;
};

}  // namespace modbus
