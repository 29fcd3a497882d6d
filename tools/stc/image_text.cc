#include "tools/stc/image_text.h"

#include "ir/bytecode/symbols.h"
#include "ir/types/address_text.h"
#include "tools/common/table.h"

namespace stc {
namespace {

std::string number(uint64_t value) { return std::to_string(value); }

std::string instances_text(const ir::Image& image) {
  tools::Table table({"> id", "instance", "type", "> data", "> used", "> area"});
  for (uint32_t id = 0; id < image.instances.size(); ++id) {
    const ir::Instance& row = image.instances[id];
    if (!row.live) {
      table.row({number(id), "(free)"});
      continue;
    }
    const ir::TypeLayout& layout = image.layouts[row.type];
    table.row({number(id), id == 0 ? "(globals)" : image.instance_path(id),
               image.types.text(row.type), number(row.data), number(layout.used),
               number(layout.area_capacity)});
  }
  return table.text();
}

std::string pous_text(const ir::Image& image) {
  tools::Table table({"POU", "> units", "> frame", "identity"});
  for (const ir::LinkedPou& pou : image.pous) {
    table.row(
        {pou.name, number(pou.unit_count), number(pou.frame_size), base::short_hex(pou.identity)});
  }
  return table.text();
}

// Attributes that differ from the default.
std::string policies_text(const ir::Image& image) {
  tools::Table table({"task", "attribute", "value"});
  bool any = false;
  for (const ir::ImageTask& task : image.tasks) {
    for (const ir::TaskChoice& choice : ir::task_choices()) {
      if (!choice.holds(task.policy) || choice.holds(ir::TaskPolicy{})) continue;
      table.row({task.name, std::string(choice.attribute), std::string(choice.text)});
      any = true;
    }
  }
  return any ? table.text() : "";
}

std::string tasks_text(const ir::Image& image) {
  tools::Table table({"task", "> period us", "> priority", "programs"});
  for (const ir::ImageTask& task : image.tasks) {
    std::string programs;
    for (uint32_t id : task.programs) {
      programs += (programs.empty() ? "" : ", ") + image.instance_path(id);
    }
    std::string period =
        task.period_ns == 0 ? "event" : number(static_cast<uint64_t>(task.period_ns / 1000));
    if (task.once) period = "once";
    if (task.policy.freewheeling) period = "free";
    table.row({task.name, period, number(task.priority), programs});
  }
  const bool usual = image.schedule == ir::Schedule::kSendFirst;
  const std::string schedule = "schedule " + std::string(ir::schedule_text(image.schedule)) + "\n";
  return (usual ? "" : schedule) + table.text() + policies_text(image);
}

std::string overrides_text(const ir::Image& image) {
  tools::Table table({"virtual call", "of", "runs"});
  for (const ir::LinkedOverride& row : image.overrides) {
    table.row(
        {image.pous[row.prototype].name, image.types.text(row.type), image.pous[row.target].name});
  }
  return table.text();
}

// Settings in their order, then a line for each map entry.
std::string devices_text(const ir::Image& image) {
  tools::Table table({"device", "driver", "map and settings"});
  for (const ir::Device& device : image.devices) {
    table.row({device.name, device.driver, ""});
    for (const ir::DeviceSetting& row : device.settings) {
      table.row({"", "", row.key + " = " + row.value});
    }
    for (const ir::DeviceMapping& row : device.map) table.row({"", "", ir::mapping_text(row)});
    if (device.quality.area == ir::DirectArea::kNone) continue;
    table.row({"", "", "quality -> " + ir::address_text(device.quality)});
  }
  return table.text();
}

std::string memory_text(const ir::Image& image) {
  uint64_t free_bytes = 0;
  for (const ir::Extent& extent : image.free) free_bytes += extent.size;
  return "data memory " + number(image.data_capacity) + " bytes, free " + number(free_bytes) +
         " in " + number(image.free.size()) + " piece(s); constants " + number(image.pool.size()) +
         "; stack " + number(image.stack_bytes) + " bytes, " + number(image.call_depth) +
         " calls deep\n";
}

}  // namespace

std::string layout_text(const ir::Image& image) {
  return memory_text(image) + tasks_text(image) + instances_text(image) + symbols_text(image);
}

std::string image_text(const ir::Image& image, const base::Digest& digest) {
  return image.name + " " + base::to_hex(digest) + "\n" + memory_text(image) + "\n" +
         tasks_text(image) + "\n" + instances_text(image) + "\n" + pous_text(image) +
         (image.overrides.empty() ? "" : "\n" + overrides_text(image)) +
         (image.devices.empty() ? "" : "\n" + devices_text(image));
}

std::string symbols_text(const ir::Image& image) {
  std::string out;
  ir::for_each_leaf(image, [&](const std::string& path, const ir::Symbol& symbol) {
    out += path + " : " + ir::type_text(image, symbol) + " @ " + number(symbol.data) +
           (symbol.retain ? " RETAIN\n" : "\n");
  });
  return out;
}

}  // namespace stc
