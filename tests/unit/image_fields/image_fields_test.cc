// Every field of the stored form of images, and every list of records, has a rule of the verifier
// that bounds it, or a reason why any value of it is harmless (fields.def). The fields are those
// that the archives of images go through (tests/fuzz/image_walk.h), so one that is added to the
// format has no row and fails here.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>
#include <vector>

#include "ir/bytecode/proof.h"
#include "tests/fuzz/field_changes.h"
#include "tests/fuzz/versions.h"

namespace {

using fuzz::FieldChange;
using fuzz::FieldPlace;
using fuzz::ImageField;

enum class Bound : uint8_t {
  kAlways,  // in every record each value that is far off is refused; an empty record more in a list
  kRule,    // where it has a meaning, what it may be follows from other fields
  kFree,    // nobody minds any value
};
struct Row {
  FieldPlace place;
  std::string name;
  Bound bound;
  base::Refusal refusal;  // of a rule: the first of its answers
  std::string why;        // the rule, or why any value is harmless
};

const std::vector<Row>& rows() {
  static const std::vector<Row> all = {
      {{typeid(ir::TypeTable), 0}, "TypeTable.old_names", Bound::kRule,
       base::Refusal::kBadFormat, "old_names_known: as many as are named; a text"},
#define FIELD(record, member, bound, refusal, why)            \
  {{typeid(ir::record), offsetof(ir::record, member)},        \
   #record "." #member,                                       \
   Bound::bound,                                              \
   base::Refusal::refusal,                                    \
   why},
#define FREE(record, member, why)                      \
  {{typeid(ir::record), offsetof(ir::record, member)}, \
   #record "." #member,                                \
   Bound::kFree,                                       \
   base::Refusal::kInternal,                           \
   why},
#define LIST(record, bound, refusal, why)  \
  {{typeid(ir::record), FieldPlace::kList}, \
   "list of " #record,                      \
   Bound::bound,                            \
   base::Refusal::refusal,                  \
   why},
#define FREE_LIST(record, why)              \
  {{typeid(ir::record), FieldPlace::kList}, \
   "list of " #record,                      \
   Bound::kFree,                            \
   base::Refusal::kInternal,                \
   why},
#include "tests/unit/image_fields/fields.def"
#undef FIELD
#undef FREE
#undef LIST
#undef FREE_LIST
  };
  return all;
}

const Row* row_of(const FieldPlace& place) {
  for (const Row& row : rows()) {
    if (row.place == place) return &row;
  }
  return nullptr;
}

// How a field is changed, as fuzz::apply() has it: to the ends of what a number can be, to what is
// near, texts and lists in all ways. The first kFar of them are where no image comes near; to a
// list of records they add one.
std::vector<FieldChange> changes(uint16_t field, uint16_t which) {
  std::vector<FieldChange> all;
  for (const uint16_t end : {3, 4, 6, 7, 0, 1, 2, 5}) all.emplace_back(field, which, end, 12);
  for (uint16_t how = 0; how < 16; ++how) {
    all.emplace_back(field, which, 1, how);
    all.emplace_back(field, which, 255, how);
  }
  return all;
}
constexpr size_t kFar = 4;

struct Answers {
  bool all_far_refused = true;
  bool accepted_all = true;
  std::vector<bool> refusals = std::vector<bool>(1000);
  std::string last;
};

// Each record of a table; of code the first ones, which are of every kind.
Answers ask(const ir::VerifiedImage& version, const ir::verification::Proof& known,
            const std::vector<ImageField>& fields, uint16_t number) {
  constexpr uint32_t kMost = 60;
  Answers answers;
  const base::Bytes& good = version.encoded();
  for (uint32_t which = 0; which < std::min(fields[number].count, kMost); ++which) {
    size_t at = 0;
    for (const FieldChange& change : changes(number, static_cast<uint16_t>(which))) {
      ir::Image image = version.image();
      fuzz::apply(image, fields, change);
      const auto bytes = std::make_shared<const base::Bytes>(ir::encode(image));
      const bool far = at++ < kFar;
      if (*bytes == good) continue;
      const auto alone = ir::verification::prove(bytes, nullptr);
      const auto beside = ir::verification::prove(bytes, &known);
      EXPECT_EQ(alone.ok(), beside.ok());
      if (alone.ok()) {
        answers.all_far_refused = answers.all_far_refused && !far;
        continue;
      }
      answers.accepted_all = false;
      answers.refusals[static_cast<size_t>(alone.error().refusal)] = true;
      answers.last = base::to_string(alone.error());
    }
  }
  return answers;
}

void expect_promise(const Row& row, const Answers& answers) {
  EXPECT_FALSE(row.why.empty()) << row.name;
  if (row.bound == Bound::kFree) {
    EXPECT_TRUE(answers.accepted_all) << row.name << ": " << answers.last;
    return;
  }
  EXPECT_TRUE(answers.refusals[static_cast<size_t>(row.refusal)]) << row.name << ": " << answers.last;
  if (row.bound == Bound::kAlways) {
    EXPECT_TRUE(answers.all_far_refused) << row.name;
  }
}

TEST(ImageFields, EachHasARuleOrAReason) {
  const ir::VerifiedImage& version = fuzz::versions(fuzz::kEveryTable).from;
  const auto known =
      ir::verification::prove(std::make_shared<base::Bytes>(version.encoded()), nullptr);
  ASSERT_TRUE(known.ok());
  const std::vector<ImageField> fields = fuzz::fields_of(version.image());
  std::vector<bool> seen(rows().size());
  for (uint16_t number = 0; number < fields.size(); ++number) {
    const FieldPlace& place = fields[number].place;
    const Row* const row = row_of(place);
    ASSERT_NE(row, nullptr) << "the format has a "
                            << (place.offset == FieldPlace::kList ? "list" : "field")
                            << " without a row in fields.def: " << place.record.name()
                            << ", at byte " << static_cast<ptrdiff_t>(place.offset);
    seen[static_cast<size_t>(row - rows().data())] = true;
    expect_promise(*row, ask(version, **known, fields, number));
  }
  for (size_t i = 0; i < seen.size(); ++i) {
    EXPECT_TRUE(seen[i]) << rows()[i].name << " is in no image that every_table.st makes";
  }
}

}  // namespace
