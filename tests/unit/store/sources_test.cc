// X9: sources that travel with a program: a controller hands them out at no boundary, a version
// that differs in them alone is a change that touches no value, and they are stored with it.
#include <gtest/gtest.h>

#include <random>

#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/image_beside.h"
#include "tools/common/source_edits.h"
#include "tests/unit/store/plc.h"
#include "tests/unit/store/sim_storage.h"

namespace plc {
namespace {

constexpr const char* kProgram = "PROGRAM P VAR n, kept : DINT; END_VAR n := n + 1; END_PROGRAM";

ir::VerifiedImage with_sources(std::vector<ir::SourceText> files,
                               std::vector<std::string> build_options = {"--name=plant"}) {
  const base::Bytes section =
      ir::encode_sources(*ir::pack_sources(std::move(files), std::move(build_options)));
  return *ir::verify(ir::encode(build(kProgram).image(), nullptr, section).bytes);
}

std::string noise(size_t bytes) {
  std::mt19937 random(1);
  std::string out(bytes, ' ');
  for (char& c : out) c = static_cast<char>(random());
  return out;
}

TEST(Sources, X9_AreHandedOutAtNoBoundary) {
  sim::SimStorage disk;
  Plc plc(disk);
  const ir::VerifiedImage image = with_sources({{"a.st", noise(700'000)}, {"b.st", "(* b *)"}});
  ASSERT_TRUE(plc.boot(std::optional(image)).ok());
  int jobs = 0;
  plc.at_boundary = [&] {
    ++jobs;
    return vm::Boundary::Outcome::kDone;
  };
  base::Bytes all;
  for (uint64_t total = 1; all.size() < total;) {
    const auto body = plc.answer_to({.command = vm::Command::kImage, .offset = all.size()});
    ASSERT_TRUE(body.ok()) << body.error().text;
    const auto part = vm::decode_image_part(*body);
    ASSERT_TRUE(part.ok());
    EXPECT_LE(part->bytes.size(), vm::kChunkBytes);
    total = part->total;
    all.insert(all.end(), part->bytes.begin(), part->bytes.end());
  }
  EXPECT_GT(all.size(), size_t{vm::kChunkBytes});
  EXPECT_EQ(jobs, 0);
  const auto texts = ir::unpack_sources(*ir::sources_of(all));
  ASSERT_TRUE(texts.ok());
  EXPECT_EQ((*texts)[1].text, "(* b *)");
}

TEST(Sources, X9_AloneAreAChangeThatTouchesNoValue) {
  sim::SimStorage disk;
  Plc plc(disk);
  const ir::VerifiedImage first = with_sources({{"a.st", "(* one *)"}, {"old.st", ""}});
  const ir::VerifiedImage second = with_sources({{"a.st", "(* two *)"}, {"new.st", ""}});
  ASSERT_NE(first.digest(), second.digest());
  ASSERT_TRUE(plc.boot(std::optional(first)).ok());
  plc.run(7);
  plc.set("P.kept", "42");
  int scans = 7;  // so many at least have counted; cycles go on while a change is made
  const auto goes_on = [&] {
    EXPECT_EQ(plc.get("P.kept"), "42");
    EXPECT_GE(std::stoi(plc.get("P.n")), scans);
    scans = std::stoi(plc.get("P.n"));
  };
  ASSERT_TRUE(plc.change(second, 0).ok());  // nothing is allowed to be lost
  goes_on();
  EXPECT_EQ(plc.controller().verified().digest(), second.digest());
  plc.run(3);
  ASSERT_TRUE(plc.undo().ok());
  goes_on();
  EXPECT_EQ(plc.controller().verified().digest(), first.digest());
  ASSERT_TRUE(plc.change(second, 0).ok());
  ASSERT_TRUE(plc.accept().ok());
  goes_on();
  EXPECT_EQ(plc.change(second, 0).error().refusal, base::Refusal::kNoChange);

  Plc again(disk);
  ASSERT_TRUE(again.boot().ok());
  const ir::EmbeddedSources stored = *ir::sources_of(again.controller().verified().encoded());
  ASSERT_EQ(stored.files.size(), 2u);
  EXPECT_EQ((*ir::unpack_sources(stored))[0].text, "(* two *)");
}

std::vector<std::string> rows(const ir::VerifiedImage& from, const ir::VerifiedImage& to) {
  std::vector<std::string> out;
  for (const auto& edit : tools::source_edits(from.encoded(), to.encoded())) {
    out.push_back(edit.kind + " " + edit.name + " " + edit.what);
  }
  return out;
}

TEST(Sources, X9_X1_NothingThatHappensToThemIsSilent) {
  const ir::VerifiedImage none = build(kProgram);
  const ir::VerifiedImage first = with_sources({{"a.st", "1"}, {"b.st", ""}, {"old.st", ""}});
  const ir::VerifiedImage second = with_sources({{"a.st", "2"}, {"b.st", ""}, {"new.st", ""}});
  using Rows = std::vector<std::string>;
  EXPECT_EQ(rows(first, first), Rows{});
  EXPECT_EQ(rows(none, none), Rows{});
  EXPECT_EQ(rows(first, second),
            (Rows{"source a.st edited", "source old.st removed", "source new.st new"}));
  EXPECT_EQ(rows(none, first),
            Rows{"source 3 files travel with the program from now on"});
  EXPECT_EQ(rows(first, none),
            Rows{"source 3 files travel with the program no longer"});
  const ir::VerifiedImage other =
      with_sources({{"a.st", "1"}, {"b.st", ""}, {"old.st", ""}}, {"--name=mill"});
  EXPECT_EQ(rows(first, other), Rows{"source options of the build differ"});
  std::vector<ir::SourceText> many;
  for (int i = 0; i < 40; ++i) many.push_back({"f" + std::to_string(i), ""});
  const Rows all = rows(first, with_sources(many));
  ASSERT_EQ(all.size(), 12u);
  EXPECT_EQ(all.back(), "source 32 files more `stc diff --text` shows all");
}

}  // namespace
}  // namespace plc
