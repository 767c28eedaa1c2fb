#include "reconstruction/pipeline/contact_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace tarsus {
namespace {

Keyframe plain(std::uint8_t level) {
  Keyframe keyframe;
  keyframe.frame.color = ColorImage(640, 480);
  std::ranges::fill(keyframe.frame.color.pixels(), Rgb8{level, 10, 20});
  return keyframe;
}

TEST(ContactSheet, ShowsAllInTheirOrderRowByRow) {
  std::vector<Keyframe> keyframes;
  for (int i = 0; i < 8; ++i) {
    keyframes.push_back(plain(static_cast<std::uint8_t>(30 * i)));
  }
  const ColorImage sheet = contactSheet(keyframes);
  ASSERT_EQ(sheet.width(), 6 * 246 + 6);
  ASSERT_EQ(sheet.height(), 2 * 186 + 6);
  for (int i = 0; i < 12; ++i) {
    const Rgb8 middle = sheet.at(126 + i % 6 * 246, 96 + i / 6 * 186);
    EXPECT_EQ(middle.r, i < 8 ? 30 * i : 255) << i;
  }
  EXPECT_EQ(sheet.at(3, 3).g, 255);
}

TEST(ContactSheet, AveragesWhatAPixelCovers) {
  Keyframe stripes = plain(0);
  for (int v = 0; v < 480; ++v) {
    for (int u = 0; u < 640; u += 2) {
      stripes.frame.color.at(u, v).r = 200;
    }
  }
  const std::vector<Keyframe> one{stripes};
  const ColorImage sheet = contactSheet(one, {.picture_width_px = 320});
  ASSERT_EQ(sheet.width(), 332);
  EXPECT_EQ(sheet.at(150, 120).r, 100);
}

TEST(ContactSheet, OfNothingIsEmpty) {
  EXPECT_EQ(contactSheet({}).width(), 0);
  const std::vector<Keyframe> without_color(1);
  EXPECT_EQ(contactSheet(without_color).width(), 0);
  const std::vector<Keyframe> single{plain(50)};  // a picture smaller than wanted is not enlarged
  EXPECT_EQ(contactSheet(single, {.picture_width_px = 2000}).width(), 652);
}

}  // namespace
}  // namespace tarsus
