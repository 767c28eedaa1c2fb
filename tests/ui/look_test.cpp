#include "ui/look/theme.h"

#include <QRegularExpression>

#include <gtest/gtest.h>

namespace tarsus {
namespace {

QString noFile(const QString&, const QColor&) { return QStringLiteral("icon.svg"); }

class ThemeTest : public testing::TestWithParam<ThemeChoice> {};
INSTANTIATE_TEST_SUITE_P(All, ThemeTest, testing::ValuesIn(kThemeChoices));

/// WCAG 2.1, 1.4.3: text on each ground it is used on.
TEST_P(ThemeTest, TextCanBeReadOnItsGround) {
  constexpr double kText = 4.5;
  const Theme theme = Theme::of(GetParam());
  for (const QColor& ground : {theme.background, theme.surface, theme.sunk, theme.accent_weak}) {
    EXPECT_GE(contrast(theme.text, ground), kText) << ground.name().toStdString();
    EXPECT_GE(contrast(theme.text_secondary, ground), kText) << ground.name().toStdString();
  }
  EXPECT_GE(contrast(theme.on_accent, theme.accent), kText);
  EXPECT_GE(contrast(theme.on_accent, theme.accent_text), kText);  // the button under the mouse
  for (const QColor& ground : {theme.background, theme.surface, theme.accent_weak}) {
    EXPECT_GE(contrast(theme.accent_text, ground), kText) << ground.name().toStdString();
  }
  EXPECT_GE(contrast(theme.warning_text, theme.warning_weak), kText);
  EXPECT_GE(contrast(theme.text, theme.warning_weak), kText);
  for (const QColor& ground : {theme.background, theme.surface, theme.danger_weak}) {
    EXPECT_GE(contrast(theme.danger_text, ground), kText) << ground.name().toStdString();
  }
  EXPECT_GE(contrast(theme.surface, theme.text), kText);  // tooltips
}

/// WCAG 2.1, 1.4.11: what is needed to make out a control or a mark.
TEST_P(ThemeTest, EdgesAndMarksCanBeSeen) {
  constexpr double kEdge = 3.0;
  const Theme theme = Theme::of(GetParam());
  for (const QColor& ground : {theme.background, theme.surface, theme.sunk}) {
    EXPECT_GE(contrast(theme.control_edge, ground), kEdge) << ground.name().toStdString();
    EXPECT_GE(contrast(theme.accent, ground), kEdge) << ground.name().toStdString();
    EXPECT_GE(contrast(theme.danger, ground), kEdge) << ground.name().toStdString();
  }
  EXPECT_GE(contrast(theme.warning, theme.surface), kEdge);
}

/// The numbers of the design, so that a token is not changed by a slip; to one of its last digit.
TEST(Theme, ContrastsAreThoseOfTheDesign) {
  constexpr double kLastDigit = 0.1;
  const Theme light = Theme::light();
  EXPECT_NEAR(contrast(light.text, light.background), 14.6, kLastDigit);
  EXPECT_NEAR(contrast(light.text_secondary, light.surface), 5.8, kLastDigit);
  EXPECT_NEAR(contrast(light.on_accent, light.accent), 5.2, kLastDigit);
  EXPECT_NEAR(contrast(light.control_edge, light.surface), 3.5, kLastDigit);
  const Theme dark = Theme::dark();
  EXPECT_NEAR(contrast(dark.text, dark.background), 15.1, kLastDigit);
  EXPECT_NEAR(contrast(dark.warning_text, dark.warning_weak), 8.2, kLastDigit);
  const Theme high = Theme::highContrast();
  EXPECT_NEAR(contrast(high.text, high.background), 21.0, 1e-6);
  EXPECT_NEAR(contrast(high.danger_text, high.danger_weak), 11.3, kLastDigit);
}

TEST_P(ThemeTest, StyleSheetIsFilledAtEachScale) {
  static const QRegularExpression left_over(QStringLiteral("@|\\dsp\\b"));
  const Theme theme = Theme::of(GetParam());
  for (const int percent : {100, 130, 200}) {
    const QString sheet = styleSheet(theme, percent, &noFile);
    EXPECT_FALSE(sheet.contains(left_over));
    EXPECT_FALSE(sheet.contains(QLatin1String("font-size")));
  }
  EXPECT_TRUE(styleSheet(theme, 200, &noFile).contains(QLatin1String("min-height: 76px")));
}

}  // namespace
}  // namespace tarsus
