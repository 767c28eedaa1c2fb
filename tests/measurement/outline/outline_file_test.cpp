#include "measurement/outline/outline.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <functional>

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

class TracedInFile : public testing::Test {
 protected:
  TracedInFile()
      : foot_(test::woundMesh(test::planeSkin(), test::bowl(6.0, 2.0), {.half_size_mm = 15.0})),
        index_(foot_.mesh),
        traced_(*traceOutline(
            foot_, index_, test::circleOn(test::planeSkin(), test::bowl(6.0, 2.0), 6.0, 9))) {
    EXPECT_TRUE(writeOutline(path(), foot_, traced_, OutlineShape::Straight));
  }
  [[nodiscard]] std::filesystem::path path() const { return folder_.path() / "outline.json"; }
  [[nodiscard]] WoundOutline readBack() const {
    const auto file = readOutlineFile(path());
    EXPECT_TRUE(file);
    const auto outline = outlineOn(foot_, index_, *file);
    EXPECT_TRUE(outline);
    return *outline;
  }
  void change(const std::function<void(nlohmann::json&)>& edit) const {
    auto document = nlohmann::json::parse(std::ifstream(path()));
    edit(document);
    std::ofstream(path()) << document.dump();
  }
  static bool same(const WoundOutline& a, const WoundOutline& b) {
    return std::ranges::equal(a.curve, b.curve, [](const auto& p, const auto& q) {
      return p.face == q.face && p.barycentric == q.barycentric;
    });
  }

  TemporaryFolder folder_;
  TexturedMesh foot_;
  MeshIndex index_;
  WoundOutline traced_;
};

TEST_F(TracedInFile, IsTheSameToTheBitOnTheSameModel) { EXPECT_TRUE(same(readBack(), traced_)); }

TEST_F(TracedInFile, IsTracedAnewThroughChangedPointsOrOnAnotherModel) {
  change([](auto& document) { document["points"].erase(2); });
  EXPECT_FALSE(same(readBack(), traced_));
  EXPECT_EQ(readBack().clicks.size(), 8U);
  EXPECT_TRUE(writeOutline(path(), foot_, traced_, OutlineShape::Straight));
  change([](auto& document) { document["traced"]["mesh_sha256"] = "another"; });
  EXPECT_EQ(readBack().mesh_sha256, foot_.sha256);
}

TEST_F(TracedInFile, IsLeftAsideWhereItIsNoCurveOnTheModel) {
  const nlohmann::json far_face = {4000000000U, 0.2, 0.3, 0.5};
  const nlohmann::json outside = {3, -7.0, 4.0, 4.0};
  for (const nlohmann::json& wrong :
       {far_face, outside, nlohmann::json("x"), nlohmann::json{1, 2}, nlohmann::json()}) {
    EXPECT_TRUE(writeOutline(path(), foot_, traced_, OutlineShape::Straight));
    change([&](auto& document) { document["traced"]["clicks"][0] = wrong; });
    EXPECT_EQ(readBack().clicks.size(), 9U) << wrong;
    EXPECT_TRUE(writeOutline(path(), foot_, traced_, OutlineShape::Straight));
    change([&](auto& document) { document["traced"]["curve"][0] = wrong; });
    EXPECT_EQ(readBack().clicks.size(), 9U) << wrong;
    EXPECT_TRUE(std::ranges::all_of(readBack().curve, [&](const SurfacePoint& p) {
      return liesOn(foot_.mesh, p);
    })) << wrong;
  }
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
