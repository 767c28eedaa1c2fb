#include "reconstruction/texture/color_card.h"

#include "reconstruction/texture/card_detection.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr double kPitch_mm = 20.0;

RgbdCamera camera() {
  RgbdCamera camera;
  camera.depth = {
      .width = 640, .height = 480, .fx_px = 600, .fy_px = 600, .cx_px = 319.5, .cy_px = 239.5};
  camera.color = camera.depth;
  return camera;
}

/// Sum of four even numbers: nearly normal, standard deviation 1.
double noise(std::uint32_t key) {
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    key = (key ^ (key >> 16U)) * 0x45d9f3bU + 0x9E3779B9U;
    sum += (key >> 8U) * 0x1.0p-24 - 0.5;
  }
  return sum * std::sqrt(3.0);
}

struct Light {
  Eigen::Vector3d gain = Eigen::Vector3d::Ones();
  double noise_levels = 0.0;
  double depth_scale = 1.0;  ///< 1.03: a scan that is 3 % too large
};

/// A card on a grey-brown table, z = 0, its middle in the origin, rows along x.
Eigen::Vector3d tableColor(const Eigen::Vector2d& p_mm) {
  const double x = p_mm.x() / kPitch_mm + 2.5;
  const double y = p_mm.y() / kPitch_mm + 1.5;
  if (x < -0.65 || x > 5.65 || y < -0.65 || y > 3.65) {
    return {150.0, 130.0, 115.0};
  }
  const double column = std::round(x);
  const double row = std::round(y);
  const bool on_patch = column >= 0.0 && column <= 5.0 && row >= 0.0 && row <= 3.0 &&
                        std::max(std::abs(x - column), std::abs(y - row)) < 0.4545;
  return on_patch ? Eigen::Vector3d(cardColor(static_cast<int>(6.0 * row + column)).cast<double>())
                  : Eigen::Vector3d(25.0, 25.0, 25.0);
}

Eigen::Vector3d pixelColor(const RgbdCamera& camera, const RigidTransform& pose, int u, int v) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 16; ++k) {
    const double du = (k % 4 - 1.5) / 4.0;
    const double dv = (k / 4 - 1.5) / 4.0;
    const Eigen::Vector3d ray = pose.linear() * camera.color.ray(u + du, v + dv);
    const Eigen::Vector3d p = pose.translation() - pose.translation().z() / ray.z() * ray;
    sum += tableColor(p.head<2>());
  }
  return sum / 16.0;
}

Keyframe cardPicture(const Eigen::Vector3d& from, const Light& light) {
  const RgbdCamera cam = camera();
  Keyframe keyframe;
  keyframe.scan_from_camera = lookAt(from, Eigen::Vector3d(5.0, -4.0, 0.0));
  keyframe.frame.color = ColorImage(640, 480);
  keyframe.frame.depth = DepthImage(640, 480);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; ++u) {
      Eigen::Vector3d color =
          pixelColor(cam, keyframe.scan_from_camera, u, v).cwiseProduct(light.gain);
      for (int c = 0; c < 3; ++c) {
        color[c] += light.noise_levels * noise(static_cast<std::uint32_t>((v * 640 + u) * 3 + c));
      }
      const auto level = [&](int c) {
        return static_cast<std::uint8_t>(std::lround(std::clamp(color[c], 0.0, 255.0)));
      };
      keyframe.frame.color.at(u, v) = {level(0), level(1), level(2)};
      const Eigen::Vector3d ray = keyframe.scan_from_camera.linear() * cam.depth.ray(u, v);
      keyframe.frame.depth.at(u, v) = static_cast<float>(-light.depth_scale * from.z() / ray.z());
    }
  }
  return keyframe;
}

/// From below in z, where the card's rows are not mirrored.
std::vector<Keyframe> cardPictures(const Light& light) {
  std::vector<Keyframe> keyframes;
  for (const Eigen::Vector3d& from : {Eigen::Vector3d(20.0, 30.0, -330.0),
                                      Eigen::Vector3d(-140.0, 20.0, -280.0),
                                      Eigen::Vector3d(60.0, 150.0, -300.0)}) {
    keyframes.push_back(cardPicture(from, light));
  }
  return keyframes;
}

TEST(FindColorCard, GivesBackACastAndTheScale) {
  const Light light{.gain = {0.9, 1.0, 0.78}, .noise_levels = 3.0};
  const auto reading =
      findColorCard(cardPictures(light), camera(), {.patch_pitch_mm = kPitch_mm}, Job{});
  ASSERT_TRUE(reading && *reading);
  EXPECT_EQ((*reading)->pictures, 3);
  for (int c = 0; c < 3; ++c) {
    const double product = static_cast<double>((*reading)->white_gain[c]) * light.gain[c];
    EXPECT_NEAR(product, 1.0, 0.02) << c;
  }
  EXPECT_LT((*reading)->gain_spread, 0.02);
  EXPECT_LT((*reading)->residual_levels, 3.0);
  ASSERT_TRUE((*reading)->scale);
  EXPECT_NEAR((*reading)->scale->measured_over_true, 1.0, 0.005);
  EXPECT_LT((*reading)->scale->uncertainty, 0.01);
}

TEST(FindColorCard, TellsAScanThatIsTooLarge) {
  const auto reading = findColorCard(
      cardPictures({.depth_scale = 1.03}), camera(), {.patch_pitch_mm = kPitch_mm}, Job{});
  ASSERT_TRUE(reading && *reading && (*reading)->scale);
  EXPECT_NEAR((*reading)->scale->measured_over_true, 1.03, 0.005);
}

TEST(FindColorCard, WithoutTheCardsSizeThereIsNoScale) {
  const auto pictures = cardPictures({});
  const auto reading = findColorCard(std::span(pictures).first(1), camera(), {}, Job{});
  ASSERT_TRUE(reading && *reading);
  EXPECT_FALSE((*reading)->scale);
}

TEST(FindColorCard, SeesNoneWhereThereIsNone) {
  const TexturedScene scene{.balls = {{.center_mm = {10.0, 5.0, 20.0}, .radius_mm = 15.0}}};
  const auto ring = ringOfKeyframes(scene, smallCamera(), 4, 3.0);
  const auto reading = findColorCard(ring, smallCamera(), {}, Job{});
  ASSERT_TRUE(reading);
  EXPECT_FALSE(*reading);
  EXPECT_FALSE(detectCard(ColorImage(640, 480)));
}

TEST(FindColorCard, APatternInOtherColoursIsNoCard) {
  std::vector<Keyframe> pictures = cardPictures({});
  for (Keyframe& keyframe : pictures) {
    for (Rgb8& c : keyframe.frame.color.pixels()) {
      c = {c.b, c.r, c.g};
    }
  }
  const auto reading = findColorCard(pictures, camera(), {}, Job{});
  ASSERT_TRUE(reading);
  EXPECT_FALSE(*reading);
}

TEST(FindColorCard, Stops) {
  std::stop_source stop;
  stop.request_stop();
  const auto reading = findColorCard({}, camera(), {}, Job{.stop = stop.get_token()});
  ASSERT_FALSE(reading);
  EXPECT_EQ(reading.error().code, ErrorCode::Cancelled);
}

TexturedMesh tinted(Rgb8 color) {
  TexturedMesh model;
  for (int i = 0; i < 400; ++i) {
    model.mesh.vertices.emplace_back(static_cast<float>(i % 20), static_cast<float>(i / 20), 0.0F);
    const bool card = model.mesh.vertices.back().norm() < 12.0F;
    model.colors.push_back(card ? color : Rgb8{200, 150, 120});
  }
  return model;
}

TEST(ReadGreyCard, MakesThePlaceGreyAndKeepsItsLuminance) {
  const TexturedMesh model = tinted({120, 128, 100});
  const auto reading = readGreyCard(model, {.center_mm = {0.0, 0.0, 0.0}, .radius_mm = 8.0});
  ASSERT_TRUE(reading);
  const TexturedMesh balanced = whiteBalanced(model, reading->white_gain);
  const Rgb8 grey = balanced.colors.front();
  const double luminance = 0.299 * 120 + 0.587 * 128 + 0.114 * 100;
  EXPECT_NEAR(grey.r, luminance, 0.6);  // rounded to whole levels
  EXPECT_NEAR(grey.g, luminance, 0.6);
  EXPECT_NEAR(grey.b, luminance, 0.6);
  EXPECT_NE(balanced.sha256, withHash(model).sha256);
}

TEST(ReadGreyCard, RefusesAPlaceBesideTheModelAndABurntOutCard) {
  const auto beside =
      readGreyCard(tinted({120, 128, 100}), {.center_mm = {500.0, 0.0, 0.0}, .radius_mm = 8.0});
  ASSERT_FALSE(beside);
  EXPECT_EQ(beside.error().code, ErrorCode::BadOption);
  const auto burnt = readGreyCard(tinted({255, 255, 250}), {.radius_mm = 8.0});
  ASSERT_FALSE(burnt);
  EXPECT_EQ(burnt.error().code, ErrorCode::BadOption);
}

}  // namespace
}  // namespace tarsus
