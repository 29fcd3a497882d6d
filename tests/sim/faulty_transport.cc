#include "tests/sim/faulty_transport.h"

namespace sim {
namespace {

base::Error gone() { return {base::Refusal::kNotRunning, "the connection is lost"}; }

}  // namespace

void FaultyTransport::arm(Fault fault, uint32_t exchanges, uint64_t seed) {
  armed_ = true;
  fault_ = fault;
  exchanges_ = exchanges;
  seed_ = seed;
}

base::Result<base::Bytes> FaultyTransport::exchange(base::ByteSpan request) {
  if (lost_) return gone();
  bool keep_open = true;
  const Fault fault = exchanges_ == 0 ? fault_ : Fault::kNone;
  if (exchanges_ > 0) --exchanges_;
  if (fault != Fault::kNone) fault_ = Fault::kNone;
  differential::Random random(seed_);
  base::Bytes bytes(request.begin(), request.end());
  switch (fault) {
    case Fault::kNone:
      break;
    case Fault::kRequestLost:
      lost_ = true;
      return gone();
    case Fault::kAnswerLost:
      service_.answer(bytes, keep_open);
      lost_ = true;
      return gone();
    case Fault::kTwice: {
      base::Bytes first = service_.answer(bytes, keep_open);
      service_.answer(bytes, keep_open);
      return first;
    }
    case Fault::kDamaged: {
      const uint32_t bit = random.below(static_cast<uint32_t>(bytes.size() * 8));
      bytes[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
      break;
    }
    case Fault::kCut:
      bytes.resize(random.below(static_cast<uint32_t>(bytes.size())));
      break;
  }
  base::Bytes answer = service_.answer(bytes, keep_open);
  if (!keep_open) lost_ = true;
  return answer;
}

}  // namespace sim
