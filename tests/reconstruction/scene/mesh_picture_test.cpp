#include "reconstruction/scene/mesh_picture.h"

#include "tests/reconstruction/scene/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace tarsus {
namespace {

constexpr Rgb8 kWhite{255, 255, 255};

bool equal(const Rgb8& a, const Rgb8& b) { return a.r == b.r && a.g == b.g && a.b == b.b; }

int lightness(const Rgb8& c) { return c.r + c.g + c.b; }

PictureOptions smallPicture() {
  PictureOptions options;
  options.width_px = 160;
  options.height_px = 120;
  return options;
}

ViewFrame fromAbove(const Eigen::Vector3d& center_mm, double mm_per_px) {
  return {.center_mm = center_mm,
          .right = Eigen::Vector3d::UnitX(),
          .up = Eigen::Vector3d::UnitY(),
          .mm_per_px = mm_per_px};
}

TEST(ViewFrame, ProjectsWithUpwardsUpAndATrueScale) {
  const PictureOptions options = smallPicture();
  const ViewFrame view = fromAbove({5.0, 7.0, 9.0}, 0.25);
  EXPECT_LT((view.project({5.0, 7.0, -3.0}, options) - Eigen::Vector2d(79.5, 59.5)).norm(), 1e-12);
  EXPECT_LT((view.project({6.0, 9.0, 0.0}, options) - Eigen::Vector2d(83.5, 51.5)).norm(), 1e-12);
}

TEST(ViewOfWhole, ShowsAllOfItAndNotMuchElse) {
  const TriangleMesh potato = makePotato(40);
  const PictureOptions options = smallPicture();
  for (const Eigen::Vector3d& toward :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(-2, 1, 0.3), Eigen::Vector3d(0, -5, 0)}) {
    const ViewFrame view = viewOfWhole(potato, toward, {0, 0, 1}, options);
    EXPECT_LT((view.right.cross(view.up) - toward.normalized()).norm(), 1e-12);
    Eigen::AlignedBox2d box;
    for (const Eigen::Vector3f& vertex : potato.vertices) {
      box.extend(view.project(vertex.cast<double>(), options));
    }
    EXPECT_GT(box.min().minCoeff(), 0.0);
    EXPECT_LT(box.max().x(), 159.0);
    EXPECT_LT(box.max().y(), 119.0);
    EXPECT_GT(std::max(box.sizes().x() / 160.0, box.sizes().y() / 120.0), 0.9);
    EXPECT_LT((box.center() - Eigen::Vector2d(79.5, 59.5)).norm(), 1e-6);
  }
}

TEST(ViewOfWhole, UpIsUp) {
  const ViewFrame view = viewOfWhole(makeCube(10.0), {1, 1, 0}, {0, 0, 1}, smallPicture());
  EXPECT_LT((view.up - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

TEST(TakePicture, AreasInItAreTrue) {
  // A disc of 20 mm radius, counted in pixels with their antialiased part.
  const PictureOptions options = smallPicture();
  const TriangleMesh sphere = makeSphere(20.0, 100);
  const std::vector<Rgb8> black(sphere.vertices.size());
  PictureOptions flat = options;
  flat.shading = 0.0;
  flat.background = kWhite;
  const ColorImage picture =
      takePicture(sphere, black, fromAbove(Eigen::Vector3d::Zero(), 0.4), flat);
  double covered = 0.0;
  for (const Rgb8& pixel : picture.pixels()) {
    covered += 1.0 - pixel.g / 255.0;
  }
  EXPECT_NEAR(covered * 0.4 * 0.4, 1256.6, 6.0);  // 0.5 %: 4 samples in each of 314 edge pixels
}

TEST(TakePicture, ThePictureLiesWhereProjectSays) {
  PictureOptions options = smallPicture();
  options.shading = 0.0;
  const TriangleMesh plane = makePlane(20.0, 4, 3.0);
  const std::vector<Rgb8> red(plane.vertices.size(), {200, 10, 20});
  const ViewFrame view = fromAbove({12.0, 9.0, 0.0}, 0.25);
  const ColorImage picture = takePicture(plane, red, view, options);
  const Eigen::Vector2d low = view.project({0.0, 20.0, 3.0}, options);
  const Eigen::Vector2d high = view.project({20.0, 0.0, 3.0}, options);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 160; ++u) {
      const bool inside =
          u > low.x() + 1 && u < high.x() - 1 && v > low.y() + 1 && v < high.y() - 1;
      const bool outside =
          u < low.x() - 1 || u > high.x() + 1 || v < low.y() - 1 || v > high.y() + 1;
      ASSERT_TRUE(!inside || equal(picture.at(u, v), {200, 10, 20})) << u << ' ' << v;
      ASSERT_TRUE(!outside || equal(picture.at(u, v), options.background)) << u << ' ' << v;
    }
  }
}

TEST(TakePicture, ColorsRunEvenlyBetweenVertices) {
  PictureOptions options = smallPicture();
  options.shading = 0.0;
  const TriangleMesh plane = makePlane(40.0, 1, 0.0);
  const std::vector<Rgb8> colors{{0, 0, 0}, {240, 0, 0}, {0, 0, 0}, {240, 0, 0}};  // left to right
  const ViewFrame view = fromAbove({20.0, 20.0, 0.0}, 0.5);
  const ColorImage picture = takePicture(plane, colors, view, options);
  for (const double x_mm : {5.0, 15.0, 25.0, 35.0}) {
    const int u = static_cast<int>(std::lround(view.project({x_mm, 20.0, 0.0}, options).x()));
    const double true_x_mm = 20.0 + 0.5 * (u - 79.5);
    EXPECT_NEAR(picture.at(u, 60).r, 6.0 * true_x_mm, 1.0);
  }
}

TEST(TakePicture, GreyWithoutColorsOrTexture) {
  PictureOptions options = smallPicture();
  const TriangleMesh sphere = makeSphere(20.0, 40);
  const std::vector<Rgb8> green(sphere.vertices.size(), {0, 255, 0});
  const ViewFrame view = fromAbove(Eigen::Vector3d::Zero(), 0.5);
  options.textured = false;
  const ColorImage untextured = takePicture(sphere, green, view, options);
  options.textured = true;
  const ColorImage colorless = takePicture(sphere, {}, view, options);
  const Rgb8 middle = colorless.at(80, 60);
  EXPECT_TRUE(equal(middle, untextured.at(80, 60)));
  EXPECT_LT(std::abs(middle.r - middle.b), 12);
  EXPECT_GT(middle.r, 120);
}

TEST(TakePicture, LightComesFromAboveOnTheLeft) {
  const TriangleMesh sphere = makeSphere(20.0, 60);
  const ColorImage picture =
      takePicture(sphere, {}, fromAbove(Eigen::Vector3d::Zero(), 0.5), smallPicture());
  const int top_left = lightness(picture.at(80 - 18, 60 - 18));
  const int bottom_right = lightness(picture.at(80 + 18, 60 + 18));
  EXPECT_GT(top_left, bottom_right + 100);
  EXPECT_GT(bottom_right, 100);  // relief, not night
}

TEST(TakePicture, TheInsideIsDarkerThanTheOutside) {
  const TriangleMesh plane = makePlane(40.0, 3, 0.0);
  TriangleMesh turned = plane;
  for (Eigen::Vector3i& face : turned.faces) {
    std::swap(face[1], face[2]);
  }
  const ViewFrame view = fromAbove({20.0, 20.0, 0.0}, 0.5);
  const int outside = lightness(takePicture(plane, {}, view, smallPicture()).at(80, 60));
  const int inside = lightness(takePicture(turned, {}, view, smallPicture()).at(80, 60));
  EXPECT_LT(inside, outside * 6 / 10);
}

TEST(TakePicture, AnEmptyMeshIsBackground) {
  const PictureOptions options = smallPicture();
  const TriangleMesh empty;
  const ColorImage picture =
      takePicture(empty, {}, viewOfWhole(empty, {0, 0, 1}, {0, 1, 0}, options), options);
  EXPECT_TRUE(std::all_of(picture.pixels().begin(), picture.pixels().end(), [&](const Rgb8& p) {
    return equal(p, options.background);
  }));
}

TEST(TakePicture, ColorsOfTheWrongNumberAreABug) {
  const std::vector<Rgb8> colors(3);
  const PictureOptions options = smallPicture();
  EXPECT_THROW(static_cast<void>(takePicture(makeCube(10.0), colors, ViewFrame{}, options)),
               std::logic_error);
}

TEST(TakePicture, SameBitsAgain) {
  const TriangleMesh potato = makePotato(50);
  const PictureOptions options = smallPicture();
  const ViewFrame view = viewOfWhole(potato, {1, 2, 3}, {0, 0, 1}, options);
  const ColorImage first = takePicture(potato, {}, view, options);
  const ColorImage second = takePicture(potato, {}, view, options);
  EXPECT_TRUE(
      std::equal(first.pixels().begin(), first.pixels().end(), second.pixels().begin(), equal));
}

}  // namespace
}  // namespace tarsus
