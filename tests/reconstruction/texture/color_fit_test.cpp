#include "reconstruction/texture/color_fit.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/texture/color_blend.h"
#include "reconstruction/texture/color_sampling.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tarsus {
namespace {

constexpr double kHalf_mm = 24.0;
constexpr float kInner_mm = 18.0F;

bool isInner(const Eigen::Vector3f& p) {
  return std::abs(p.x()) < kInner_mm && std::abs(p.y()) < kInner_mm;
}

/// Keyframes with their views of a mesh, exposure taken for level.
struct Seen {
  TriangleMesh mesh;
  std::vector<Keyframe> keyframes;
  std::vector<KeyframeView> views;
  std::vector<ColorGain> gains;

  Seen(TriangleMesh plane, std::vector<Keyframe> taken)
      : mesh(std::move(plane)), keyframes(std::move(taken)), gains(keyframes.size()) {
    auto rendered = renderViews(mesh, smallCamera(), keyframes, {});
    EXPECT_TRUE(rendered.has_value());
    views = std::move(*rendered);
  }
  Seen(const Seen&) = delete;
  Seen& operator=(const Seen&) = delete;

  [[nodiscard]] SeenColors blended(int best_views = 6) const {
    return blendViews(mesh, views, gains, best_views);
  }
  [[nodiscard]] SeenColors fitted(const ColorFitOptions& options = {}) const {
    SeenColors colors = blended();
    fitColors(mesh, views, gains, options, colors);
    return colors;
  }
};

/// Waves of 4 mm, four pixels.
TexturedScene fineScene() { return {.half_size_mm = kHalf_mm + 10.0, .period_mm = 4.0}; }

const Seen& fineViews() {
  static const Seen kSeen(planeSurface(kHalf_mm, 0.5).mesh,
                          ringOfKeyframes(fineScene(), smallCamera(), 8, 1.0));
  return kSeen;
}

/// Keyframes of one colour each.
std::vector<Keyframe> evenKeyframes(const std::vector<RigidTransform>& poses,
                                    const std::vector<std::uint8_t>& levels) {
  std::vector<Keyframe> keyframes(poses.size());
  for (std::size_t k = 0; k < poses.size(); ++k) {
    keyframes[k].scan_from_camera = poses[k];
    keyframes[k].frame.color = ColorImage(320, 240);
    std::ranges::fill(keyframes[k].frame.color.pixels(), Rgb8{levels[k], levels[k], levels[k]});
  }
  return keyframes;
}

/// RMS of what the model, drawn through rays, lacks of a picture [grey levels].
double pictureRmse(const Seen& seen, const SeenColors& colors, std::size_t k) {
  const MeshIndex index(seen.mesh);
  const RigidTransform& pose = seen.keyframes[k].scan_from_camera;
  double sum = 0.0;
  double count = 0.0;
  for (int v = 80; v < 160; ++v) {
    for (int u = 120; u < 200; ++u) {
      const MeshIndex::RayHit hit =
          index.castRay(pose.translation().cast<float>(),
                        (pose.linear() * smallCamera().color.ray(u, v)).cast<float>());
      if (hit.face < 0) {
        continue;
      }
      const Eigen::Vector3i& f = seen.mesh.faces[static_cast<std::size_t>(hit.face)];
      Eigen::Vector3f shown = Eigen::Vector3f::Zero();
      Eigen::Vector3f p = Eigen::Vector3f::Zero();
      for (int i = 0; i < 3; ++i) {
        shown += hit.barycentric[i] * colors.color[static_cast<std::size_t>(f[i])];
        p += hit.barycentric[i] * seen.mesh.vertices[static_cast<std::size_t>(f[i])];
      }
      if (isInner(p)) {
        const Eigen::Vector3f lacks = shown - colorVector(seen.keyframes[k].frame.color.at(u, v));
        sum += static_cast<double>(lacks.squaredNorm());
        count += 3.0;
      }
    }
  }
  return std::sqrt(sum / count);
}

/// Squared colour differences along edges, relative to the true texture's.
double sharpness(const TriangleMesh& mesh, const SeenColors& colors, const TexturedScene& scene) {
  const auto truth = [&](int i) {
    const Eigen::Vector3d p = mesh.vertices[static_cast<std::size_t>(i)].cast<double>();
    return scene.planeColor(p.x(), p.y());
  };
  double found = 0.0;
  double wanted = 0.0;
  for (const Eigen::Vector3i& f : mesh.faces) {
    if (isInner(mesh.vertices[static_cast<std::size_t>(f[0])])) {
      const Eigen::Vector3f difference = colors.color[static_cast<std::size_t>(f[0])] -
                                         colors.color[static_cast<std::size_t>(f[1])];
      found += static_cast<double>(difference.squaredNorm());
      wanted += (truth(f[0]) - truth(f[1])).squaredNorm();
    }
  }
  return found / wanted;
}

double rmsFrom(const TriangleMesh& mesh, const SeenColors& colors, const TexturedScene& scene) {
  double sum = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const Eigen::Vector3f& p = mesh.vertices[i];
    if (isInner(p)) {
      const Eigen::Vector3d truth =
          scene.planeColor(static_cast<double>(p.x()), static_cast<double>(p.y()));
      sum += (colors.color[i].cast<double>() - truth).squaredNorm();
      count += 3.0;
    }
  }
  return std::sqrt(sum / count);
}

TEST(FitColors, BringsTheDrawnModelNearerToThePictures) {
  const SeenColors blended = fineViews().blended();
  const SeenColors usual = fineViews().fitted();
  const SeenColors many = fineViews().fitted({.sweeps = 8});
  for (const std::size_t k : {0U, 5U}) {
    const double before = pictureRmse(fineViews(), blended, k);
    const double after = pictureRmse(fineViews(), usual, k);
    const double in_the_end = pictureRmse(fineViews(), many, k);
    std::printf("picture %zu: %.2f levels off blended, %.2f fitted, %.2f by eight sweeps\n",
                k,
                before,
                after,
                in_the_end);
    // A wave of four pixels loses a third to sampling in between and averaging; noise of 1 level
    // and rounding stay.
    EXPECT_LT(after, 0.8 * before);
    EXPECT_LT(in_the_end, after);
    EXPECT_LT(in_the_end, 0.4 * before);
  }
}

TEST(FitColors, SharpensTowardsTheTruth) {
  const TexturedScene scene = fineScene();
  const TriangleMesh& mesh = fineViews().mesh;
  const SeenColors blended = fineViews().blended();
  const SeenColors fitted = fineViews().fitted();
  const SeenColors many = fineViews().fitted({.sweeps = 8});
  const double before = sharpness(mesh, blended, scene);
  const double after = sharpness(mesh, fitted, scene);
  const double in_the_end = sharpness(mesh, many, scene);
  std::printf("gradient energy %.2f of the truth blended, %.2f fitted, %.2f by eight sweeps\n",
              before,
              after,
              in_the_end);
  EXPECT_LT(before, after - 0.1);
  EXPECT_LT(after, in_the_end);
  // A pixel is the mean over its square: of a wave of four pixels 0.9 is left along each axis, of
  // the energy 0.66. Sharper than the truth it must not be.
  EXPECT_GT(in_the_end, 0.6);
  EXPECT_LT(in_the_end, 1.0);
  EXPECT_LT(rmsFrom(mesh, fitted, scene), 0.85 * rmsFrom(mesh, blended, scene));
}

TEST(FitColors, KeepsNoiseWithinItsBound) {
  const TexturedScene scene{.half_size_mm = kHalf_mm + 10.0, .period_mm = 1e6};
  constexpr double kNoise = 6.0;
  const Seen seen(planeSurface(kHalf_mm, 1.0).mesh,
                  ringOfKeyframes(scene, smallCamera(), 8, kNoise));
  const double before = rmsFrom(seen.mesh, seen.blended(), scene);
  const double after = rmsFrom(seen.mesh, seen.fitted({.sweeps = 8}), scene);
  std::printf("noise of %.0f levels: %.2f blended, %.2f by eight sweeps\n", kNoise, before, after);
  // n sweeps of averaging operator P, eigenvalues l in [0, 1], give the pixels' noise the gain
  // (1 - (1 - l)^n) / sqrt(l), for n = 8 at most 1.88; there are 8 x 0.94 pixels to a vertex. What
  // the blend had of noise only shrinks.
  EXPECT_LT(after, before + 1.88 * kNoise / std::sqrt(8.0 * 0.94));
  // And never as noisy as one picture.
  EXPECT_LT(after, kNoise);
}

TEST(FitColors, IsNeverNoisierThanOnePicture) {
  // Vertices half a pixel apart, as the stage has them: there are two pixels to a vertex, and few
  // vertices have much of any pixel.
  const TexturedScene scene{.half_size_mm = kHalf_mm + 10.0, .period_mm = 1e6};
  constexpr double kNoise = 8.0;
  const Seen seen(planeSurface(kHalf_mm, 0.5).mesh,
                  ringOfKeyframes(scene, smallCamera(), 8, kNoise));
  const SeenColors fitted = seen.fitted();
  const double before = rmsFrom(seen.mesh, seen.blended(), scene);
  const double after = rmsFrom(seen.mesh, fitted, scene);
  double farthest = 0.0;
  for (std::size_t i = 0; i < fitted.color.size(); ++i) {
    if (isInner(seen.mesh.vertices[i])) {
      const double level = static_cast<double>(fitted.color[i].y());
      farthest = std::max(farthest, std::abs(level - 120.0));
    }
  }
  std::printf("noise of %.0f levels: %.2f blended, %.2f fitted, farthest %.1f\n",
              kNoise,
              before,
              after,
              farthest);
  EXPECT_LT(after, kNoise);
  EXPECT_LT(farthest, 5.5 * kNoise);  // 5000 vertices: 4 standard deviations are usual
}

TEST(FitColors, LeavesAgreeingColoursAlone) {
  const std::vector<RigidTransform> poses{lookAt({0, 0, 300}, {0, 0, 0}),
                                          lookAt({90, 0, 280}, {0, 0, 0})};
  const Seen seen(planeSurface(kHalf_mm, 1.0).mesh, evenKeyframes(poses, {140, 140}));
  for (const Eigen::Vector3f& color : seen.fitted().color) {
    EXPECT_LT((color - Eigen::Vector3f::Constant(140.0F)).norm(), 0.01F);
  }
}

TEST(FitColors, LeavesUnseenVerticesAlone) {
  const Seen& seen = fineViews();
  SeenColors colors = seen.blended();
  const Eigen::Vector3f mark(999.0F, -50.0F, 7.25F);
  for (std::size_t i = 0; i < colors.color.size(); ++i) {
    if (seen.mesh.vertices[i].norm() < 5.0F) {
      colors.seen[i] = 0;
      colors.color[i] = mark;
    }
  }
  fitColors(seen.mesh, seen.views, seen.gains, {}, colors);
  for (std::size_t i = 0; i < colors.color.size(); ++i) {
    const Eigen::Vector3f& p = seen.mesh.vertices[i];
    if (p.norm() < 5.0F) {
      EXPECT_EQ(colors.color[i], mark);
      EXPECT_EQ(colors.seen[i], 0);
    } else if (isInner(p)) {
      // Their neighbours do not take up the mark: the texture spans 80 levels in all.
      const Eigen::Vector3d truth =
          fineScene().planeColor(static_cast<double>(p.x()), static_cast<double>(p.y()));
      EXPECT_LT((colors.color[i].cast<double>() - truth).cwiseAbs().maxCoeff(), 45.0);
    }
  }
}

TEST(FitColors, NoSweepChangesNothing) {
  const SeenColors blended = fineViews().blended();
  const SeenColors fitted = fineViews().fitted({.sweeps = 0});
  EXPECT_EQ(blended.color, fitted.color);
  EXPECT_EQ(blended.seen, fitted.seen);
}

TEST(FitColors, CountsClippedPixelsLittle) {
  // Both look from 300 mm at 17 degrees: equal weights.
  const std::vector<RigidTransform> poses{lookAt({88, 0, 287}, {0, 0, 0}),
                                          lookAt({-88, 0, 287}, {0, 0, 0})};
  const auto fittedMean = [&](std::uint8_t second, std::uint8_t first = 242) {
    const Seen seen(planeSurface(kHalf_mm, 1.0).mesh, evenKeyframes(poses, {first, second}));
    const SeenColors colors = seen.fitted();
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < colors.color.size(); ++i) {
      if (isInner(seen.mesh.vertices[i])) {
        sum += static_cast<double>(colors.color[i].x());
        count += 1.0;
      }
    }
    return sum / count;
  };
  EXPECT_NEAR(fittedMean(248), 245.0, 0.5);  // not clipped: the mean
  // Clipped pixels weigh a twentieth, or nothing beside good ones: 242 + 10 / 21 at most.
  EXPECT_GT(fittedMean(252), 241.9);
  EXPECT_LT(fittedMean(252), 242.5);
  EXPECT_NEAR(fittedMean(252, 252), 252.0, 0.01);  // where there is nothing else
}

TEST(FitColors, LevelsExposure) {
  const std::vector<RigidTransform> poses{lookAt({88, 0, 287}, {0, 0, 0}),
                                          lookAt({-88, 0, 287}, {0, 0, 0})};
  Seen seen(planeSurface(kHalf_mm, 1.0).mesh, evenKeyframes(poses, {100, 125}));
  seen.gains[1].gain = Eigen::Vector3f::Constant(1.2F);
  seen.gains[1].bias = Eigen::Vector3f::Constant(5.0F);
  for (const Eigen::Vector3f& color : seen.fitted().color) {
    EXPECT_LT((color - Eigen::Vector3f::Constant(100.0F)).norm(), 0.01F);
  }
}

TEST(FitColors, GivesTheSameBitsOnAnyNumberOfThreads) {
  const SeenColors many = fineViews().fitted();
  const ThreadLimit limit(1);
  const SeenColors one = fineViews().fitted();
  EXPECT_EQ(many.color, one.color);
  EXPECT_EQ(many.seen, one.seen);
}

TEST(BlendViews, TakesTheBestView) {
  const std::vector<RigidTransform> poses{lookAt({150, 0, 260}, {0, 0, 0}),
                                          lookAt({0, 0, 300}, {0, 0, 0})};
  const Seen seen(planeSurface(kHalf_mm, 2.0).mesh, evenKeyframes(poses, {180, 100}));
  const SeenColors best = seen.blended(1);
  const SeenColors both = seen.blended(2);
  for (std::size_t i = 0; i < best.color.size(); ++i) {
    ASSERT_EQ(best.seen[i], 1);
    if (seen.mesh.vertices[i].norm() < 8.0F) {  // elsewhere the tilted view is nearer
      EXPECT_NEAR(best.color[i].x(), 100.0F, 0.01F);
      // cos^2 of 30 degrees: the mean of 100 and 0.75 x 180.
      EXPECT_NEAR(both.color[i].x(), 134.3F, 4.0F);
    }
  }
}

TEST(BlendViews, MistrustsAnOddView) {
  const std::vector<RigidTransform> poses{lookAt({80, 0, 290}, {0, 0, 0}),
                                          lookAt({-40, 69, 290}, {0, 0, 0}),
                                          lookAt({-40, -69, 290}, {0, 0, 0})};
  const Seen seen(planeSurface(kHalf_mm, 2.0).mesh, evenKeyframes(poses, {100, 190, 100}));
  for (const Eigen::Vector3f& color : seen.blended().color) {
    EXPECT_LT(color.x(), 103.0F);  // the mean is 130
  }
}

TEST(BlendViews, MarksWhatNoViewSees) {
  TriangleMesh mesh = planeSurface(kHalf_mm, 2.0).mesh;
  mesh.normals[7] = -Eigen::Vector3f::UnitZ();
  const Seen seen(std::move(mesh), evenKeyframes({lookAt({0, 0, 300}, {0, 0, 0})}, {100}));
  const SeenColors colors = seen.blended();
  EXPECT_EQ(colors.seen[7], 0);
  EXPECT_EQ(colors.seen[8], 1);
}

}  // namespace
}  // namespace tarsus
