#include "online_change/apply/transfer.h"

#include <algorithm>
#include <cstring>

namespace online_change {

Transfer::Transfer(const Plan& plan, const ir::Image& from, const ir::Image& to, Steps which)
    : plan_(plan), conversions_(from, to) {
  size_t bytes = 0;
  for (uint32_t number = 0; number < plan.steps.size(); ++number) {
    const UpdateStep& step = plan.steps[number];
    if (which == Steps::kBoundary && step.early) continue;
    work_.push_back({number, bytes});
    for (uint32_t i = 0; i < step.count; ++i) {
      targets_.push_back({step.to + i * step.to_stride, step.size, bytes + size_t{i} * step.size,
                          step.kind == StepKind::kConvert});
    }
    bytes += step.total();
  }
  std::sort(targets_.begin(), targets_.end(),
            [](const Target& a, const Target& b) { return a.to < b.to; });
  staged_.resize(bytes);
  saved_.resize(bytes);
}

void Transfer::read_values(const UpdateStep& step, const uint8_t* memory, uint8_t* out) const {
  if (step.kind == StepKind::kInitialise) {
    if (step.bytes.empty()) {
      std::memset(out, 0, step.total());
    } else {
      std::memcpy(out, step.bytes.data(), step.total());
    }
    return;
  }
  for (uint32_t i = 0; i < step.count; ++i) {
    std::memcpy(out + size_t{i} * step.size, memory + step.from + size_t{i} * step.from_stride,
                step.size);
  }
}

bool Transfer::read_converted(const Work& work, const uint8_t* memory,
                              const std::function<bool(const Loss&)>& on_loss) {
  const UpdateStep& step = step_of(work);
  for (uint32_t i = 0; i < step.count; ++i) {
    std::span<uint8_t> out(staged_.data() + work.at + size_t{i} * step.size, step.size);
    const uint8_t* source = memory + step.from + size_t{i} * step.from_stride;
    const char* what = conversions_.convert(step, i, source, out);
    if (what != nullptr && !on_loss({work.step, i, what})) return false;
  }
  return true;
}

bool Transfer::read(const uint8_t* memory, const std::function<bool(const Loss&)>& on_loss,
                    const Interrupted& interrupted) {
  for (const Work& work : work_) {
    if (interrupted && interrupted()) return false;
    const UpdateStep& step = step_of(work);
    if (step.kind != StepKind::kConvert) {
      read_values(step, memory, staged_.data() + work.at);
    } else if (!read_converted(work, memory, on_loss)) {
      return false;
    }
  }
  return true;
}

bool Transfer::read_back(const uint8_t* memory, const Transfer& forward,
                         const Interrupted& interrupted) {
  for (const Work& work : work_) {
    if (interrupted && interrupted()) return false;
    const UpdateStep& step = step_of(work);
    uint8_t* out = staged_.data() + work.at;
    switch (step.kind) {
      case StepKind::kCopy:
        read_values(step, memory, out);
        break;
      case StepKind::kConvert:
        read_back_converted(work, memory, forward);
        break;
      case StepKind::kInitialise:
        for (uint32_t i = 0; i < step.count; ++i) {
          forward.earlier(step.to + i * step.to_stride, {out + size_t{i} * step.size, step.size},
                          memory);
        }
        break;
    }
  }
  return true;
}

void Transfer::read_back_converted(const Work& work, const uint8_t* memory,
                                   const Transfer& forward) {
  const UpdateStep& step = step_of(work);
  for (uint32_t i = 0; i < step.count; ++i) {
    std::span<uint8_t> out(staged_.data() + work.at + size_t{i} * step.size, step.size);
    uint32_t from = step.from + i * step.from_stride;
    if (forward.still_as_converted(from, conversions_.source_size(step), memory)) {
      forward.earlier(step.to + i * step.to_stride, out, memory);
    } else {
      conversions_.convert(step, i, memory + from, out);
    }
  }
}

bool Transfer::save(const uint8_t* memory, const Interrupted& interrupted) {
  for (const Work& work : work_) {
    if (interrupted && interrupted()) return false;
    const UpdateStep& step = step_of(work);
    for (uint32_t i = 0; i < step.count; ++i) {
      std::memcpy(saved_.data() + work.at + size_t{i} * step.size,
                  memory + step.to + size_t{i} * step.to_stride, step.size);
    }
  }
  return true;
}

bool Transfer::write(uint8_t* memory, const Interrupted& interrupted) {
  for (size_t done = 0; done < work_.size(); ++done) {
    if (interrupted && interrupted()) {
      restore_first(memory, done);
      return false;
    }
    const UpdateStep& step = step_of(work_[done]);
    for (uint32_t i = 0; i < step.count; ++i) {
      std::memcpy(memory + step.to + size_t{i} * step.to_stride,
                  staged_.data() + work_[done].at + size_t{i} * step.size, step.size);
    }
  }
  return true;
}

void Transfer::restore_first(uint8_t* memory, size_t count) const {
  for (size_t done = 0; done < count; ++done) {
    const UpdateStep& step = step_of(work_[done]);
    for (uint32_t i = 0; i < step.count; ++i) {
      std::memcpy(memory + step.to + size_t{i} * step.to_stride,
                  saved_.data() + work_[done].at + size_t{i} * step.size, step.size);
    }
  }
}

size_t Transfer::first_target(uint32_t offset) const {
  auto found = std::partition_point(targets_.begin(), targets_.end(),
                                    [&](const Target& target) { return target.end() <= offset; });
  return static_cast<size_t>(found - targets_.begin());
}

void Transfer::earlier(uint32_t offset, std::span<uint8_t> out, const uint8_t* memory) const {
  std::memcpy(out.data(), memory + offset, out.size());
  uint64_t end = uint64_t{offset} + out.size();
  for (size_t i = first_target(offset); i < targets_.size() && targets_[i].to < end; ++i) {
    const Target& target = targets_[i];
    uint64_t from = std::max<uint64_t>(target.to, offset);
    uint64_t until = std::min(target.end(), end);
    std::memcpy(out.data() + (from - offset), saved_.data() + target.at + (from - target.to),
                until - from);
  }
}

bool Transfer::still_as_converted(uint32_t offset, uint32_t size, const uint8_t* memory) const {
  size_t at = first_target(offset);
  if (at == targets_.size() || targets_[at].to != offset) return false;
  const Target& target = targets_[at];
  return target.converted && target.size == size &&
         std::memcmp(memory + offset, staged_.data() + target.at, size) == 0;
}

}  // namespace online_change
