// InlineVector and SlimVector behave as std::vector does, ByteTable as a map.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <string>
#include <vector>

#include "base/byte_table.h"
#include "base/inline_vector.h"
#include "base/slim_vector.h"

namespace base {
namespace {

using Short = InlineVector<uint32_t, 2>;

std::vector<uint32_t> copied(const Short& list) { return {list.begin(), list.end()}; }

TEST(InlineVector, IsAsSmallAsItsElements) { EXPECT_EQ(sizeof(Short), 16u); }

TEST(InlineVector, DoesWhatAVectorDoes) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Short list;
    std::vector<uint32_t> expected;
    for (int step = 0; step < 20; ++step) {
      const uint32_t value = static_cast<uint32_t>(random());
      switch (random() % 8) {
        case 0:
        case 1:
        case 2:
          list.push_back(value);
          expected.push_back(value);
          break;
        case 3: {
          const size_t at = random() % (expected.size() + 1);
          const std::vector<uint32_t> some(random() % 4, value);
          list.insert(list.begin() + at, some);
          expected.insert(expected.begin() + static_cast<ptrdiff_t>(at), some.begin(), some.end());
          break;
        }
        case 4:
          list.resize(expected.size() / 2 + random() % 4);
          expected.resize(list.size());
          break;
        case 5: {
          Short other = list;  // a copy is a list of its own
          other.push_back(1);
          list = std::move(other);
          expected.push_back(1);
          break;
        }
        case 6: {
          const Short other = list;
          list = {value, value, value};
          list = other;
          break;
        }
        default:
          if (expected.empty()) break;
          list.pop_back();
          expected.pop_back();
          list.insert(list.begin(), value);
          expected.insert(expected.begin(), value);
          break;
      }
      ASSERT_EQ(copied(list), expected);
      ASSERT_EQ(list, Short(expected));
      ASSERT_EQ(list.empty(), expected.empty());
    }
  }
}

TEST(InlineVector, WhatWasMovedFromIsEmpty) {
  Short list = {1, 2, 3};
  const Short other = std::move(list);
  EXPECT_EQ(copied(other), (std::vector<uint32_t>{1, 2, 3}));
  EXPECT_TRUE(list.empty());  // NOLINT: that is the question
  list.push_back(4);
  EXPECT_EQ(copied(list), (std::vector<uint32_t>{4}));
  EXPECT_FALSE(list == other);
}

TEST(SlimVector, OwnsElementsOfAnyKind) {
  EXPECT_EQ(sizeof(SlimVector<std::string>), sizeof(void*));
  SlimVector<std::string> list;
  EXPECT_TRUE(list.empty());
  std::vector<std::string> expected;
  for (int i = 0; i < 40; ++i) {
    expected.push_back("a text that is too long to lie in place, number " + std::to_string(i));
    list.push_back(expected.back());
    SlimVector<std::string> copy = list;
    EXPECT_EQ(std::vector<std::string>(copy.begin(), copy.end()), expected);
    copy[0] = "another";
    list = SlimVector<std::string>(list);  // moved into its place
  }
  EXPECT_EQ(list[0], expected[0]);
  EXPECT_EQ(list.size(), 40u);
  SlimVector<std::string> taken = std::move(list);
  EXPECT_TRUE(list.empty());  // NOLINT: that is the question
  list = {"x", "y"};
  EXPECT_EQ(list.size(), 2u);
  EXPECT_EQ(taken.size(), 40u);
  taken.clear();
  EXPECT_TRUE(taken.empty());
}

TEST(ByteTable, DoesWhatAMapDoes) {
  std::mt19937 random(11);
  ByteTable table;
  for (size_t round = 0; round < 60; ++round) {
    std::map<std::string, uint32_t> expected;
    const size_t keys = round % 7 == 0 ? 3000 : round;
    for (uint32_t i = 0; i < keys; ++i) {
      std::string key(random() % 20, '\0');
      for (char& c : key) c = static_cast<char>(random() % 3);
      const auto known = expected.find(key);
      EXPECT_EQ(table.find(key), known == expected.end() ? ByteTable::kNone : known->second);
      EXPECT_EQ(table.add(key, i), expected.try_emplace(key, i).first->second);
    }
    for (const auto& [key, number] : expected) ASSERT_EQ(table.find(key), number);
    table.clear();
    EXPECT_EQ(table.find(""), ByteTable::kNone);
  }
}

}  // namespace
}  // namespace base
