#include "bench/plain_method.h"

#include <chrono>
#include <cstring>
#include <string>
#include <unordered_map>

#include "online_change/diff/value_conversion.h"

namespace bench {
namespace {

int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// As in ConstValue.
uint64_t load(const ir::Image& image, ir::TypeId type, const uint8_t* at) {
  const ir::Scalar scalar = image.types.scalar(type);
  const uint32_t size = ir::scalar_size(scalar);
  uint64_t bits = 0;
  std::memcpy(&bits, at, size);
  if (!ir::is_signed(scalar) || size == 8) return bits;
  const uint32_t unused = 64 - size * 8;
  return static_cast<uint64_t>(static_cast<int64_t>(bits << unused) >> unused);
}

}  // namespace

PlainMethod::PlainMethod(vm::Controller& controller, const ir::VerifiedImage& next)
    : controller_(controller), old_(controller.verified()), next_(next) {
  const ir::Image& old_image = old_.image();
  const ir::Image& new_image = next_.image();
  std::unordered_map<std::string, ir::Symbol> old_symbols;
  ir::for_each_leaf(old_image, [&](const std::string& path, const ir::Symbol& symbol) {
    if (old_image.types.is_scalar(symbol.type) && !symbol.constant) old_symbols[path] = symbol;
  });
  ir::for_each_leaf(new_image, [&](const std::string& path, const ir::Symbol& symbol) {
    const auto found = old_symbols.find(path);
    if (found == old_symbols.end() || !new_image.types.is_scalar(symbol.type)) return;
    const ir::TypeId type = found->second.type;
    const bool same = old_image.types.text(type) == new_image.types.text(symbol.type);
    values_.push_back({found->second, symbol, old_image.layouts[type].size, saved_.size(), same});
    saved_.resize(saved_.size() + old_image.layouts[type].size);
  });
  prepared_ = *controller.prepare(next);
}

void PlainMethod::save() {
  const uint8_t* memory = controller_.memory().data();
  for (const Value& value : values_) {
    std::memcpy(saved_.data() + value.at, memory + value.from.data, value.size);
  }
}

void PlainMethod::restore() {
  uint8_t* memory = controller_.memory().data();
  const ir::Image& old_image = old_.image();
  const ir::Image& new_image = next_.image();
  for (const Value& value : values_) {
    if (value.same_type) {
      std::memcpy(memory + value.to.data, saved_.data() + value.at, value.size);
      continue;
    }
    const uint64_t bits = load(old_image, value.from.type, saved_.data() + value.at);
    const online_change::Converted converted = online_change::convert_scalar(
        old_image.types, value.from.type, new_image.types, value.to.type, bits);
    const uint32_t size = new_image.layouts[value.to.type].size;
    if (!converted.initialise) std::memcpy(memory + value.to.data, &converted.bits, size);
  }
}

int64_t PlainMethod::make_switch() {
  const int64_t begin = now_ns();
  save();
  prepared_ = controller_.publish(std::move(prepared_));
  const ir::Image& image = next_.image();
  uint8_t* memory = controller_.memory().data();
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (id != 0 && !row.live) continue;
    std::memset(memory + row.data, 0, image.layouts[row.type].used);
  }
  vm::write_initial_data(image, memory);
  restore();
  controller_.construct();
  return now_ns() - begin;
}

}  // namespace bench
