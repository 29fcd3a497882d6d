// Outputs of a simulated device over time, to CSV: a row whenever one changes. When a change of the
// program adds outputs, a new header stands before the rows that have them.
#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/bytes.h"
#include "vm/io/driver.h"

namespace vm {

class CsvOutputs {
 public:
  // kDeviceFailed when the file cannot be written.
  static base::Result<std::unique_ptr<CsvOutputs>> open(const std::string& file);
  CsvOutputs(std::string name, std::FILE* file) : name_(std::move(name)), file_(file) {}
  base::Status write(const DevicePoints& points, base::ByteSpan outputs, int64_t now_ns);

 private:
  struct Column {
    ir::DirectAddress at;
    uint64_t value = 0;
  };
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  bool store(const ir::DirectAddress& at, uint64_t value);
  void header();
  void row(int64_t now_ns);

  std::string name_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<Column> columns_;
  bool grown_ = false;
};

}  // namespace vm
