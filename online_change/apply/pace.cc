#include "online_change/apply/pace.h"

#include <algorithm>
#include <vector>

#include "ir/bytecode/image.h"
#include "online_change/apply/deadline.h"
#include "online_change/apply/transfer.h"

namespace online_change {
namespace {

constexpr uint32_t kValues = 512;
constexpr uint32_t kApart = 16;  // bytes from value to value
// While others have the processor a try takes longer; the quarter that is soonest done tells of
// the machine itself.
constexpr size_t kTries = 16;
constexpr size_t kTold = kTries / 4;
// What is further off is no machine that runs a controller, but a clock that was set.
constexpr double kMostPace = 64;

ir::Image image_of_scalars() {
  ir::Image image;
  ir::Layouts layouts;
  layouts.of.resize(ir::kElementaryCount);
  for (uint32_t kind = 0; kind < ir::kElementaryCount; ++kind) {
    const ir::TypeId type = image.types.elementary(static_cast<ir::Kind>(kind));
    layouts.of[type.index].size = ir::scalar_size(image.types.scalar(type));
  }
  image.layouts = std::move(layouts);
  image.data_capacity = 2 * kValues * kApart;
  return image;
}

// Each INT becomes a DINT, in a step of its own: as plans mostly are.
Plan plan_of_values(const ir::Image& image) {
  Plan plan;
  for (uint32_t i = 0; i < kValues; ++i) {
    UpdateStep step;
    step.to = (kValues + i) * kApart;
    step.size = ir::scalar_size(ir::Scalar::kI32);
    step.how = ConvertedValues{i * kApart, 0, image.types.elementary(ir::Kind::kInt),
                               image.types.elementary(ir::Kind::kDint), {}};
    plan.steps.push_back(step);
  }
  return plan;
}

}  // namespace

double measured_pace(vm::Clock& clock) {
  const ir::Image image = image_of_scalars();
  const Plan plan = plan_of_values(image);
  Transfer transfer(plan, image, image, Transfer::Steps::kAll);
  base::Bytes memory(size_t{2} * kValues * kApart);
  const auto loses = [](const Loss&) { return true; };
  std::vector<int64_t> took;
  for (size_t i = 0; i < kTries; ++i) {
    Deadline never(clock, INT64_MAX);
    const Interrupted interrupted = std::ref(never);
    const int64_t begin_ns = clock.now_ns();
    transfer.read(memory.data(), loses, interrupted);
    transfer.save(memory.data(), interrupted);
    transfer.remember(memory.data(), interrupted);
    transfer.write(memory.data(), interrupted);
    took.push_back(clock.now_ns() - begin_ns);
  }
  std::nth_element(took.begin(), took.begin() + kTold, took.end());
  BoundaryWork work;
  for (const Piece& piece : transfer.pieces()) transfer.count(piece, work);
  const int64_t model_ns = pause_ns(work) - pause_ns({});
  if (took[kTold] <= 0) return 1;
  return std::min(static_cast<double>(took[kTold]) / static_cast<double>(model_ns), kMostPace);
}

}  // namespace online_change
