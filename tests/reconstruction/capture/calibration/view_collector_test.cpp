#include "reconstruction/capture/calibration/view_collector.h"

#include "tests/reconstruction/capture/calibration/board_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

using std::chrono::milliseconds;

/// Pictures of the board 450 mm away, this far from the middle and turned.
class ViewCollectorTest : public testing::Test {
 protected:
  static ColorImage at(double x_mm, double turn_rad = 0.0) {
    BoardScene scene = usualScene();
    scene.infrared = false;
    scene.depth = false;
    return captureOf(scene, {placeAt(scene, {x_mm, 0.0, 450.0}, 0.0, turn_rad)}, 1)
        .views.front()
        .color;
  }
  BoardLook look(const ColorImage& color, milliseconds later = milliseconds(200)) {
    time_ += later;
    return collector_.add(time_, color);
  }

  ViewCollector collector_{usualScene().board, usualScene().camera.color.width};
  milliseconds time_{0};
};

TEST_F(ViewCollectorTest, TakesABoardThatIsHeldStillOnce) {
  const ColorImage held = at(0.0);
  EXPECT_EQ(look(held), BoardLook::Moving);
  EXPECT_EQ(look(held, milliseconds(50)), BoardLook::Moving);  // too soon to tell
  EXPECT_EQ(look(held), BoardLook::Taken);
  EXPECT_EQ(look(held), BoardLook::Seen);
  EXPECT_EQ(collector_.taken(), 1);
}

TEST_F(ViewCollectorTest, WaitsWhileItMoves) {
  for (const double x_mm : {0.0, 3.0, 6.0, 9.0}) {  // 4 px from one to the next
    EXPECT_EQ(look(at(x_mm)), BoardLook::Moving) << x_mm;
  }
  EXPECT_EQ(look(at(9.0)), BoardLook::Taken);
}

TEST_F(ViewCollectorTest, TakesTheSamePlaceAgainWhereTheBoardIsTilted) {
  for (const ColorImage& held : {at(0.0), at(0.0, 0.5), at(40.0)}) {
    EXPECT_EQ(look(held), BoardLook::Moving);
    EXPECT_EQ(look(held), BoardLook::Taken);
  }
  const ColorImage near_first = at(5.0);
  EXPECT_EQ(look(near_first), BoardLook::Moving);
  EXPECT_EQ(look(near_first), BoardLook::Seen);
}

TEST_F(ViewCollectorTest, SaysNothingOfTheTimeBetweenTwoDistantLooks) {
  const ColorImage held = at(0.0);
  EXPECT_EQ(look(held), BoardLook::Moving);
  EXPECT_EQ(look(held, milliseconds(5000)), BoardLook::Moving);
  EXPECT_EQ(look(held), BoardLook::Taken);
}

TEST_F(ViewCollectorTest, FindsNoBoardWhereThereIsNone) {
  ColorImage half = at(0.0);
  std::ranges::fill(half.pixels().subspan(half.pixels().size() / 2), Rgb8{});
  for (const ColorImage& picture : {half, ColorImage(640, 480), ColorImage()}) {
    EXPECT_EQ(look(picture), BoardLook::NotFound);
  }
}

TEST_F(ViewCollectorTest, TakesAPlaceAnewWhereTheBoardMovedMeanwhile) {
  const ColorImage held = at(0.0);
  static_cast<void>(look(held));
  ASSERT_EQ(look(held), BoardLook::Taken);
  EXPECT_TRUE(collector_.stillAsTaken(held));
  EXPECT_FALSE(collector_.stillAsTaken(at(3.0)));
  EXPECT_FALSE(collector_.stillAsTaken(ColorImage()));
  collector_.forgetLast();
  EXPECT_EQ(collector_.taken(), 0);
  EXPECT_EQ(look(held), BoardLook::Taken);
}

}  // namespace
}  // namespace tarsus
