// X9: sources that travel with an image: what is put in comes back, one image has one stored form,
// and what no tool may write or unpack is refused before an image runs.
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "base/pack.h"
#include "base/tool_limits.h"
#include "ir/bytecode/embedded_sources.h"
#include "ir/bytecode/image_beside.h"
#include "ir/bytecode/image_sections.h"
#include "ir/bytecode/verify.h"
#include "tests/unit/bytecode/sample_image.h"

namespace {

using base::Refusal;

ir::EmbeddedSources two_files() {
  return *ir::pack_sources({{"src/main.st", "PROGRAM Main END_PROGRAM"}, {"a.st", "(* a *)"}},
                           {"--name=plant"});
}

base::Bytes with_sources(const ir::EmbeddedSources& sources = two_files()) {
  return ir::encode(sample::busy_image(), nullptr, ir::encode_sources(sources)).bytes;
}

TEST(EmbeddedSources, X9_ComeBackAsTheyWere) {
  const base::Bytes bytes = with_sources();
  const auto image = ir::verify(bytes);
  ASSERT_TRUE(image.ok()) << image.error().text;
  EXPECT_EQ(ir::encode(image->image()), ir::encode(sample::busy_image()));
  const auto sources = ir::sources_of(image->encoded());
  ASSERT_TRUE(sources.ok()) << sources.error().text;
  EXPECT_EQ(sources->build, std::vector<std::string>{"--name=plant"});
  const auto texts = ir::unpack_sources(*sources);
  ASSERT_TRUE(texts.ok()) << texts.error().text;
  ASSERT_EQ(texts->size(), 2u);
  EXPECT_EQ((*texts)[0].path, "a.st");
  EXPECT_EQ((*texts)[0].text, "(* a *)");
  EXPECT_EQ((*texts)[1].path, "src/main.st");
  EXPECT_EQ((*texts)[1].text, "PROGRAM Main END_PROGRAM");
  EXPECT_EQ(with_sources(*sources), bytes);
  EXPECT_TRUE(ir::sources_of(ir::encode(sample::busy_image()))->none());
}

// Beside a version that is known, too; the digest covers them.
TEST(EmbeddedSources, X9_TheSameBesideAnotherVersion) {
  const base::Bytes plain = ir::encode(sample::busy_image());
  for (const base::Bytes& known : {plain, with_sources()}) {
    const auto before = ir::decode(known, nullptr);
    ASSERT_TRUE(before.ok());
    const ir::KnownImage beside{before->image, known, before->places};
    const auto made =
        ir::encode(before->image, &beside, ir::encode_sources(two_files()));
    EXPECT_EQ(made.bytes, with_sources());
    EXPECT_EQ(ir::encode(before->image, &beside).bytes, plain);
    const auto after = ir::decode(made.bytes, &beside);
    ASSERT_TRUE(after.ok()) << after.error().text;
    EXPECT_EQ(ir::encode(after->image), plain);
  }
  ir::EmbeddedSources other = two_files();
  other.files[0].digest[0] ^= 1;
  EXPECT_NE(ir::digest(with_sources()), ir::digest(with_sources(other)));
}

// Only images with sources are of the version that older controllers refuse.
TEST(EmbeddedSources, X9_OneStoredForm) {
  constexpr size_t kVersionAt = 8;
  const base::Bytes usual = ir::encode(sample::busy_image());
  base::Bytes bytes = with_sources();
  EXPECT_EQ(usual[kVersionAt], 7);
  EXPECT_EQ(bytes[kVersionAt], 10);
  EXPECT_EQ(ir::section_of(usual, ir::ImageSection::kSources).data(), nullptr);
  EXPECT_FALSE(ir::section_of(bytes, ir::ImageSection::kSources).empty());
  for (const uint8_t version : {7, 8, 9, 11}) {
    bytes[kVersionAt] = version;
    EXPECT_EQ(ir::decode(bytes).error().refusal, Refusal::kBadFormat) << int{version};
  }
  // A section of no sources, and one with bytes behind them.
  const base::Bytes none(12, 0);
  EXPECT_EQ(ir::decode(ir::encode(sample::busy_image(), nullptr, none).bytes).error().refusal,
            Refusal::kBadSources);
  base::Bytes longer = ir::encode_sources(two_files());
  longer.push_back(0);
  EXPECT_EQ(ir::decode(ir::encode(sample::busy_image(), nullptr, longer).bytes).error().refusal,
            Refusal::kBadSources);
  base::Bytes old = usual;  // of a version that has the section, without it
  old[kVersionAt] = 10;
  EXPECT_EQ(ir::decode(old).error().refusal, Refusal::kBadFormat);
}

TEST(EmbeddedSources, X9_EveryTruncationAndBitFlipIsRefused) {
  base::Bytes bytes = with_sources();
  const size_t begin = bytes.size() - ir::section_of(bytes, ir::ImageSection::kSources).size() - 8;
  for (size_t length = begin; length < bytes.size(); ++length) {
    ASSERT_FALSE(ir::decode(base::ByteSpan(bytes).first(length)).ok()) << length;
  }
  for (size_t bit = begin * 8; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
    ASSERT_FALSE(ir::decode(bytes).ok()) << "bit " << bit;
    bytes[bit / 8] ^= static_cast<uint8_t>(1u << bit % 8);
  }
}

TEST(EmbeddedSources, X9_PathsLeadBelowTheFolder) {
  for (const char* path : {"a.st", "src/a.st", "src/deep/a b.st", "\xc3\xa4.st", "a..b/c"}) {
    EXPECT_TRUE(ir::is_path_below(path)) << path;
  }
  for (const char* path : {"", "/a.st", "/", "..", "../a.st", "a/../b.st", "a/..", ".", "./a.st",
                           "a/./b", "a//b", "a/", ".git/config", "a/.profile", "a\nb", "a\x1b[2J",
                           "a\x7f"}) {
    EXPECT_FALSE(ir::is_path_below(path)) << path;
  }
  EXPECT_FALSE(ir::is_path_below(std::string_view("a\0b", 3)));
  EXPECT_TRUE(ir::is_path_below(std::string(base::kMaxEmbeddedPath, 'a')));
  EXPECT_FALSE(ir::is_path_below(std::string(base::kMaxEmbeddedPath + 1, 'a')));
}

TEST(EmbeddedSources, X9_HostileImagesAreRefused) {
  ASSERT_TRUE(ir::verify(with_sources()).ok());
  const auto refused = [](const char* what, const std::function<void(ir::EmbeddedSources&)>& edit) {
    ir::EmbeddedSources sources = two_files();
    edit(sources);
    const auto verified = ir::verify(with_sources(sources));
    ASSERT_FALSE(verified.ok()) << what;
    EXPECT_EQ(verified.error().refusal, Refusal::kBadSources) << verified.error().text;
    EXPECT_FALSE(verified.error().text.empty());
  };
  refused("out of the folder", [](auto& s) { s.files[0].path = "../a.st"; });
  refused("absolute", [](auto& s) { s.files[0].path = "/etc/a.st"; });
  refused("hidden", [](auto& s) { s.files[0].path = ".profile"; });
  refused("twice", [](auto& s) { s.files[0].path = s.files[1].path; });
  refused("not sorted", [](auto& s) { std::swap(s.files[0], s.files[1]); });
  refused("a folder and a file", [](auto& s) { s.files[0].path = "src"; });
  refused("one byte more", [](auto& s) { ++s.files[0].size; });
  refused("more than the limit", [](auto& s) { s.files[0].size = 0xffffffffu; });
  refused("a bomb", [](auto& s) { s.packed = {0x1f, 'a', 0xff, 0xff, 0xff, 0xff, 0x3f, 0x01}; });
  refused("cut off", [](auto& s) { s.packed.pop_back(); });
  refused("nothing packed", [](auto& s) { s.packed.clear(); });
  refused("an argument that leads out", [](auto& s) { s.build = {"../x"}; });
  refused("an argument that is no option", [](auto& s) { s.build = {"-o"}, s.build[0] += "\n"; });
  refused("an option that writes on terminals", [](auto& s) { s.build = {"--name=\x1b[2J"}; });
  refused("very many arguments", [](auto& s) { s.build.assign(2000, "--x"); });
}

// A controller does not look into what is packed; a tool does.
TEST(EmbeddedSources, X9_ATextThatIsAnotherIsTold) {
  ir::EmbeddedSources sources = two_files();
  sources.files[0].digest[0] ^= 1;
  EXPECT_TRUE(ir::check_sources(sources).ok());
  EXPECT_EQ(ir::unpack_sources(sources).error().refusal, Refusal::kBadSources);
}

// Any bytes in the place of the section: refused, or of paths and sizes that tools can rely on.
TEST(EmbeddedSources, X9_MutantsAreRefusedOrBounded) {
  std::mt19937 random(7);
  const base::Bytes good = ir::encode_sources(two_files());
  uint32_t accepted = 0;
  for (int tried = 0; tried < 100'000; ++tried) {
    base::Bytes bytes = good;
    for (uint32_t changes = 1 + random() % 3; changes != 0; --changes) {
      const size_t at = random() % bytes.size();
      if (random() % 8 == 0) {
        bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(at));
      } else if (random() % 8 == 0) {
        const auto byte = static_cast<uint8_t>(random());
        bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(at), byte);
      } else {
        bytes[at] = static_cast<uint8_t>(random());
      }
    }
    const auto sources = ir::decode_sources(bytes);
    if (!sources.ok()) {
      ASSERT_EQ(sources.error().refusal, Refusal::kBadSources);
      continue;
    }
    ++accepted;
    ASSERT_EQ(ir::encode_sources(*sources), bytes) << "one stored form";
    uint64_t size = 0;
    for (const ir::SourceFile& file : sources->files) {
      ASSERT_TRUE(ir::is_path_below(file.path)) << file.path;
      size += file.size;
    }
    ASSERT_LE(size, base::kMaxEmbeddedBytes);
    ASSERT_EQ(base::unpack(sources->packed, size)->size(), size);
    (void)ir::unpack_sources(*sources);
  }
  EXPECT_GT(accepted, 1000u);
}

TEST(EmbeddedSources, X9_LimitsHaveANameAndARefusal) {
  std::string large(base::kMaxEmbeddedBytes, ' ');
  const auto packed = ir::pack_sources({{"a.st", large}}, {});
  ASSERT_TRUE(packed.ok()) << packed.error().text;
  EXPECT_LT(packed->packed.size(), 20000u);
  EXPECT_TRUE(ir::check_sources(*packed).ok());
  const auto more = ir::pack_sources({{"a.st", std::move(large)}, {"b.st", " "}}, {});
  EXPECT_EQ(more.error().refusal, Refusal::kTooMany);
  EXPECT_NE(more.error().text.find("kMaxEmbeddedBytes"), std::string::npos) << more.error().text;

  const std::string name(base::kMaxEmbeddedPath, 'a');
  EXPECT_TRUE(ir::pack_sources({{name, ""}}, {}).ok());
  EXPECT_EQ(ir::pack_sources({{name + "a", ""}}, {}).error().refusal, Refusal::kTooMany);

  std::vector<ir::SourceText> many;
  for (uint32_t i = 0; i < base::kMaxEmbeddedFiles; ++i) many.push_back({std::to_string(i), ""});
  EXPECT_TRUE(ir::pack_sources(many, {}).ok());
  many.push_back({"x", ""});
  EXPECT_EQ(ir::pack_sources(many, {}).error().refusal, Refusal::kTooMany);
}

}  // namespace
