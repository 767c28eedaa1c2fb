#include "measurement/records/name_index.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

using Ids = std::vector<std::string>;

TEST(SearchWords, FoldCaseAccentsAndStrokes) {
  EXPECT_EQ(searchWords("MÜLLER-Łuczak, Søren"), (Ids{"muller", "luczak", "soren"}));
  EXPECT_EQ(searchWords("Strauß"), (Ids{"strauss"}));
  EXPECT_EQ(searchWords("  "), Ids{});
  EXPECT_EQ(searchWords("王小明"), (Ids{"王小明", "小明", "明"}));
}

TEST(NameIndex, FindsThePrefixOfEachWordInAnyOrder) {
  NameIndex index;
  index.set("1", "Müller Anna 4711");
  index.set("2", "Muller Bernd 4712");
  index.set("3", "Amüller Carl");
  EXPECT_EQ(index.find("mull", 9), (Ids{"1", "2"}));
  EXPECT_EQ(index.find("ANN müll", 9), (Ids{"1"}));
  EXPECT_EQ(index.find("471", 1), (Ids{"1"}));
  EXPECT_EQ(index.find("muller x", 9), Ids{});
  EXPECT_EQ(index.find("", 9), Ids{});
}

TEST(NameIndex, ANewTextReplacesTheOldOne) {
  NameIndex index;
  index.set("1", "Smith");
  EXPECT_EQ(index.find("smi", 9), Ids{"1"});
  index.set("1", "Jones");
  EXPECT_EQ(index.find("smi", 9), Ids{});
  EXPECT_EQ(index.find("jon", 9), Ids{"1"});
  index.set("1", "");
  EXPECT_EQ(index.find("jon", 9), Ids{});
}

TEST(NameIndex, FindsThePartsOfAChineseName) {
  NameIndex index;
  index.set("1", "王小明");
  index.set("2", "李明");
  EXPECT_EQ(index.find("小明", 9), Ids{"1"});
  EXPECT_EQ(index.find("明", 9), (Ids{"1", "2"}));
}

}  // namespace
}  // namespace tarsus
