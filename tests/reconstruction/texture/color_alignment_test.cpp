#include "reconstruction/texture/color_alignment.h"

#include "reconstruction/base/parallel.h"
#include "tests/reconstruction/texture/ball_pictures.h"
#include "tests/reconstruction/texture/textured_scene.h"

#include <Eigen/LU>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace tarsus {
namespace {

constexpr int kPictures = kBallPictures;
constexpr double kTurn_rad = 0.5 * std::numbers::pi / 180.0;

const Intrinsics& pinhole() {
  static const Intrinsics kPinhole = smallCamera().color;
  return kPinhole;
}

double bendAt(double v) { return 1.5 * std::cos(2.0 * std::numbers::pi * v / 240.0); }
Eigen::Vector2d unbent(const Eigen::Vector2d& place) {
  return {place.x() - bendAt(place.y()), place.y()};
}

/// Off by 2 mm and half a degree about the ball's top, each picture elsewhere.
RigidTransform wrongPose(int k, double share = 1.0) {
  const auto direction = [](double phase) {
    return Eigen::Vector3d(std::sin(phase), std::cos(1.7 * phase), std::sin(2.3 * phase + 1.0))
        .normalized();
  };
  MotionVector off;
  off << kMotionLever_mm * kTurn_rad * direction(1.9 * k + 0.3), 2.0 * direction(2.9 * k);
  return motionOf(share * off, trueBallPose(k).translation()) * trueBallPose(k);
}

BallPictures wronglyPlaced() {
  BallPictures setup = wellPlacedBallPictures();
  for (int k = 0; k < kPictures; ++k) {
    setup.pictures[static_cast<std::size_t>(k)].place.color_from_scan = wrongPose(k);
  }
  return setup;
}

ColorAlignment align(BallPictures& setup,
                     const ColorAlignmentOptions& options = {},
                     const Job& job = {}) {
  return alignPictures(setup.vertices, pinhole(), setup.pictures, options, job);
}

ColorAlignmentOptions posesAlone() { return {.lattice_iterations = 0}; }

double greatest(const std::vector<double>& values, int except = -1) {
  double result = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    result = static_cast<int>(k) == except ? result : std::max(result, values[k]);
  }
  return result;
}

void expectNeverUp(const std::vector<double>& rmse) {
  for (std::size_t i = 1; i < rmse.size(); ++i) {
    // A hundred-thousandth for sums in another order.
    EXPECT_LE(rmse[i], rmse[i - 1] * 1.00001) << "entry " << i << " of " << rmse.size();
  }
}

void expectValid(const PicturePlacement& place) {
  const Eigen::Matrix3d turn = place.color_from_scan.linear();
  EXPECT_TRUE(place.color_from_scan.matrix().allFinite());
  EXPECT_LT((turn.transpose() * turn - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_GT(turn.determinant(), 0.0);
  for (const Eigen::Vector2f& offset : place.warp.offsets_px()) {
    EXPECT_TRUE(offset.allFinite());
  }
}

/// How far what a picture shows has moved in it [px RMS].
double movedBy(const BallPictures& setup, std::size_t k, const RigidTransform& before) {
  double sum = 0.0;
  for (const SightLine& line : setup.pictures[k].sight) {
    const Eigen::Vector3d p = setup.vertices[line.vertex].cast<double>();
    const PicturePlacement& place = setup.pictures[k].place;
    const Eigen::Vector2f now =
        place.warp.warped(pinhole().project(place.color_from_scan * p).cast<float>());
    sum += (now.cast<double>() - pinhole().project(before * p)).squaredNorm();
  }
  return std::sqrt(sum /
                   static_cast<double>(std::max<std::size_t>(1, setup.pictures[k].sight.size())));
}

TEST(AlignPictures, BringsWrongPosesTogether) {
  BallPictures setup = wronglyPlaced();
  const double before_px = greatest(relativeErrors(setup));
  EXPECT_GT(before_px, 1.5);
  const ColorAlignment wrong = align(setup, posesAlone());
  BallPictures truth = wellPlacedBallPictures();
  const ColorAlignment right = align(truth, posesAlone());
  const double after_px = greatest(relativeErrors(setup));
  std::printf("wrong poses: %.2f px to %.3f px, RMSE to %.3f levels, from true poses %.3f\n",
              before_px,
              after_px,
              wrong.rmse.back(),
              right.rmse.back());
  EXPECT_LT(after_px, 0.1);
  ASSERT_FALSE(wrong.rmse.empty());
  ASSERT_FALSE(right.rmse.empty());
  // What is left is the noise of the pictures, as from the true poses.
  EXPECT_LT(wrong.rmse.back(), 1.03 * right.rmse.back());
  expectNeverUp(wrong.rmse);
  expectNeverUp(right.rmse);
  EXPECT_LT(greatest(relativeErrors(truth)), 0.1);
}

TEST(AlignPictures, TakesThePhotometricErrorDownToTheNoise) {
  // One iteration at full size alone: the first entry is the error of the poses as given.
  BallPictures unmoved = wronglyPlaced();
  const ColorAlignment first = align(unmoved, {.rigid_iterations = 1, .lattice_iterations = 0});
  BallPictures setup = wronglyPlaced();
  const ColorAlignment all = align(setup, posesAlone());
  ASSERT_FALSE(first.rmse.empty());
  std::printf("RMSE %.2f levels as given, %.3f in the end\n", first.rmse.front(), all.rmse.back());
  // Waves of 6 to 16 levels are out of step by 1 to 3 px of their 10 to 61 px: several levels.
  // Noise of 2 levels leaves the smoothing kernel (1 2 1) / 4 with 3/8 of it, 0.75, and the
  // vertices' means of six take a sixth of its square with them: 0.68 levels.
  EXPECT_GT(first.rmse.front(), 3.0);
  EXPECT_LT(all.rmse.back(), 0.9);
  EXPECT_LT(all.rmse.back(), first.rmse.front() / 4.0);
}

TEST(AlignPictures, StraightensABentPicture) {
  const auto bent = [] {
    BallPictures setup = wellPlacedBallPictures();
    setup.pictures[2].intensity = takeBallPicture(trueBallPose(2), 2, unbent);
    return setup;
  };
  std::vector<Unbend> unbends(kPictures);
  unbends[2] = unbent;
  BallPictures rigid = bent();
  align(rigid, posesAlone());
  BallPictures setup = bent();
  const ColorAlignment alignment = align(setup);
  const std::vector<double> rigid_px = relativeErrors(rigid, 2, unbends);
  const std::vector<double> lattice_px = relativeErrors(setup, 2, unbends);
  std::printf("a bend of 1.5 px: %.3f px left by poses, %.3f px by the lattice\n",
              rigid_px[2],
              lattice_px[2]);
  // The ball fills two thirds of the picture's height: there the cosine is nearly a parabola of
  // 0.9 px RMS, of which a pose can take no more than the tilt of a curved surface gives.
  EXPECT_GT(rigid_px[2], 0.45);
  EXPECT_LT(lattice_px[2], 0.3);
  EXPECT_LT(greatest(lattice_px, 2), 0.15);
  expectNeverUp(alignment.rmse);
  for (const AlignedPicture& picture : setup.pictures) {
    EXPECT_FALSE(picture.place.warp.empty());
    expectValid(picture.place);
  }
}

TEST(AlignPictures, LeavesPicturesStraightThatAre) {
  BallPictures setup = wronglyPlaced();
  align(setup);
  EXPECT_LT(greatest(relativeErrors(setup)), 0.15);
  double squares = 0.0;
  double count = 0.0;
  for (const AlignedPicture& picture : setup.pictures) {
    for (const Eigen::Vector2f& offset : picture.place.warp.offsets_px()) {
      squares += static_cast<double>(offset.squaredNorm());
      count += 1.0;
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.3);
}

/// An anchor of a shape that holds all directions alike.
PoseAnchor evenAnchor(const RigidTransform& color_from_scan) {
  PoseAnchor anchor{.color_from_scan = color_from_scan,
                    .center = color_from_scan.translation(),  // the scan's origin
                    .stiffness = MotionMatrix::Identity() / 3.0};
  anchor.stiffness.topLeftCorner<3, 3>() *= 0.2;  // shapes are smaller than the lever
  return anchor;
}

/// Nothing but noise.
void wipe(Image<float>& picture) {
  for (std::uint64_t i = 0; i < picture.pixels().size(); ++i) {
    picture.pixels()[i] = static_cast<float>(120.0 + 2.0 * seededNoise(777'000 + i));
  }
}

TEST(AlignPictures, AnchorHoldsAPictureWithoutTexture) {
  BallPictures setup = wronglyPlaced();
  wipe(setup.pictures[4].intensity);
  for (int k = 0; k < kPictures; ++k) {
    setup.pictures[static_cast<std::size_t>(k)].anchor = evenAnchor(wrongPose(k));
  }
  const ColorAlignment alignment = align(setup);
  const double moved_px = movedBy(setup, 4, wrongPose(4));
  std::printf("a picture without texture, anchored: moved %.2f px\n", moved_px);
  // 0.3 mm along the normals, 0.5 mm in all; three times that.
  EXPECT_LT(moved_px, 1.5);
  expectValid(setup.pictures[4].place);
  expectNeverUp(alignment.rmse);
}

TEST(AlignPictures, APictureWithoutTextureAndAnchorDoesNotFlyAway) {
  BallPictures setup = wronglyPlaced();
  wipe(setup.pictures[4].intensity);
  const ColorAlignment alignment = align(setup);
  const double moved_px = movedBy(setup, 4, wrongPose(4));
  std::printf("a picture without texture, free: moved %.2f px\n", moved_px);
  // Where nothing can be told, no farther than poses are ever off.
  EXPECT_LT(moved_px, 5.0);
  expectValid(setup.pictures[4].place);
  expectNeverUp(alignment.rmse);
}

TEST(AlignPictures, AnUntexturedPictureDoesNotSpoilTheOthers) {
  BallPictures setup = wronglyPlaced();
  std::ranges::fill(setup.pictures[4].intensity.pixels(), 120.0F);
  align(setup);
  expectValid(setup.pictures[4].place);
  EXPECT_LT(greatest(relativeErrors(setup, 4), 4), 0.25);
}

TEST(AlignPictures, AnchorsHoldWhatColoursDoNot) {
  // All pictures off in the same way: they agree about the surface nearly as well as before, only
  // depth can tell. Shrinking the ring by 2 mm towards the surface is such a way.
  const auto nearer = [](int k) {
    RigidTransform pose = trueBallPose(k);
    pose.translation().z() -= 2.0;
    return pose;
  };
  BallPictures setup = wellPlacedBallPictures();
  for (int k = 0; k < kPictures; ++k) {
    setup.pictures[static_cast<std::size_t>(k)].place.color_from_scan = nearer(k);
    setup.pictures[static_cast<std::size_t>(k)].anchor = evenAnchor(trueBallPose(k));
  }
  align(setup, posesAlone());
  for (int k = 0; k < kPictures; ++k) {
    const AlignedPicture& picture = setup.pictures[static_cast<std::size_t>(k)];
    const MotionVector away = motionBetween(
        picture.place.color_from_scan, picture.anchor->color_from_scan, picture.anchor->center);
    // Twice what anchor_mm allows.
    EXPECT_LT(std::sqrt(away.dot(picture.anchor->stiffness * away)), 0.6) << k;
  }
}

/// A disc of one grey level in picture 1.
/// @return  share of its lines of sight that end on it
double addDisc(AlignedPicture& picture, const std::vector<Eigen::Vector3f>& vertices, float level) {
  const auto inside = [&](double u, double v) { return std::hypot(u - 175.0, v - 105.0) < 31.0; };
  Image<float>& image = picture.intensity;
  for (int v = 0; v < image.height(); ++v) {
    for (int u = 0; u < image.width(); ++u) {
      if (inside(u, v)) {
        image.at(u, v) = level;
      }
    }
  }
  double hidden = 0.0;
  for (const SightLine& line : picture.sight) {
    const Eigen::Vector2d place =
        pinhole().project(trueBallPose(1) * vertices[line.vertex].cast<double>());
    hidden += inside(place.x(), place.y()) ? 1.0 : 0.0;
  }
  return hidden / static_cast<double>(picture.sight.size());
}

/// Aligns with a disc in one picture; RMS error of that picture, and the greatest of the others.
std::pair<double, double> errorsWithDisc(float level, bool anchored) {
  BallPictures setup = wronglyPlaced();
  for (int k = 0; anchored && k < kPictures; ++k) {
    // As noisy depth would have it: 0.3 mm and 0.08 degrees off.
    setup.pictures[static_cast<std::size_t>(k)].anchor = evenAnchor(wrongPose(k, 0.15));
  }
  const double share = addDisc(setup.pictures[1], setup.vertices, level);
  EXPECT_GT(share, 0.13);
  EXPECT_LT(share, 0.17);
  const ColorAlignment alignment = align(setup, posesAlone());
  expectNeverUp(alignment.rmse);
  expectValid(setup.pictures[1].place);
  const std::vector<double> errors_px = relativeErrors(setup, 1);
  std::printf("a disc of %.0f levels on %.0f %%, %s: its picture %.3f px, others %.3f px\n",
              static_cast<double>(level),
              100.0 * share,
              anchored ? "anchored" : "free",
              errors_px[1],
              greatest(errors_px, 1));
  return {errors_px[1], greatest(errors_px, 1)};
}

TEST(AlignPictures, ColoursRefineWhatDepthGives) {
  BallPictures setup = wronglyPlaced();
  for (int k = 0; k < kPictures; ++k) {
    AlignedPicture& picture = setup.pictures[static_cast<std::size_t>(k)];
    picture.anchor = evenAnchor(wrongPose(k, 0.15));  // 0.3 mm and 0.08 degrees off
    picture.place.color_from_scan = picture.anchor->color_from_scan;
  }
  const double before_px = greatest(relativeErrors(setup));
  const ColorAlignment alignment = align(setup);
  const double after_px = greatest(relativeErrors(setup));
  std::printf("from anchors %.3f px apart to %.3f px\n", before_px, after_px);
  EXPECT_GT(before_px, 0.2);
  EXPECT_LT(after_px, 0.12);
  expectNeverUp(alignment.rmse);
}

TEST(AlignPictures, BearsAnOccluder) {
  const auto [own_px, others_px] = errorsWithDisc(160.0F, false);  // twice the texture's RMS off
  EXPECT_LT(own_px, 0.4);
  EXPECT_LT(others_px, 0.15);
}

TEST(AlignPictures, BearsAHighlightWhereDepthHoldsThePoses) {
  const auto [own_px, others_px] = errorsWithDisc(245.0F, true);
  EXPECT_LT(own_px, 0.4);
  EXPECT_LT(others_px, 0.3);
}

TEST(AlignPictures, BearsAHighlightWithoutDepth) {
  const auto [own_px, others_px] = errorsWithDisc(245.0F, false);
  EXPECT_LT(own_px, 1.0);
  EXPECT_LT(others_px, 0.3);
}

TEST(AlignPictures, MovesNothingWithoutSharedSight) {
  BallPictures none = wronglyPlaced();
  for (AlignedPicture& picture : none.pictures) {
    picture.sight.clear();
  }
  BallPictures one = wronglyPlaced();
  one.pictures.resize(1);
  BallPictures apart = wronglyPlaced();  // each vertex belongs to one picture alone
  for (std::size_t k = 0; k < apart.pictures.size(); ++k) {
    std::erase_if(apart.pictures[k].sight,
                  [k](const SightLine& line) { return line.vertex % kPictures != k; });
  }
  for (BallPictures* setup : {&none, &one, &apart}) {
    const ColorAlignment alignment = align(*setup);
    for (std::size_t k = 0; k < setup->pictures.size(); ++k) {
      expectValid(setup->pictures[k].place);
      EXPECT_LT((setup->pictures[k].place.color_from_scan.matrix() -
                 wrongPose(static_cast<int>(k)).matrix())
                    .norm(),
                1e-4)
          << k;
      for (const Eigen::Vector2f& offset : setup->pictures[k].place.warp.offsets_px()) {
        EXPECT_LT(offset.norm(), 1e-3F);
      }
    }
    for (const double rmse : alignment.rmse) {
      EXPECT_LT(rmse, 1e-3);
    }
  }
  BallPictures empty;
  EXPECT_EQ(align(empty).vertex_observations, 0U);
  EXPECT_EQ(align(none).vertex_observations, 0U);
}

TEST(AlignPictures, APictureWithoutSightStaysWhileOthersMove) {
  BallPictures setup = wronglyPlaced();
  setup.pictures[3].sight.clear();
  align(setup, posesAlone());
  EXPECT_TRUE(setup.pictures[3].place.color_from_scan.isApprox(wrongPose(3), 1e-12));
  EXPECT_LT(greatest(relativeErrors(setup), 3), 0.1);
}

TEST(AlignPictures, CountsItsWork) {
  BallPictures setup = wronglyPlaced();
  std::size_t lines = 0;
  for (const AlignedPicture& picture : setup.pictures) {
    lines += picture.sight.size();
  }
  std::vector<double> fractions;
  Job job;
  job.report = [&](auto, double fraction) { fractions.push_back(fraction); };
  const ColorAlignment alignment = align(setup, {}, job);
  EXPECT_EQ(alignment.vertex_observations, lines);
  EXPECT_GT(alignment.iterations(), 5);
  EXPECT_LE(alignment.iterations(), 80);
  EXPECT_GT(alignment.rmse.size(), 1U);
  EXPECT_TRUE(std::ranges::is_sorted(fractions));
  ASSERT_FALSE(fractions.empty());
  EXPECT_GE(fractions.front(), 0.0);
  EXPECT_LE(fractions.back(), 1.0);
}

TEST(AlignPictures, StopsWithValidPlacements) {
  BallPictures full = wronglyPlaced();
  const ColorAlignment whole = align(full);
  for (const int reports : {0, 2, 5}) {
    BallPictures setup = wronglyPlaced();
    std::stop_source stop;
    if (reports == 0) {
      stop.request_stop();
    }
    int heard = 0;
    const Job job{.stop = stop.get_token(), .report = [&](auto, auto) {
                    if (++heard == reports) {
                      stop.request_stop();
                    }
                  }};
    const ColorAlignment alignment = align(setup, {}, job);
    EXPECT_LE(alignment.iterations(), reports + 1);
    EXPECT_LT(alignment.iterations(), whole.iterations());
    for (std::size_t k = 0; k < setup.pictures.size(); ++k) {
      expectValid(setup.pictures[k].place);
    }
    expectNeverUp(alignment.rmse);
    // Never worse than they came.
    EXPECT_LT(greatest(relativeErrors(setup)), 1.1 * greatest(relativeErrors(wronglyPlaced())));
    if (reports == 0) {
      EXPECT_EQ(movedBy(setup, 0, wrongPose(0)) < 1e-3, true);
    }
  }
}

TEST(AlignPictures, GivesTheSameBitsOnAnyNumberOfThreads) {
  BallPictures a = wronglyPlaced();
  BallPictures b = wronglyPlaced();
  const ColorAlignment many = align(a);
  const ColorAlignment one = [&] {
    const ThreadLimit limit(1);
    return align(b);
  }();
  EXPECT_EQ(many.rmse, one.rmse);
  EXPECT_EQ(many.iterations(), one.iterations());
  for (std::size_t k = 0; k < a.pictures.size(); ++k) {
    const PicturePlacement& x = a.pictures[k].place;
    const PicturePlacement& y = b.pictures[k].place;
    EXPECT_EQ(x.color_from_scan.matrix(), y.color_from_scan.matrix());
    EXPECT_EQ(x.warp.offsets_px(), y.warp.offsets_px());
  }
}

}  // namespace
}  // namespace tarsus
