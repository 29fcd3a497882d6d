#include "base/shared.h"

#include <gtest/gtest.h>

#include <string>

namespace base {
namespace {

TEST(Shared, CopiesAreOneUntilOneIsChanged) {
  Shared<std::string> first(std::string("one"));
  Shared<std::string> second = first;
  EXPECT_TRUE(second.is_one_with(first));
  second.own() += "!";
  EXPECT_FALSE(second.is_one_with(first));
  EXPECT_EQ(*first, "one");
  EXPECT_EQ(*second, "one!");
  const std::string* const place = &*second;
  second.own() += "!";  // nobody else has it
  EXPECT_EQ(&*second, place);
  EXPECT_EQ(second.size(), 5u);
}

TEST(Shared, AVectorIsUsedAsOne) {
  SharedVector<int> first = {1, 2, 3};
  const SharedVector<int> second = first;
  EXPECT_TRUE(second.is_one_with(first));
  int sum = 0;
  for (const int item : second) sum += item;
  EXPECT_EQ(sum, 6);
  EXPECT_TRUE(second.is_one_with(first));  // it was only read
  first[1] = 9;
  first.push_back(4);
  first.erase(first.begin());
  EXPECT_EQ(first.all(), (std::vector<int>{9, 3, 4}));
  EXPECT_EQ(second.all(), (std::vector<int>{1, 2, 3}));
  for (int& item : first) item = 0;
  EXPECT_EQ(second.back(), 3);
  first = second;
  EXPECT_TRUE(first.is_one_with(second));
  first.clear();
  EXPECT_TRUE(first.empty());
  EXPECT_EQ(second.size(), 3u);
}

TEST(Shared, EmptyVectorsAreOne) {
  SharedVector<int> first;
  SharedVector<int> second(std::vector<int>{});
  EXPECT_TRUE(first.is_one_with(second));
  EXPECT_EQ(first.begin(), first.end());
  second.resize(1);
  EXPECT_TRUE(first.empty());
}

}  // namespace
}  // namespace base
