#include "measurement/outline/outline.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>

#include <fstream>

namespace tarsus {
namespace {

std::filesystem::path fileWith(const TemporaryFolder& folder, const std::string& text) {
  const auto path = folder.path() / "outline.json";
  std::ofstream(path) << text;
  return path;
}

TEST(OutlineFile, ReadsWhatItWrote) {
  const TemporaryFolder folder;
  const std::vector<Eigen::Vector3d> points{{1.25, -2.5, 300.0625}, {0.1, 0.2, 0.3}, {4, 5, 6}};
  ASSERT_TRUE(writeOutlinePoints(folder.path() / "o.json", points));
  const auto read = readOutlinePoints(folder.path() / "o.json");
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, points);
}

TEST(OutlineFile, KeepsWhoPlacedThePoints) {
  const TemporaryFolder folder;
  const std::vector<Eigen::Vector3d> points{{1, 2, 3}, {0.1, 0.2, 0.3}, {4, 5, 6}};
  for (const std::optional<OutlineSource> source :
       {std::optional<OutlineSource>(),
        std::optional(OutlineSource::Drawn),
        std::optional(OutlineSource::Suggested),
        std::optional(OutlineSource::SuggestedEdited)}) {
    ASSERT_TRUE(writeOutlinePoints(folder.path() / "o.json", points, source));
    const auto read = readOutlineFile(folder.path() / "o.json");
    ASSERT_TRUE(read);
    EXPECT_EQ(read->source, source);
    EXPECT_EQ(read->points_mm, points);
  }
}

TEST(OutlineFile, TakesAnUnknownSourceForNone) {
  const TemporaryFolder folder;
  for (const char* source : {R"("MeshLab")", "3", "null", "[]"}) {
    const auto read = readOutlineFile(fileWith(
        folder, std::string(R"({"points":[[0,0,0],[1,0,0],[0,1,0]],"source":)") + source + "}"));
    ASSERT_TRUE(read) << source;
    EXPECT_FALSE(read->source) << source;
  }
}

TEST(OutlineFile, AcceptsFurtherFields) {
  const TemporaryFolder folder;
  const auto read = readOutlinePoints(fileWith(
      folder,
      R"({"frame":"scan","unit":"mm","closed":true,"name":"heel","points":[[0,0,0],[1,0,0],[0,1,0]]})"));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->size(), 3U);
}

TEST(OutlineFile, RefusesWithASentence) {
  const TemporaryFolder folder;
  EXPECT_EQ(readOutlinePoints(folder.path() / "none.json").error().code, ErrorCode::FileMissing);
  for (const char* text : {"not json",
                           "[]",
                           R"({"points":[[0,0,0],[1,0,0]]})",
                           R"({"points":[[0,0,0],[1,0],[0,1,0]]})",
                           R"({"points":[[0,0,0],[1,null,0],[0,1,0]]})",
                           R"({"unit":"m","points":[[0,0,0],[1,0,0],[0,1,0]]})",
                           R"({"closed":false,"points":[[0,0,0],[1,0,0],[0,1,0]]})",
                           R"({"frame":"camera","points":[[0,0,0],[1,0,0],[0,1,0]]})"}) {
    const auto read = readOutlinePoints(fileWith(folder, text));
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::OutlineInvalid) << text;
    EXPECT_NE(read.error().detail.find("outline.json"), std::string::npos);
  }
}

}  // namespace
}  // namespace tarsus
