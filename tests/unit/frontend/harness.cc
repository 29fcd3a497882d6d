#include "tests/unit/frontend/harness.h"

#include <gtest/gtest.h>

#include <bit>

#include "ir/program/text.h"
#include "ir/program/verify.h"

namespace frontend_test {
namespace {

std::string codes(const std::vector<base::Diagnostic>& messages, base::Severity severity) {
  std::string out;
  for (const base::Diagnostic& message : messages) {
    const base::DiagnosticRow& row = base::diagnostic_row(message.code);
    if (row.severity == severity) out += (out.empty() ? "" : " ") + std::string(row.code);
  }
  return out;
}

}  // namespace

bool Compiled::has(std::string_view code) const {
  for (const base::Diagnostic& message : messages) {
    if (base::diagnostic_row(message.code).code == code) return true;
  }
  return false;
}

std::string Compiled::errors() const { return codes(messages, base::Severity::kError); }
std::string Compiled::warnings() const { return codes(messages, base::Severity::kWarning); }

Compiled compile_sources(base::SourceMap& sources, frontend::Dialect dialect) {
  base::Diagnostics diagnostics;
  frontend::CompileOptions options;
  options.dialect = dialect;
  Compiled out;
  out.program = frontend::compile(sources, options, diagnostics);
  diagnostics.sort();
  out.messages = diagnostics.all();
  out.text = base::render(diagnostics, sources, base::DiagnosticFormat::kText, false);
  EXPECT_EQ(out.program.has_value(), !diagnostics.has_errors()) << out.text;
  if (out.program) {
    base::Status status = ir::verify(*out.program);
    EXPECT_TRUE(status.ok()) << (status.ok() ? "" : status.error().text) << ir::print(*out.program);
  }
  return out;
}

Compiled compile(std::string source, frontend::Dialect dialect) {
  base::SourceMap sources;
  sources.add("test.st", std::move(source));
  return compile_sources(sources, dialect);
}

Compiled compile_files(std::vector<std::string> files) {
  base::SourceMap sources;
  for (size_t i = 0; i < files.size(); ++i) {
    sources.add("file" + std::to_string(i) + ".st", std::move(files[i]));
  }
  return compile_sources(sources, frontend::Dialect::kCodesys);
}

Controlled::Controlled(const std::string& source) : compiled_(compile(source)) {
  if (!compiled_.program) {
    problem_ = compiled_.text;
    ADD_FAILURE() << compiled_.text;
    return;
  }
  evaluator_ = std::make_unique<ir::Evaluator>(*compiled_.program);
}

std::string Controlled::scan(int count) {
  if (!evaluator_) return problem_;
  for (int i = 0; i < count; ++i) {
    auto traps = evaluator_->scan(now_, 1'000'000);
    now_ += 10'000'000;
    if (!traps.empty()) return ir::trap_name(traps[0].kind);
  }
  return "";
}

int64_t Controlled::number(const std::string& path) {
  if (!evaluator_) return -1;
  auto bits = evaluator_->bits(path);
  if (!bits.ok()) ADD_FAILURE() << bits.error().text;
  return bits.ok() ? static_cast<int64_t>(*bits) : -1;
}

double Controlled::real(const std::string& path) {
  return static_cast<double>(std::bit_cast<float>(static_cast<uint32_t>(number(path))));
}

double Controlled::lreal(const std::string& path) { return std::bit_cast<double>(number(path)); }

std::string Controlled::text(const std::string& path) {
  if (!evaluator_) return "";
  auto text = evaluator_->string(path);
  if (!text.ok()) ADD_FAILURE() << text.error().text;
  return text.ok() ? *text : "";
}

void Controlled::set(const std::string& path, int64_t value) {
  if (!evaluator_) return;
  base::Status status = evaluator_->set_bits(path, static_cast<uint64_t>(value));
  if (!status.ok()) ADD_FAILURE() << status.error().text;
}

}  // namespace frontend_test
