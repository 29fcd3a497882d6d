// Messages grow at their ends, and both sides read what they know (vm/runtime/fields.h).
#include <gtest/gtest.h>

#include "vm/runtime/fields.h"

namespace vm {
namespace {

struct OldRow {
  std::string name;
};
struct NewRow {
  std::string name;
  uint64_t count = 7;
};
constexpr auto row_fields = [](auto& a, auto& row) {
  a(row.name);
  if constexpr (requires { row.count; }) a.added(row.count);
};

template <class Row>
struct Page {
  std::vector<Row> rows;
  uint8_t last = 0;
};
constexpr auto page_fields = [](auto& a, auto& page) {
  a.rows(page.rows, kTextBytes, row_fields);
  a(page.last);
};

TEST(Fields, AnOlderReaderSkipsWhatWasAdded) {
  const Page<NewRow> page{{{"a", 1}, {"b", 2}}, 3};
  const auto read = read_fields<Page<OldRow>>(write_fields(page, page_fields), "page", page_fields);
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(read->rows.size(), 2u);
  EXPECT_EQ(read->rows[1].name, "b");
  EXPECT_EQ(read->last, 3);
}

TEST(Fields, WhatAnOlderSenderLacksKeepsItsDefault) {
  const Page<OldRow> page{{{"a"}, {"b"}}, 3};
  const auto read = read_fields<Page<NewRow>>(write_fields(page, page_fields), "page", page_fields);
  ASSERT_TRUE(read.ok());
  ASSERT_EQ(read->rows.size(), 2u);
  EXPECT_EQ(read->rows[1].name, "b");
  EXPECT_EQ(read->rows[1].count, 7u);
  EXPECT_EQ(read->last, 3);
}

TEST(Fields, APartOfWhatWasAddedIsDamage) {
  base::Bytes bytes = write_fields(NewRow{"a", 1}, row_fields);
  bytes.pop_back();
  EXPECT_FALSE(read_fields<NewRow>(bytes, "row", row_fields).ok());
}

TEST(Fields, ARowThatReachesBeyondItsListIsDamage) {
  base::Bytes bytes = write_fields(Page<OldRow>{{{"a"}}, 3}, page_fields);
  for (const uint8_t length : {0, 4, 7, 200}) {  // it is 5
    base::Bytes other = bytes;
    other[4] = length;
    EXPECT_FALSE(read_fields<Page<OldRow>>(other, "page", page_fields).ok()) << int{length};
  }
}

TEST(Fields, AHostileCountAsksForNoMemory) {
  base::ByteWriter out;
  out.u32(0x10000000);
  for (int i = 0; i < 100; ++i) out.u32(0);
  EXPECT_FALSE(read_fields<Page<OldRow>>(out.take(), "page", page_fields).ok());
}

}  // namespace
}  // namespace vm
