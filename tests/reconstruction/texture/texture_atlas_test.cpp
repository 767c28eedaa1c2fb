#include "reconstruction/texture/texture_atlas.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/color_sampling.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <set>

namespace tarsus {
namespace {

constexpr double kHalf_mm = 50.0;
/// Away from the plane's rim, where the background bleeds into the pictures.
constexpr float kInner_mm = 40.0F;

/// Two cameras left and right, the one's exposure up, the other's down.
std::vector<Keyframe> twoExposures(const TexturedScene& scene, const RgbdCamera& camera) {
  std::vector<Keyframe> keyframes;
  for (const double side : {-1.0, 1.0}) {
    Keyframe keyframe;
    keyframe.scan_from_camera = lookAt({side * 70.0, 0.0, 240.0}, {side * 10.0, 0.0, 0.0});
    keyframe.frame = takeFrame(
        scene,
        camera,
        keyframe.scan_from_camera,
        {.gain = Eigen::Vector3d(1.0 + 0.12 * side, 1.0 + 0.10 * side, 1.0 + 0.08 * side)});
    keyframe.blur = 0.3;
    keyframes.push_back(std::move(keyframe));
  }
  return keyframes;
}

TextureAtlas makeAtlas(const ExtractedSurface& surface,
                       const std::vector<Keyframe>& keyframes,
                       const TextureAtlasOptions& options = {}) {
  const auto views = renderViews(surface.mesh, smallCamera(), keyframes, {});
  EXPECT_TRUE(views);
  auto atlas = makeTextureAtlas(
      {.mesh = &surface.mesh, .colors = surface.colors, .views = *views, .keyframes = keyframes},
      options,
      Job{});
  EXPECT_TRUE(atlas) << describe(atlas.error());
  return atlas ? std::move(*atlas) : TextureAtlas();
}

/// Colour of the atlas as a viewer looks it up, between four texels.
Eigen::Vector3f lookUp(const TextureAtlas& atlas, const Eigen::Vector2f& uv) {
  const float u = uv.x() * static_cast<float>(atlas.image.width()) - 0.5F;
  const float v = (1.0F - uv.y()) * static_cast<float>(atlas.image.height()) - 0.5F;
  return sampleColor(atlas.image, u, v);
}

struct Place {
  Eigen::Vector3f p_mm;
  Eigen::Vector3f color;
};

/// Points all over each face, and what the atlas shows there.
std::vector<Place> places(const TextureAtlas& atlas) {
  std::vector<Place> result;
  const AtlasMesh& model = atlas.model;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    for (const Eigen::Vector3f& weights : {Eigen::Vector3f(0.8F, 0.1F, 0.1F),
                                           Eigen::Vector3f(0.1F, 0.5F, 0.4F),
                                           Eigen::Vector3f(0.0F, 0.5F, 0.5F),
                                           Eigen::Vector3f(1.0F, 0.0F, 0.0F)}) {
      Place place{Eigen::Vector3f::Zero(), Eigen::Vector3f::Zero()};
      Eigen::Vector2f uv = Eigen::Vector2f::Zero();
      for (int k = 0; k < 3; ++k) {
        place.p_mm +=
            weights[k] * model.mesh.vertices[static_cast<std::size_t>(model.mesh.faces[f][k])];
        uv += weights[k] * model.uv[static_cast<std::size_t>(model.uv_faces[f][k])];
      }
      place.color = lookUp(atlas, uv);
      result.push_back(place);
    }
  }
  return result;
}

/// Greatest difference between the colours that one vertex has at its several places.
double worstSeamStep(const TextureAtlas& atlas, float within_mm) {
  const AtlasMesh& model = atlas.model;
  std::vector<int> first(model.mesh.vertices.size(), -1);
  double worst = 0.0;
  for (std::size_t f = 0; f < model.mesh.faces.size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(model.mesh.faces[f][k]);
      const int place = model.uv_faces[f][k];
      if (first[vertex] < 0) {
        first[vertex] = place;
      }
      if (model.mesh.vertices[vertex].cwiseAbs().maxCoeff() < within_mm) {
        const Eigen::Vector3f step =
            lookUp(atlas, model.uv[static_cast<std::size_t>(first[vertex])]) -
            lookUp(atlas, model.uv[static_cast<std::size_t>(place)]);
        worst = std::max(worst, static_cast<double>(step.cwiseAbs().mean()));
      }
    }
  }
  return worst;
}

/// Which of the pictures' two exposures is right nobody can know: one factor for each channel.
Eigen::Vector3d fittedGain(const std::vector<Place>& found, const TexturedScene& scene) {
  Eigen::Vector3d products = Eigen::Vector3d::Zero();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const Place& place : found) {
    const Eigen::Vector3d truth =
        scene.planeColor(static_cast<double>(place.p_mm.x()), static_cast<double>(place.p_mm.y()));
    products += truth.cwiseProduct(place.color.cast<double>());
    squares += truth.cwiseProduct(truth);
  }
  return products.cwiseQuotient(squares);
}

TEST(TextureAtlas, GivesThePatternBackFromTwoExposures) {
  const TexturedScene scene{.period_mm = 25.0};
  const std::vector<Keyframe> keyframes = twoExposures(scene, smallCamera());
  const TextureAtlas atlas = makeAtlas(planeSurface(kHalf_mm, 4.0), keyframes);
  std::vector<Place> inner;
  for (const Place& place : places(atlas)) {
    if (place.p_mm.cwiseAbs().maxCoeff() < kInner_mm) {
      inner.push_back(place);
    }
  }
  ASSERT_GT(inner.size(), 1000U);
  const Eigen::Vector3d gain = fittedGain(inner, scene);
  double worst = 0.0;
  for (const Place& place : inner) {
    const Eigen::Vector3d truth =
        scene.planeColor(static_cast<double>(place.p_mm.x()), static_cast<double>(place.p_mm.y()));
    const Eigen::Vector3d error = place.color.cast<double>() - gain.cwiseProduct(truth);
    worst = std::max(worst, error.cwiseAbs().maxCoeff());
  }
  std::printf("worst error %.2f levels, %d charts, seams %.3f -> %.3f levels\n",
              worst,
              atlas.charts,
              atlas.seam_step_before,
              atlas.seam_step_after);
  EXPECT_LT(worst, 2.0);
  EXPECT_LT(atlas.seam_step_after, 0.5);
}

TEST(TextureAtlas, LevelsSeamsThatExposureLeft) {
  const TexturedScene scene{.period_mm = 25.0};
  const std::vector<Keyframe> keyframes = twoExposures(scene, smallCamera());
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  const auto views = renderViews(surface.mesh, smallCamera(), keyframes, {});
  ASSERT_TRUE(views);
  // The pictures' gains are said to be 1: a tenth of the colour, 10 to 30 levels, is left.
  const std::vector<ColorGain> gains(2);
  const TextureAtlasSource source{
      .mesh = &surface.mesh, .views = *views, .keyframes = keyframes, .gains = gains};
  const auto levelled = makeTextureAtlas(source, {}, Job{});
  const auto raw = makeTextureAtlas(source, {.level_seams = false}, Job{});
  ASSERT_TRUE(levelled && raw);
  const double before = worstSeamStep(*raw, kInner_mm);
  const double after = worstSeamStep(*levelled, kInner_mm);
  std::printf("worst step at a seam %.2f -> %.2f levels\n", before, after);
  EXPECT_GT(before, 15.0);
  EXPECT_LT(after, 1.0);
}

TEST(TextureAtlas, PlacesLieInThePictureAndChartsApart) {
  ExtractedSurface surface = planeSurface(kHalf_mm, 4.0);
  appendBall(surface, {.center_mm = {0, 0, 30}, .radius_mm = 15.0, .color = {}}, 12);
  TexturedScene scene;
  scene.balls.push_back({.center_mm = {0, 0, 30}, .radius_mm = 15.0, .color = {200, 150, 90}});
  const TextureAtlas atlas = makeAtlas(surface, ringOfKeyframes(scene, smallCamera(), 6));
  for (const Eigen::Vector2f& uv : atlas.model.uv) {
    EXPECT_GE(uv.minCoeff(), 0.0F);
    EXPECT_LE(uv.maxCoeff(), 1.0F);
  }
  // Charts: places joined by faces. No texel's centre lies in faces of two charts.
  std::vector<int> chart(atlas.model.uv.size());
  for (std::size_t i = 0; i < chart.size(); ++i) {
    chart[i] = static_cast<int>(i);
  }
  const auto root = [&chart](int i) {
    while (chart[static_cast<std::size_t>(i)] != i) {
      i = chart[static_cast<std::size_t>(i)];
    }
    return i;
  };
  for (const Eigen::Vector3i& face : atlas.model.uv_faces) {
    chart[static_cast<std::size_t>(root(face[1]))] = root(face[0]);
    chart[static_cast<std::size_t>(root(face[2]))] = root(face[0]);
  }
  Image<int> owner(atlas.image.width(), atlas.image.height());
  for (const Eigen::Vector3i& face : atlas.model.uv_faces) {
    std::array<Eigen::Vector2f, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector2f& uv =
          atlas.model.uv[static_cast<std::size_t>(face[static_cast<Eigen::Index>(k)])];
      corner[k] = {uv.x() * static_cast<float>(owner.width()) - 0.5F,
                   (1.0F - uv.y()) * static_cast<float>(owner.height()) - 0.5F};
    }
    const Eigen::Vector2f low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
    const Eigen::Vector2f high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
    // The whole box and a texel around: stricter than the face.
    for (int v = static_cast<int>(low.y()); v <= static_cast<int>(high.y()) + 1; ++v) {
      for (int u = static_cast<int>(low.x()); u <= static_cast<int>(high.x()) + 1; ++u) {
        ASSERT_GE(std::min(u, v), 0);
        ASSERT_LT(u, owner.width());
        ASSERT_LT(v, owner.height());
        const int own = root(face[0]) + 1;
        EXPECT_TRUE(owner.at(u, v) == 0 || owner.at(u, v) == own);
        owner.at(u, v) = own;
      }
    }
  }
}

TEST(TextureAtlas, WhatNoViewSeesHasItsVerticesColours) {
  const TexturedScene scene;
  ExtractedSurface surface = planeSurface(kHalf_mm, 4.0);
  appendBall(surface, {.center_mm = {0, 0, -40}, .radius_mm = 10.0, .color = {}}, 8);  // below
  const std::vector<Keyframe> keyframes = twoExposures(scene, smallCamera());
  const auto check = [&](const TextureAtlas& atlas, const Eigen::Vector3f& wanted, float within) {
    EXPECT_GT(atlas.unseen_fraction, 0.05);
    for (const Place& place : places(atlas)) {
      EXPECT_GT(place.color.minCoeff(), 30.0F) << place.p_mm.transpose();
      if (place.p_mm.z() < -1.0F) {
        EXPECT_LT((place.color - wanted).cwiseAbs().maxCoeff(), within);
      }
    }
  };
  surface.colors.assign(surface.mesh.vertices.size(), Rgb8{180, 140, 120});
  check(makeAtlas(surface, keyframes), {180, 140, 120}, 1.0F);
  surface.colors.clear();  // nothing is known of the ball: neutral
  check(makeAtlas(surface, keyframes), {128, 128, 128}, 1.0F);
}

TEST(TextureAtlas, AvoidsAViewOfAnOddColour) {
  const TexturedScene scene{.period_mm = 25.0};
  std::vector<Keyframe> keyframes = ringOfKeyframes(scene, smallCamera(), 5);
  // The best view of the middle has a highlight there.
  keyframes.push_back(keyframes.front());
  Keyframe& best = keyframes.back();
  best.scan_from_camera = lookAt({0, 0, 250}, {0, 0, 0});
  best.frame = takeFrame(scene, smallCamera(), best.scan_from_camera);
  for (int v = 110; v < 130; ++v) {
    for (int u = 150; u < 170; ++u) {
      best.frame.color.at(u, v) = {250, 250, 250};
    }
  }
  const TextureAtlas atlas = makeAtlas(planeSurface(kHalf_mm, 2.0), keyframes);
  for (const Place& place : places(atlas)) {
    if (place.p_mm.cwiseAbs().maxCoeff() < 6.0F) {
      EXPECT_LT(place.color.x(), 115.0F) << place.p_mm.transpose();  // the plane's red is below 95
    }
  }
}

TEST(TextureAtlas, ShrinksWhatDoesNotFitAndRefusesTheImpossible) {
  const TexturedScene scene{.period_mm = 25.0};
  const std::vector<Keyframe> keyframes = twoExposures(scene, smallCamera());
  const ExtractedSurface surface = planeSurface(kHalf_mm, 4.0);
  const TextureAtlas small = makeAtlas(surface, keyframes, {.max_size_px = 128});
  EXPECT_LE(small.image.width(), 128);
  EXPECT_LE(small.image.height(), 128);
  EXPECT_LT(small.texels_per_px, 1.0);
  const auto views = renderViews(surface.mesh, smallCamera(), keyframes, {});
  ASSERT_TRUE(views);
  const auto none = makeTextureAtlas(
      {.mesh = &surface.mesh, .views = *views, .keyframes = keyframes}, {.max_size_px = 8}, Job{});
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, ErrorCode::BadOption);
}

TEST(TextureAtlas, GivesTheSameBitsForAnyNumberOfThreads) {
  const std::vector<Keyframe> keyframes = ringOfKeyframes({}, smallCamera(), 4, 3.0);
  const ExtractedSurface surface = planeSurface(kHalf_mm, 2.0);
  const auto bytesOf = [&](int threads) {
    const ThreadLimit limit(threads);
    const TextureAtlas atlas = makeAtlas(surface, keyframes);
    std::vector<float> all;
    for (const Rgb8 c : atlas.image.pixels()) {
      all.push_back(static_cast<float>(c.r + 256 * c.g + 65536 * c.b));
    }
    for (const Eigen::Vector2f& uv : atlas.model.uv) {
      all.insert(all.end(), {uv.x(), uv.y()});
    }
    return all;
  };
  EXPECT_EQ(bytesOf(1), bytesOf(4));
}

TEST(TextureAtlas, StopsWhenAsked) {
  const ExtractedSurface surface = planeSurface(10.0, 5.0);
  std::stop_source stop;
  stop.request_stop();
  const auto atlas = makeTextureAtlas({.mesh = &surface.mesh}, {}, Job{.stop = stop.get_token()});
  ASSERT_FALSE(atlas);
  EXPECT_EQ(atlas.error().code, ErrorCode::Cancelled);
  const auto empty = makeTextureAtlas({}, {}, Job{});
  ASSERT_FALSE(empty);
  EXPECT_EQ(empty.error().code, ErrorCode::SurfaceEmpty);
}

TEST(PackCharts, BoxesDoNotOverlapAndFillTheSheet) {
  std::vector<ChartBox> boxes;
  std::uint32_t state = 7;
  int area = 0;
  for (int i = 0; i < 300; ++i) {
    state = state * 1664525U + 1013904223U;
    const int width = 9 + static_cast<int>(state >> 26U);
    const int height = 9 + static_cast<int>(state >> 20U & 63U);
    boxes.push_back({.width = width, .height = height});
    area += width * height;
  }
  const ChartPacking packing = packCharts(boxes);
  Image<int> taken(packing.width, packing.height);
  for (const ChartBox& box : packing.boxes) {
    for (int v = box.v; v < box.v + box.height; ++v) {
      for (int u = box.u; u < box.u + box.width; ++u) {
        ASSERT_EQ(taken.at(u, v)++, 0);
      }
    }
  }
  // Skylines of mixed boxes waste about a tenth; a quarter would mean a fault.
  EXPECT_LT(packing.width * packing.height, area * 5 / 4);
}

}  // namespace
}  // namespace tarsus
