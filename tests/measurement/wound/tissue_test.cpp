#include "measurement/wound/tissue.h"

#include "measurement/wound/measure.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/support/temporary_folder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <numbers>
#include <numeric>

namespace tarsus {
namespace {

constexpr double kRadius_mm = 8.0;

TexturedMesh flatFoot(double edge_mm) {
  return withHash(test::woundMesh(
      test::planeSkin(), test::bowl(kRadius_mm, 0.0), {.half_size_mm = 34.0, .edge_mm = edge_mm}));
}

WoundOutline circle(const TexturedMesh& foot, double radius_mm = kRadius_mm) {
  const MeshIndex index(foot.mesh);
  return traceOutline(
             foot,
             index,
             test::circleOn(test::planeSkin(), test::bowl(kRadius_mm, 0.0), radius_mm, 180))
      .value();
}

double sum(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

/// Every vertex of the bed by its place.
template <typename Rule>
TissueMap mapped(const TissueBed& bed, const Rule& rule) {
  TissueMap map;
  map.mesh_sha256 = bed.mesh_sha256;
  for (std::size_t v = 0; v < bed.mesh_vertex.size(); ++v) {
    map.vertices[bed.mesh_vertex[v]] = rule(bed.positions_mm[v]);
  }
  return map;
}

/// A bed without a mesh: places, areas and neighbours as wanted.
TissueBed chain(const std::vector<Eigen::Vector3d>& places, const std::vector<double>& areas_mm2) {
  TissueBed bed;
  bed.mesh_sha256 = "chain";
  bed.positions_mm = places;
  bed.area_mm2 = areas_mm2;
  bed.unseen.assign(places.size(), 0);
  bed.near_begin.push_back(0);
  for (int v = 0; v < static_cast<int>(places.size()); ++v) {
    bed.mesh_vertex.push_back(static_cast<std::uint32_t>(v));
    for (const int next : {v - 1, v + 1}) {
      if (next >= 0 && next < static_cast<int>(places.size())) {
        bed.near.push_back(next);
      }
    }
    bed.near_begin.push_back(static_cast<int>(bed.near.size()));
  }
  return bed;
}

TEST(TissueBed, AreasOfVerticesSumToTheBedCutExactly) {
  // 2 mm edges on a radius of 8 mm: whole triangles would miss by several percent. The outline
  // itself passes over points within 0.01 mm of its chords: 0.2 %.
  for (const double edge_mm : {0.5, 2.0}) {
    const TexturedMesh foot = flatFoot(edge_mm);
    const auto bed = openTissueBed(foot, circle(foot));
    ASSERT_TRUE(bed);
    EXPECT_NEAR(sum(bed->area_mm2), std::numbers::pi * kRadius_mm * kRadius_mm, 0.5);
    EXPECT_NEAR(bed->closed_mm2, 0.0, 1e-6);
    EXPECT_FALSE(bed->skin_vertex.empty());
    for (const std::uint32_t v : bed->skin_vertex) {
      EXPECT_GT(foot.mesh.vertices[v].norm(), kRadius_mm + 7.9F);
    }
  }
}

TEST(TissueShares, HalvesOfADisc) {
  const TexturedMesh foot = flatFoot(0.7);
  const auto bed = openTissueBed(foot, circle(foot)).value();
  const auto shares = sharesOf(bed, mapped(bed, [](const Eigen::Vector3d& p) {
                                 return p.x() < 0.0 ? Tissue::Granulation : Tissue::Necrosis;
                               }));
  ASSERT_TRUE(shares);
  EXPECT_NEAR(shares->percent[0], 50, 1);
  EXPECT_NEAR(shares->percent[2], 50, 1);
  EXPECT_EQ(shares->unpainted_percent, 0);
}

// Paint stays where it is when the outline moves: a disc of 4 mm is 16/64 of one of 8 mm and 16/36
// of one of 6 mm.
TEST(TissueShares, FollowTheOutline) {
  const TexturedMesh foot = flatFoot(0.5);
  const auto rule = [](const Eigen::Vector3d& p) {
    return p.norm() < 4.0 ? Tissue::Slough : Tissue::Granulation;
  };
  const auto wide = openTissueBed(foot, circle(foot)).value();
  const TissueMap paint = mapped(wide, rule);
  EXPECT_NEAR(sharesOf(wide, paint)->percent[1], 25, 1);
  const auto narrow = openTissueBed(foot, circle(foot, 6.0)).value();
  EXPECT_NEAR(sharesOf(narrow, paint)->percent[1], 44, 1);
  EXPECT_EQ(sharesOf(narrow, paint)->unpainted_percent, 0);
}

TEST(TissueShares, UnpaintedIsSaidApart) {
  const TexturedMesh foot = flatFoot(0.7);
  const auto bed = openTissueBed(foot, circle(foot)).value();
  TissueMap nothing;
  nothing.mesh_sha256 = bed.mesh_sha256;
  EXPECT_EQ(sharesOf(bed, nothing)->unpainted_percent, 100);
  TissueMap half = mapped(bed, [](const Eigen::Vector3d&) { return Tissue::Epithelium; });
  std::erase_if(half.vertices,
                [&](const auto& entry) { return foot.mesh.vertices[entry.first].y() > 0.0F; });
  const auto shares = sharesOf(bed, half);
  EXPECT_NEAR(shares->unpainted_percent, 50, 1);
  EXPECT_EQ(shares->percent[3] + shares->unpainted_percent, 100);
}

TEST(TissueShares, SumToAHundredWhateverTheAreas) {
  test::Dice dice(5);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<Eigen::Vector3d> places(6, Eigen::Vector3d::Zero());
    std::vector<double> areas;
    for (int i = 0; i < 6; ++i) {
      areas.push_back(dice.uniform(0.0, 1.0));
    }
    const TissueBed bed = chain(places, areas);
    TissueMap map;
    map.mesh_sha256 = bed.mesh_sha256;
    for (std::uint32_t v = 0; v < 5; ++v) {
      map.vertices[v] = static_cast<Tissue>(v);
    }
    const auto shares = sharesOf(bed, map);
    int all = shares->unpainted_percent;
    for (std::size_t t = 0; t < kTissues; ++t) {
      all += shares->percent[t];
      EXPECT_NEAR(shares->percent[t], 100.0 * areas[t] / sum(areas), 1.0);
    }
    EXPECT_EQ(all, 100);
  }
}

TEST(TissueShares, ThreeEqualThirdsAreNotNinetyNine) {
  const TissueBed bed = chain(std::vector<Eigen::Vector3d>(3, Eigen::Vector3d::Zero()), {1, 1, 1});
  TissueMap map;
  map.mesh_sha256 = bed.mesh_sha256;
  map.vertices = {{0, Tissue::Granulation}, {1, Tissue::Slough}, {2, Tissue::Necrosis}};
  EXPECT_EQ(sharesOf(bed, map)->percent, (std::array<int, kTissues>{34, 33, 33, 0, 0}));
}

TEST(TissueShares, AHoleInTheBedIsOther) {
  TexturedMesh foot = flatFoot(0.5);
  std::erase_if(foot.mesh.faces, [&](const Eigen::Vector3i& f) {
    return foot.mesh.vertices[static_cast<std::size_t>(f[0])].norm() < 2.0F;
  });
  foot = withHash(std::move(foot));
  const auto bed = openTissueBed(foot, circle(foot)).value();
  // About 4 of 64; the hole's edge is ragged by one face.
  EXPECT_NEAR(bed.closed_mm2, std::numbers::pi * 4.0, 3.0);
  const auto shares =
      sharesOf(bed, mapped(bed, [](const Eigen::Vector3d&) { return Tissue::Granulation; }));
  EXPECT_NEAR(shares->percent[4], 6, 2);
  EXPECT_EQ(shares->percent[0] + shares->percent[4], 100);
}

TEST(TissueShares, PaintOfAnotherModelIsRefused) {
  const TexturedMesh foot = flatFoot(1.0);
  const auto bed = openTissueBed(foot, circle(foot)).value();
  TissueMap other = mapped(bed, [](const Eigen::Vector3d&) { return Tissue::Slough; });
  other.mesh_sha256 = std::string(64, 'a');
  const auto shares = sharesOf(bed, other);
  ASSERT_FALSE(shares);
  EXPECT_EQ(shares.error().code, ErrorCode::TissueInvalid);
}

TEST(TissueBrush, PaintsTheBallInsideTheOutlineAlone) {
  const TexturedMesh foot = flatFoot(0.5);
  const auto bed = openTissueBed(foot, circle(foot)).value();
  const TissueBrush brush{.center_mm = {6.0, 0.0, 0.0}, .radius_mm = 4.0};
  const TissueMap map = painted(bed, {}, brush, Tissue::Slough);
  EXPECT_FALSE(map.vertices.empty());
  for (std::size_t v = 0; v < bed.mesh_vertex.size(); ++v) {
    const bool inside = (bed.positions_mm[v] - brush.center_mm).norm() <= brush.radius_mm;
    EXPECT_EQ(map.vertices.contains(bed.mesh_vertex[v]), inside);
  }
  for (const auto& [vertex, tissue] : map.vertices) {
    EXPECT_LT(foot.mesh.vertices[vertex].norm(), kRadius_mm + 0.8F);  // one edge at the outline
    EXPECT_EQ(tissue, Tissue::Slough);
  }
}

TEST(TissueBrush, DoesNotReachTheOtherWallThroughTheAir) {
  // Down 6 mm, across 1 mm, up 6 mm: the walls face each other.
  std::vector<Eigen::Vector3d> places;
  for (int i = 0; i <= 6; ++i) {
    places.emplace_back(0, 0, -i);
  }
  for (int i = 6; i >= 0; --i) {
    places.emplace_back(1, 0, -i);
  }
  const TissueBed bed = chain(places, std::vector<double>(places.size(), 1.0));
  const TissueMap map =
      painted(bed, {}, {.center_mm = {0, 0, -1}, .radius_mm = 2.5}, Tissue::Necrosis);
  EXPECT_EQ(map.vertices.size(), 4U);
  for (const auto& [vertex, tissue] : map.vertices) {
    EXPECT_LE(vertex, 3U);
  }
}

TEST(TissueBrush, AFineBrushPaintsWhereItStandsAndAFarOneNothing) {
  const TexturedMesh foot = flatFoot(1.0);
  const auto bed = openTissueBed(foot, circle(foot)).value();
  EXPECT_EQ(painted(bed, {}, {.center_mm = {0.3, 0.3, 0.0}, .radius_mm = 0.05}, Tissue::Slough)
                .vertices.size(),
            1U);
  EXPECT_TRUE(painted(bed, {}, {.center_mm = {30, 0, 0}, .radius_mm = 2.0}, Tissue::Slough)
                  .vertices.empty());
  EXPECT_TRUE(painted(bed, {}, {.center_mm = {NAN, 0, 0}, .radius_mm = 2.0}, Tissue::Slough)
                  .vertices.empty());
}

TEST(TissueBrush, ACopyIsAStepBack) {
  const TexturedMesh foot = flatFoot(1.0);
  const auto bed = openTissueBed(foot, circle(foot)).value();
  const TissueMap first = painted(bed, {}, {.center_mm = {0, 0, 0}}, Tissue::Slough);
  const TissueMap second = painted(bed, first, {.center_mm = {0, 0, 0}}, Tissue::Necrosis);
  const TissueMap third = erased(bed, second, {.center_mm = {0, 0, 0}});
  EXPECT_EQ(sharesOf(bed, first)->percent[1], sharesOf(bed, second)->percent[2]);
  EXPECT_GT(sharesOf(bed, first)->percent[1], 0);
  EXPECT_TRUE(third.vertices.empty());
}

TEST(TissueSource, SaysWhoAndWhetherItWasConfirmed) {
  const TissueBed bed = chain({Eigen::Vector3d::Zero()}, {1.0});
  TissueMap map = painted(bed, {}, {}, Tissue::Slough);
  EXPECT_EQ(sourceOf(map), "painted by hand, not confirmed");
  map.confirmed = true;
  EXPECT_EQ(sourceOf(map), "painted by hand, confirmed");
  map.method = "colour";
  EXPECT_EQ(sourceOf(map), "proposed by colour, confirmed");
  // A stroke takes the confirmation back.
  map = painted(bed, map, {}, Tissue::Necrosis);
  EXPECT_EQ(sourceOf(map), "proposed by colour, edited by hand, not confirmed");
}

std::filesystem::path fileWith(const TemporaryFolder& folder, const std::string& text) {
  const auto path = folder.path() / "tissue.json";
  std::ofstream(path) << text;
  return path;
}

TEST(TissueFile, ReadsWhatItWrote) {
  const TemporaryFolder folder;
  TissueMap map;
  map.mesh_sha256 = std::string(64, '0');
  map.method = "colour";
  map.edited = true;
  map.vertices = {{7, Tissue::Slough}, {4000000000U, Tissue::Other}, {9, Tissue::Granulation}};
  ASSERT_TRUE(writeTissue(folder.path() / "t.json", map));
  const auto read = readTissue(folder.path() / "t.json");
  ASSERT_TRUE(read) << read.error().detail;
  EXPECT_EQ(read->mesh_sha256, map.mesh_sha256);
  EXPECT_EQ(read->method, map.method);
  EXPECT_EQ(read->vertices, map.vertices);
  EXPECT_TRUE(read->edited);
  EXPECT_FALSE(read->confirmed);
}

TEST(TissueFile, RefusesWithASentence) {
  const TemporaryFolder folder;
  EXPECT_EQ(readTissue(folder.path() / "none.json").error().code, ErrorCode::FileMissing);
  for (const char* text : {"",
                           "[]",
                           R"({"vertices":{}})",
                           R"({"mesh_sha256":"a","vertices":[]})",
                           R"({"mesh_sha256":5,"vertices":{}})",
                           R"({"mesh_sha256":"a","confirmed":"yes","vertices":{}})",
                           R"({"mesh_sha256":"a","vertices":{"bone":[1]}})",
                           R"({"mesh_sha256":"a","vertices":{"slough":3}})",
                           R"({"mesh_sha256":"a","vertices":{"slough":[-1]}})",
                           R"({"mesh_sha256":"a","vertices":{"slough":[1.5]}})",
                           R"({"mesh_sha256":"a","vertices":{"slough":[4294967296]}})",
                           R"({"mesh_sha256":"a","vertices":{"slough":[1,1]}})",
                           R"({"mesh_sha256":"a","vertices":{"slough":[1],"other":[1]}})"}) {
    const auto read = readTissue(fileWith(folder, text));
    ASSERT_FALSE(read) << text;
    EXPECT_EQ(read.error().code, ErrorCode::TissueInvalid) << text;
    EXPECT_NE(read.error().detail.find("tissue.json"), std::string::npos);
  }
}

TEST(TissueFile, SharesAreWholeNumbersByName) {
  TissueShares shares;
  shares.percent = {60, 20, 5, 10, 0};
  shares.unpainted_percent = 5;
  shares.source = "painted by hand, confirmed";
  const nlohmann::json json = toJson(shares);
  EXPECT_EQ(json["tissue_percent"]["granulation"], 60);
  EXPECT_EQ(json["tissue_percent"].size(), kTissues);
  EXPECT_TRUE(json["tissue_percent"]["necrosis"].is_number_integer());
  EXPECT_EQ(json["tissue_unpainted_percent"], 5);
  EXPECT_EQ(json["tissue_source"], "painted by hand, confirmed");
}

}  // namespace
}  // namespace tarsus
