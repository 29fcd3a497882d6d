#include "adapters/modbus/server_tables.h"

#include "adapters/modbus/request_check.h"
#include "adapters/modbus/values.h"

namespace modbus {
namespace {

using ir::PointTable;

constexpr int kRtuHeader = 1;
constexpr int kRtuChecksum = 2;

uint32_t word(const uint8_t* at) { return static_cast<uint32_t>(at[0] << 8 | at[1]); }

}  // namespace

ServerTables::ServerTables(bool high_first)
    : high_first_(high_first), tables_(modbus_mapping_new(kPoints, kPoints, kPoints, kPoints)) {}

ServerTables::Permission& ServerTables::of(PointTable table) {
  return permissions_[static_cast<size_t>(table) - static_cast<size_t>(PointTable::kCoil)];
}

void ServerTables::use(const vm::DevicePoints& points) {
  if (points == points_) return;
  points_ = points;
  for (Permission& permission : permissions_) permission = {};
  auto allow = [&](const vm::PointRange& range, bool write) {
    for (uint32_t i = 0; i < range.count; ++i) {
      of(range.table).read[range.first + i] = true;
      of(range.table).write[range.first + i] = write;
    }
  };
  for (const vm::PointRange& range : points_.inputs) allow(range, true);
  for (const vm::PointRange& range : points_.outputs) allow(range, range.writable);
}

void ServerTables::show(base::ByteSpan outputs) {
  for (const vm::PointRange& range : points_.outputs) {
    for (uint32_t i = 0; i < range.count; ++i) {
      const uint32_t at = range.first + i;
      switch (range.table) {
        case PointTable::kCoil:
          tables_->tab_bits[at] = get_bit(outputs, range, i);
          break;
        case PointTable::kDiscrete:
          tables_->tab_input_bits[at] = get_bit(outputs, range, i);
          break;
        case PointTable::kInput:
          tables_->tab_input_registers[at] = get_register(outputs, range, i, high_first_);
          break;
        default:
          tables_->tab_registers[at] = get_register(outputs, range, i, high_first_);
          break;
      }
    }
  }
}

void ServerTables::fetch(std::span<uint8_t> inputs) const {
  for (const vm::PointRange& range : points_.inputs) {
    for (uint32_t i = 0; i < range.count; ++i) {
      const uint32_t at = range.first + i;
      if (range.table == PointTable::kCoil) {
        set_bit(inputs, range, i, tables_->tab_bits[at] != 0);
      } else {
        set_register(inputs, range, i, high_first_, tables_->tab_registers[at]);
      }
    }
  }
}

bool ServerTables::may(PointTable table, bool write, uint32_t first, uint32_t count) {
  if (first + count > kPoints) return false;
  const std::vector<bool>& allowed = write ? of(table).write : of(table).read;
  for (uint32_t i = 0; i < count; ++i) {
    if (!allowed[first + i]) return false;
  }
  return true;
}

ServerTables::Written ServerTables::written_by(const uint8_t* pdu, int length) {
  if (length < 5) return {};
  const uint32_t first = word(pdu + 1);
  switch (pdu[0]) {
    case MODBUS_FC_WRITE_SINGLE_COIL:
      return {PointTable::kCoil, first, 1};
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
      return {PointTable::kCoil, first, word(pdu + 3)};
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
    case MODBUS_FC_MASK_WRITE_REGISTER:
      return {PointTable::kHolding, first, 1};
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
      return {PointTable::kHolding, first, word(pdu + 3)};
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      if (length < 9) return {};
      return {PointTable::kHolding, word(pdu + 5), word(pdu + 7)};
    default:
      return {};
  }
}

bool ServerTables::permits(const uint8_t* pdu, int length) {
  if (length < 5) return true;
  const Written written = written_by(pdu, length);
  if (!may(written.table, true, written.first, written.count)) return false;
  const uint32_t first = word(pdu + 1);
  const uint32_t count = word(pdu + 3);
  switch (pdu[0]) {
    case MODBUS_FC_READ_COILS:
      return may(PointTable::kCoil, false, first, count);
    case MODBUS_FC_READ_DISCRETE_INPUTS:
      return may(PointTable::kDiscrete, false, first, count);
    case MODBUS_FC_READ_INPUT_REGISTERS:
      return may(PointTable::kInput, false, first, count);
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return may(PointTable::kHolding, false, first, count);
    default:
      return true;
  }
}

std::string ServerTables::text_of(const Written& written) {
  std::string text(ir::table_rows()[static_cast<size_t>(written.table)].name);
  text += " " + std::to_string(written.first);
  if (written.count > 1) text += ".." + std::to_string(written.first + written.count - 1);
  return text;
}

void ServerTables::pass_on(const Written& written, const Asking& asking) const {
  vm::WriteQueue& writes = *asking.writes;
  bool any = false;
  for (const vm::PointRange& range : points_.outputs) {
    if (!range.writable || range.table != written.table) continue;
    for (uint32_t i = 0; i < written.count; ++i) {
      const uint32_t at = written.first + i;
      if (at < range.first || at - range.first >= range.count) continue;
      any = true;
      const uint32_t number = at - range.first;
      const uint32_t bit = range.at.bit_offset;
      if (range.table == PointTable::kCoil) {
        writes.put({range.at.area, bit + number, 1, tables_->tab_bits[at]});
      } else {
        writes.put({range.at.area, bit + 8 * byte_of_register(range, number, high_first_), 16,
                    tables_->tab_registers[at]});
      }
    }
  }
  writes.publish();
  if (any && asking.events != nullptr) asking.events->written(asking.who, text_of(written));
}

bool ServerTables::answer(modbus_t* context, const uint8_t* request, int length,
                          const Asking& asking) {
  const int header = modbus_get_header_length(context);
  const int size = length - header - (header == kRtuHeader ? kRtuChecksum : 0);
  if (size <= 0) return false;
  const uint8_t* const pdu = request + header;
  const int fault = request_fault({pdu, static_cast<size_t>(size)});
  if (fault != 0) {
    const bool to_all = header == kRtuHeader && request[0] == MODBUS_BROADCAST_ADDRESS;
    return to_all || modbus_reply_exception(context, request, static_cast<unsigned>(fault)) >= 0;
  }
  const Written written = written_by(pdu, size);
  if (!permits(pdu, size)) {
    const bool write = written.count != 0 && asking.events != nullptr;
    if (write) asking.events->refused(asking.who, text_of(written));
    return modbus_reply_exception(context, request, MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS) >= 0;
  }
  if (asking.writes != nullptr && written.count > asking.writes->room()) {
    return modbus_reply_exception(context, request, MODBUS_EXCEPTION_SLAVE_OR_SERVER_BUSY) >= 0;
  }
  const int sent = modbus_reply(context, request, length, tables_.get());
  if (sent < 0) return false;
  // An exception has two bytes after its header, and by RTU two more: then nothing was written.
  // To a broadcast nothing is sent.
  const bool done = sent == 0 || sent > header + (header == kRtuHeader ? 4 : 2);
  if (asking.writes != nullptr && written.count != 0 && done) pass_on(written, asking);
  return true;
}

}  // namespace modbus
