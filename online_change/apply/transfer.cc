#include "online_change/apply/transfer.h"

#include <algorithm>
#include <cstring>

namespace online_change {
namespace {

// `count` values of `size` bytes, `stride` apart, to or from a place without gaps.
void gather(const uint8_t* from, const UpdateStep& step, uint32_t stride, uint8_t* out) {
  if (step.count == 1 || stride == step.size) {
    std::memcpy(out, from, step.total());
    return;
  }
  for (uint32_t i = 0; i < step.count; ++i) {
    std::memcpy(out + size_t{i} * step.size, from + size_t{i} * stride, step.size);
  }
}

void scatter(const uint8_t* from, const UpdateStep& step, uint8_t* memory) {
  uint8_t* to = memory + step.to;
  if (step.count == 1 || step.to_stride == step.size) {
    std::memcpy(to, from, step.total());
    return;
  }
  for (uint32_t i = 0; i < step.count; ++i) {
    std::memcpy(to + size_t{i} * step.to_stride, from + size_t{i} * step.size, step.size);
  }
}

}  // namespace

Transfer::Transfer(const Plan& plan, const ir::Image& from, const ir::Image& to, Steps which)
    : plan_(plan), conversions_(from, to) {
  size_t bytes = 0;
  for (uint32_t number = 0; number < plan.steps.size(); ++number) {
    const UpdateStep& step = plan.steps[number];
    if (which == Steps::kBoundary && step.early) continue;
    bool converts = step.kind == StepKind::kConvert;
    work_.push_back({number, bytes, converts ? conversions_.fast(step) : nullptr});
    for (uint32_t i = 0; i < step.count; ++i) {
      targets_.push_back(
          {step.to + i * step.to_stride, step.size, bytes + size_t{i} * step.size, converts});
    }
    bytes += step.total();
  }
  auto by_place = [](const Target& a, const Target& b) { return a.to < b.to; };
  if (!std::is_sorted(targets_.begin(), targets_.end(), by_place)) {
    std::sort(targets_.begin(), targets_.end(), by_place);
  }
  staged_.resize(bytes);
  saved_.resize(bytes);
  if (which == Steps::kAll) remembered_.resize(bytes);
}

void Transfer::touch(uint8_t* memory) const {
  constexpr uint64_t kPage = 4096;
  uint64_t next = 0;
  for (const Target& target : targets_) {
    for (uint64_t at = std::max<uint64_t>(target.to, next); at < target.end();) {
      volatile uint8_t* byte = memory + at;
      *byte = *byte;
      next = (at / kPage + 1) * kPage;
      at = next;
    }
  }
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
  gather(memory + step.from, step, step.from_stride, out);
}

bool Transfer::read_converted(const Work& work, const uint8_t* memory,
                              const std::function<bool(const Loss&)>& on_loss) {
  const UpdateStep& step = step_of(work);
  for (uint32_t i = 0; i < step.count; ++i) {
    const uint8_t* source = memory + step.from + size_t{i} * step.from_stride;
    uint8_t* to = staged_.data() + work.at + size_t{i} * step.size;
    if (work.fast != nullptr) {
      i += static_cast<uint32_t>(work.fast({source, step.from_stride, to, step.count - i}));
      if (i == step.count) return true;
      source = memory + step.from + size_t{i} * step.from_stride;
      to = staged_.data() + work.at + size_t{i} * step.size;
    }
    const char* what = conversions_.convert(step, i, source, {to, step.size});
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

bool Transfer::remember(const uint8_t* memory, const Interrupted& interrupted) {
  for (const Work& work : work_) {
    const UpdateStep& step = step_of(work);
    if (step.kind == StepKind::kCopy) continue;
    if (interrupted && interrupted()) return false;
    gather(memory + step.to, step, step.to_stride, remembered_.data() + work.at);
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
        std::memcpy(out, remembered_.data() + work.at, step.total());
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
      std::memcpy(out.data(), remembered_.data() + work.at + size_t{i} * step.size, step.size);
    } else {
      conversions_.convert(step, i, memory + from, out);
    }
  }
}

bool Transfer::save(const uint8_t* memory, const Interrupted& interrupted) {
  for (const Work& work : work_) {
    if (interrupted && interrupted()) return false;
    const UpdateStep& step = step_of(work);
    gather(memory + step.to, step, step.to_stride, saved_.data() + work.at);
  }
  return true;
}

bool Transfer::write(uint8_t* memory, const Interrupted& interrupted) {
  for (size_t done = 0; done < work_.size(); ++done) {
    if (interrupted && interrupted()) {
      restore_first(memory, done);
      return false;
    }
    scatter(staged_.data() + work_[done].at, step_of(work_[done]), memory);
  }
  return true;
}

void Transfer::restore_first(uint8_t* memory, size_t count) const {
  for (size_t done = 0; done < count; ++done) {
    scatter(saved_.data() + work_[done].at, step_of(work_[done]), memory);
  }
}

size_t Transfer::first_target(uint32_t offset, size_t& hint) const {
  auto is_first = [&](size_t i) {
    return i < targets_.size() && targets_[i].end() > offset &&
           (i == 0 || targets_[i - 1].end() <= offset);
  };
  if (is_first(hint)) return hint;
  if (is_first(hint + 1)) return ++hint;
  auto found = std::partition_point(targets_.begin(), targets_.end(),
                                    [&](const Target& target) { return target.end() <= offset; });
  return hint = static_cast<size_t>(found - targets_.begin());
}

bool Transfer::still_as_converted(uint32_t offset, uint32_t size, const uint8_t* memory) const {
  size_t at = first_target(offset, converted_hint_);
  if (at == targets_.size() || targets_[at].to != offset) return false;
  const Target& target = targets_[at];
  return target.converted && target.size == size &&
         std::memcmp(memory + offset, staged_.data() + target.at, size) == 0;
}

}  // namespace online_change
