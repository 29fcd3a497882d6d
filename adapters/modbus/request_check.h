// What a Modbus server says of a request by its form alone, before any point is looked at. A
// request is its protocol data unit: function, then what that has, without address and checksum.
#pragma once

#include "base/bytes.h"

namespace modbus {

// The exception that answers it: 01, its function is not served; 03, it is not as long as its
// function says, or has a count or a value that this cannot have. 0: nothing is wrong.
int request_fault(base::ByteSpan request);

// Functions 43/14, who the server is: vendor, product, version. By TCP only.
bool asks_who(base::ByteSpan request);
// The answer's protocol data unit, or that of exception 02 or 03.
base::Bytes who_it_is(base::ByteSpan request);

}  // namespace modbus
