#include "tools/stvm/trace.h"

#include <cerrno>
#include <cstring>

namespace stvm {
namespace {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string out = "\"";
  for (char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + "\"";
}

void split_into(std::vector<std::string>& names, const std::string& list) {
  std::string name;
  int depth = 0;
  for (char c : list) {
    depth += c == '[' ? 1 : c == ']' ? -1 : 0;
    if (c == ',' && depth <= 0) {
      if (!name.empty()) names.push_back(std::move(name));
      name.clear();
    } else {
      name += c;
    }
  }
  if (!name.empty()) names.push_back(std::move(name));
}

}  // namespace

std::vector<std::string> split_names(const std::vector<std::string>& lists) {
  std::vector<std::string> names;
  for (const std::string& list : lists) split_into(names, list);
  return names;
}

base::Result<std::vector<Assignment>> parse_assignments(const std::vector<std::string>& texts) {
  std::vector<Assignment> out;
  for (const std::string& text : texts) {
    size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos) {
      return base::Error{base::Refusal::kUsage, "`" + text + "` is not NAME=VALUE"};
    }
    out.push_back({text.substr(0, equals), text.substr(equals + 1)});
  }
  return out;
}

base::Result<Trace> Trace::open(const std::string& path, const ir::Image& image,
                                std::vector<std::string> names) {
  if (names.empty()) {
    ir::for_each_leaf(image, [&](const std::string& leaf, const ir::Symbol& symbol) {
      if (!symbol.constant) names.push_back(leaf);
    });
  }
  std::FILE* file = std::fopen(path.c_str(), "w");
  if (file == nullptr) {
    return base::Error{base::Refusal::kFileUnwritable, path + ": " + std::strerror(errno)};
  }
  std::fputs("scan", file);
  for (const std::string& name : names) std::fprintf(file, ",%s", csv_field(name).c_str());
  std::fputs("\n", file);
  return Trace(file, std::move(names));
}

Trace::~Trace() {
  if (file_ != nullptr) std::fclose(file_);
}

base::Status Trace::write(const vm::Controller& controller) {
  std::fprintf(file_, "%llu", static_cast<unsigned long long>(controller.cycles()));
  for (const std::string& name : names_) {
    base::Result<std::string> value = controller.get(name);
    if (!value.ok()) return value.error();
    std::fprintf(file_, ",%s", csv_field(*value).c_str());
  }
  std::fputs("\n", file_);
  return base::Ok{};
}

base::Status Trace::close() {
  bool failed = std::ferror(file_) != 0;
  failed = std::fclose(std::exchange(file_, nullptr)) != 0 || failed;
  if (failed) return base::Error{base::Refusal::kFileUnwritable, "the trace is not complete"};
  return base::Ok{};
}

}  // namespace stvm
