#include "adapters/modbus/request_check.h"

#include <modbus.h>

#include <string_view>

namespace modbus {
namespace {

constexpr uint8_t kEncapsulated = 0x2b;
constexpr uint8_t kDeviceIdentification = 0x0e;
constexpr uint8_t kException = 0x80;  // added to the function
constexpr uint8_t kBasicEach = 0x81;  // the basic objects, as a stream and each by itself
constexpr uint8_t kOneObject = 4;     // the last of the four ways to ask
constexpr std::string_view kObjects[] = {"stc", "stvm", STC_VERSION};

// Bits or registers that one request may have.
constexpr unsigned kMostBitsRead = MODBUS_MAX_READ_BITS;
constexpr unsigned kMostRead = MODBUS_MAX_READ_REGISTERS;
constexpr unsigned kMostBitsWritten = MODBUS_MAX_WRITE_BITS;
constexpr unsigned kMostWritten = MODBUS_MAX_WRITE_REGISTERS;
constexpr unsigned kMostWrittenAndRead = MODBUS_MAX_WR_WRITE_REGISTERS;

class Form {
 public:
  explicit Form(base::ByteSpan request) : bytes_(request) {}

  bool is_good() const {
    switch (bytes_[0]) {
      case MODBUS_FC_READ_COILS:
      case MODBUS_FC_READ_DISCRETE_INPUTS:
        return has(5) && counts(3, kMostBitsRead);
      case MODBUS_FC_READ_HOLDING_REGISTERS:
      case MODBUS_FC_READ_INPUT_REGISTERS:
        return has(5) && counts(3, kMostRead);
      case MODBUS_FC_WRITE_SINGLE_COIL:
        return has(5) && (word(3) == 0 || word(3) == 0xff00);
      case MODBUS_FC_WRITE_SINGLE_REGISTER:
        return has(5);
      case MODBUS_FC_WRITE_MULTIPLE_COILS:
        return brings(5, (word(3) + 7) / 8) && counts(3, kMostBitsWritten);
      case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
        return brings(5, 2 * word(3)) && counts(3, kMostWritten);
      case MODBUS_FC_MASK_WRITE_REGISTER:
        return has(7);
      case MODBUS_FC_WRITE_AND_READ_REGISTERS:
        return brings(9, 2 * word(7)) && counts(3, kMostRead) && counts(7, kMostWrittenAndRead);
      default:
        return has(1);
    }
  }

 private:
  unsigned word(size_t at) const {
    return at + 2 > bytes_.size() ? 0u : static_cast<unsigned>(bytes_[at] << 8 | bytes_[at + 1]);
  }
  bool has(size_t size) const { return bytes_.size() == size; }
  bool counts(size_t at, unsigned most) const { return word(at) >= 1 && word(at) <= most; }
  // So many bytes after the one that says so.
  bool brings(size_t at, unsigned count) const {
    return at < bytes_.size() && bytes_[at] == count && has(at + 1 + count);
  }

  base::ByteSpan bytes_;
};

bool is_served(uint8_t function) {
  switch (function) {
    case MODBUS_FC_READ_COILS:
    case MODBUS_FC_READ_DISCRETE_INPUTS:
    case MODBUS_FC_READ_HOLDING_REGISTERS:
    case MODBUS_FC_READ_INPUT_REGISTERS:
    case MODBUS_FC_WRITE_SINGLE_COIL:
    case MODBUS_FC_WRITE_SINGLE_REGISTER:
    case MODBUS_FC_WRITE_MULTIPLE_COILS:
    case MODBUS_FC_WRITE_MULTIPLE_REGISTERS:
    case MODBUS_FC_REPORT_SLAVE_ID:
    case MODBUS_FC_MASK_WRITE_REGISTER:
    case MODBUS_FC_WRITE_AND_READ_REGISTERS:
      return true;
    default:
      return false;
  }
}

}  // namespace

int request_fault(base::ByteSpan request) {
  if (request.empty() || !is_served(request[0])) return MODBUS_EXCEPTION_ILLEGAL_FUNCTION;
  return Form(request).is_good() ? 0 : MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE;
}

bool asks_who(base::ByteSpan request) {
  return request.size() >= 2 && request[0] == kEncapsulated && request[1] == kDeviceIdentification;
}

base::Bytes who_it_is(base::ByteSpan request) {
  const auto refused = [](int exception) {
    return base::Bytes{kEncapsulated | kException, static_cast<uint8_t>(exception)};
  };
  if (request.size() != 4 || request[2] == 0 || request[2] > kOneObject) {
    return refused(MODBUS_EXCEPTION_ILLEGAL_DATA_VALUE);
  }
  const bool one = request[2] == kOneObject;
  const bool known = request[3] < std::size(kObjects);
  if (one && !known) return refused(MODBUS_EXCEPTION_ILLEGAL_DATA_ADDRESS);
  const size_t first = known ? request[3] : 0;  // of a stream, an unknown one is the first
  const size_t end = one ? first + 1 : std::size(kObjects);
  base::Bytes out{kEncapsulated, kDeviceIdentification, request[2], kBasicEach, 0, 0,
                  static_cast<uint8_t>(end - first)};
  for (size_t i = first; i < end; ++i) {
    out.push_back(static_cast<uint8_t>(i));
    out.push_back(static_cast<uint8_t>(kObjects[i].size()));
    out.insert(out.end(), kObjects[i].begin(), kObjects[i].end());
  }
  return out;
}

}  // namespace modbus
