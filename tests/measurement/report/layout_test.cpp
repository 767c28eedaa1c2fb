#include "tests/measurement/report/printed_page.h"
#include "tests/measurement/report/sample_wound.h"
#include "tests/support/temporary_folder.h"

#include <Eigen/Geometry>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

constexpr int kDpi = 600;
constexpr double kMmPerDot = 25.4 / kDpi;
constexpr double kPrintTolerance_mm = 0.2;  ///< what the print design asks for

bool overlap(const ReportFrame& a, const ReportFrame& b) {
  constexpr double kTouch_mm = 0.02;
  return a.page == b.page && a.x_mm + a.width_mm > b.x_mm + kTouch_mm &&
         b.x_mm + b.width_mm > a.x_mm + kTouch_mm && a.y_mm + a.height_mm > b.y_mm + kTouch_mm &&
         b.y_mm + b.height_mm > a.y_mm + kTouch_mm;
}

void expectTidy(const ReportContent& content) {
  const auto frames = layoutReport(content);
  ASSERT_TRUE(frames) << describe(frames.error());
  ASSERT_GT(frames->size(), 20U);
  for (std::size_t i = 0; i < frames->size(); ++i) {
    const ReportFrame& a = (*frames)[i];
    EXPECT_GE(a.x_mm, 18.0 - 1e-6) << a.name;
    EXPECT_LE(a.x_mm + a.width_mm, 196.0 + 1e-6) << a.name;
    EXPECT_GE(a.y_mm, 11.0 - 1e-6) << a.name;
    EXPECT_LE(a.y_mm + a.height_mm, a.name == "foot" ? 289.5 : 276.5) << a.name;
    for (std::size_t j = i + 1; j < frames->size(); ++j) {
      EXPECT_FALSE(overlap(a, (*frames)[j])) << a.name << " and " << (*frames)[j].name;
    }
  }
}

/// Page 1 keeps a reserve for languages that run longer.
TEST(ReportLayout, PageOneLeaves18MmFree) {
  const auto frames = layoutReport(sample::makeContent());
  ASSERT_TRUE(frames);
  double lowest = 0.0;
  for (const ReportFrame& frame : *frames) {
    if (frame.page == 1 && frame.name != "foot") {
      lowest = std::max(lowest, frame.y_mm + frame.height_mm);
    }
  }
  EXPECT_GT(lowest, 150.0);
  EXPECT_LT(lowest, 277.8 - 18.0);
}

TEST(ReportLayout, FramesDoNotOverlap) { expectTidy(sample::makeContent()); }

TEST(ReportLayout, FramesDoNotOverlapWhenNothingCouldBeMeasured) {
  ReportContent content = sample::makeContent();
  const std::string method = content.measurement.method;
  content.measurement = {};
  content.measurement.method = method;
  content.texture = {};
  content.depth_map = {};
  content.foot = {};
  content.section.reset();
  content.deepest_px.reset();
  content.depth_scale_end_mm = 0.0;
  expectTidy(content);
}

TEST(ReportLayout, FramesDoNotOverlapWithTheLongestTexts) {
  ReportContent content = sample::makeContent();
  content.title_line =
      "A patient with a very long name indeed, born on the thirtieth of September · identification "
      "0000-0000-0000-0000-SAMPLE · right foot, plantar, between the second and the third "
      "metatarsal head · visit 12 · /a/path/without/any/space/that/is/much/longer/than/the/line/"
      "it/has/to/stand/on/0123456789012345678901234567890123456789.ply";
  const std::string reason =
      "28 % of the bed was not seen because its walls are steep and the camera did not look into "
      "it from two sides (limit 10 %)";
  for (const char* key : {"opening_area_mm2", "volume_mm3", "max_depth_mm", "length_mm"}) {
    content.measurement.not_measurable[key] = reason;
  }
  content.fit_for_measurement = false;
  content.refusal_reasons = {reason, reason};
  content.quality.emplace_back("A name of a quality that wraps in its column",
                               "a value of that quality that wraps as well, over several lines");
  expectTidy(content);
}

struct DarkRun {
  int first = 0;
  int last = 0;
};

bool isDark(const Rgb8& p) { return p.r + p.g + p.b < 300; }

/// The longest dark run in the row, between two columns.
DarkRun longestDarkRun(const ColorImage& page, int row, int from, int to) {
  DarkRun best;
  for (int u = from; u < to; ++u) {
    if (!isDark(page.at(u, row))) {
      continue;
    }
    DarkRun run{u, u};
    while (run.last + 1 < to && isDark(page.at(run.last + 1, row))) {
      ++run.last;
    }
    if (run.last - run.first > best.last - best.first) {
      best = run;
    }
    u = run.last;
  }
  return best;
}

const ReportFrame& frameNamed(const std::vector<ReportFrame>& frames, const std::string& name) {
  const auto found = std::find_if(
      frames.begin(), frames.end(), [&](const ReportFrame& frame) { return frame.name == name; });
  EXPECT_NE(found, frames.end()) << name;
  return *found;
}

int toDots(double mm) { return static_cast<int>(std::lround(mm / kMmPerDot)); }

/// Page 1 as it prints, rendered once.
class PrintedScale : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TemporaryFolder folder;
    const ReportContent content = sample::makeContent();
    ASSERT_TRUE(writeReport(folder.path() / "report.pdf", content));
    page_ = renderedPage(folder.path() / "report.pdf", 1, kDpi);
    const auto frames = layoutReport(content);
    ASSERT_TRUE(frames);
    texture_ = frameNamed(*frames, "texture");
    scale_ = texture_.width_mm / (content.texture.width() * content.close_mm_per_px);
  }

  inline static ColorImage page_;
  inline static ReportFrame texture_;
  inline static double scale_ = 0.0;
};

/// The bar's upper edge is one dark line of its whole length, on a white plate.
TEST_F(PrintedScale, BarOfOneCentimetreIsTrue) {
  int longest = 0;
  const int left = toDots(texture_.x_mm + 1.0);
  const int right = toDots(texture_.x_mm + 0.5 * texture_.width_mm);
  for (int row = toDots(texture_.y_mm + texture_.height_mm - 4.0);
       row < toDots(texture_.y_mm + texture_.height_mm - 1.0);
       ++row) {
    const DarkRun run = longestDarkRun(page_, row, left, right);
    longest = std::max(longest, run.last - run.first + 1);
  }
  EXPECT_NEAR(longest * kMmPerDot, 10.0 * scale_, kPrintTolerance_mm);
}

bool isOutlineCyan(const Rgb8& p) {
  return std::abs(p.r - 0x00) < 40 && std::abs(p.g - 0xB8) < 40 && std::abs(p.b - 0xD9) < 40;
}

/// To the right in a view along the reference skin's mean normal with the toes up.
Eigen::Vector3d acrossThePicture(const sample::Case& one) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const TriangleMesh& skin = one.wound.reference;
  for (const Eigen::Vector3i& face : skin.faces) {
    const Eigen::Vector3f a = skin.vertices[static_cast<std::size_t>(face[0])];
    const Eigen::Vector3f b = skin.vertices[static_cast<std::size_t>(face[1])];
    const Eigen::Vector3f c = skin.vertices[static_cast<std::size_t>(face[2])];
    normal += (b - a).cross(c - a).cast<double>();
  }
  return (one.landmarks.toe_mm - one.landmarks.heel_mm).cross(normal).normalized();
}

/// The cyan line's extent on paper is the outline's on the skin, times the scale, plus its width.
TEST_F(PrintedScale, OutlineHasItsTrueExtent) {
  constexpr double kLineWidth_mm = 0.5;
  int first = page_.width();
  int last = 0;
  for (int v = toDots(texture_.y_mm); v < toDots(texture_.y_mm + texture_.height_mm); ++v) {
    for (int u = toDots(texture_.x_mm); u < toDots(texture_.x_mm + texture_.width_mm); ++u) {
      if (isOutlineCyan(page_.at(u, v))) {
        first = std::min(first, u);
        last = std::max(last, u);
      }
    }
  }
  const sample::Case& one = sample::makeCase();
  const Eigen::Vector3d across = acrossThePicture(one);
  double least = 1e9;
  double most = -1e9;
  for (const Eigen::Vector3d& p : one.wound.outline_mm) {
    least = std::min(least, p.dot(across));
    most = std::max(most, p.dot(across));
  }
  EXPECT_NEAR(
      (last - first + 1) * kMmPerDot, (most - least) * scale_ + kLineWidth_mm, kPrintTolerance_mm);
}

}  // namespace
}  // namespace tarsus
