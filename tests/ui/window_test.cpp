#include "reconstruction/base/atomic_file.h"
#include "reconstruction/scene/ply.h"
#include "tests/ui/ui_test.h"
#include "ui/scene/model_view.h"
#include "ui/scene/view_overlay.h"
#include "ui/screens/model_screen.h"

#include <QApplication>
#include <QLabel>
#include <QMimeData>
#include <QPushButton>
#include <QSignalSpy>
#include <QTest>
#include <QUrl>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>

namespace tarsus {
namespace {

constexpr double kRadius_mm = 40.0;

/// A sphere, red towards the first camera (-z) and blue behind.
TexturedMesh sphere() {
  constexpr int kRings = 48;
  constexpr int kSegments = 96;
  TexturedMesh model;
  for (int ring = 0; ring <= kRings; ++ring) {
    for (int segment = 0; segment < kSegments; ++segment) {
      const double theta = std::numbers::pi * ring / kRings;
      const double phi = 2.0 * std::numbers::pi * segment / kSegments;
      const Eigen::Vector3d direction(
          std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
      model.mesh.vertices.push_back((kRadius_mm * direction).cast<float>());
      model.colors.push_back(direction.z() < 0.0 ? Rgb8{220, 30, 30} : Rgb8{30, 30, 220});
    }
  }
  for (int ring = 0; ring < kRings; ++ring) {
    for (int segment = 0; segment < kSegments; ++segment) {
      const int a = ring * kSegments + segment;
      const int b = ring * kSegments + (segment + 1) % kSegments;
      model.mesh.faces.emplace_back(a, a + kSegments, b + kSegments);
      model.mesh.faces.emplace_back(a, b + kSegments, b);
    }
  }
  model.mesh.normals = vertexNormals(model.mesh);
  model.comments = {"Tarsus 0.1.0", "fit_for_measurement no"};
  return model;
}

class Window : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (window_) {
      ASSERT_TRUE(writePly(good_, sphere()));
      screen_ = window_->modelScreen();
    }
  }

  void openAndWait(const std::filesystem::path& path) {
    QSignalSpy shown(screen_, &ModelScreen::modelShown);
    QSignalSpy refused(screen_, &ModelScreen::modelRefused);
    window_->openModel(QString::fromStdString(path.string()));
    EXPECT_TRUE(QTest::qWaitFor([&] { return shown.count() + refused.count() > 0; }, kWait_ms));
    QTest::qWait(50);
  }

  [[nodiscard]] QImage picture() const {
    QTest::qWait(50);
    return window_->findChild<ModelView*>()->grab().toImage();
  }
  [[nodiscard]] QColor middle() const {
    const QImage image = picture();
    return image.pixelColor(image.width() / 2, image.height() / 2);
  }
  std::filesystem::path good_ = folder_.path() / "model.ply";
  ModelScreen* screen_ = nullptr;
};

TEST_F(Window, RefusedFileSaysWhatToDo) {
  openAndWait(folder_.path() / "nothing.ply");
  EXPECT_TRUE(shows(QStringLiteral("No model open")));
  EXPECT_TRUE(shows(QStringLiteral("tarsus-cli reconstruct SCAN OUT")));
  EXPECT_TRUE(shows(QStringLiteral("Research software. Not a medical device.")));
  EXPECT_EQ(screen_->model(), nullptr);
}

TEST_F(Window, GoodFileIsShownWithItsFacts) {
  openAndWait(good_);
  ASSERT_NE(screen_->model(), nullptr);
  EXPECT_EQ(screen_->model()->mesh.faces.size(), sphere().mesh.faces.size());
  EXPECT_FALSE(shows(QStringLiteral("No model open")));
  EXPECT_TRUE(shows(QStringLiteral("Not fit for measurement")));
  EXPECT_TRUE(shows(QStringLiteral("Research software. Not a medical device.")));
  const auto* hash = window_->findChild<QLabel*>(QStringLiteral("hash"));
  ASSERT_NE(hash, nullptr);
  QString digits = hash->text();
  digits.remove(QLatin1Char(' ')).remove(QLatin1Char('\n'));
  EXPECT_EQ(digits.toStdString(), screen_->model()->sha256);
  const QColor seen = middle();
  EXPECT_GT(seen.red(), seen.blue() + 80);  // the side towards the first camera
}

TEST_F(Window, KeysTurnTheModelAndTakeItsColourAway) {
  openAndWait(good_);
  QTest::keyClick(window_.get(), Qt::Key_2);
  EXPECT_GT(middle().blue(), middle().red() + 80);
  QTest::keyClick(window_.get(), Qt::Key_T);
  EXPECT_LT(std::abs(middle().blue() - middle().red()), 40);
  QTest::keyClick(window_.get(), Qt::Key_1);
  QTest::keyClick(window_.get(), Qt::Key_T);
  EXPECT_GT(middle().red(), middle().blue() + 80);
}

/// A sphere's shadow without perspective is as wide as the sphere; a pixel of the edge on each side
/// is blended.
TEST_F(Window, ScaleBarIsTrue) {
  openAndWait(good_);
  const QImage image = picture();
  const int row = image.height() / 2;
  int width = 0;
  for (int u = 0; u < image.width(); ++u) {
    const QColor c = image.pixelColor(u, row);
    width += c.red() > c.blue() + 40 ? 1 : 0;
  }
  const auto* bar = window_->findChild<ScaleBar*>();
  const double px_per_mm = bar->lengthPx() / bar->lengthMm();
  EXPECT_NEAR(width / image.devicePixelRatio(), 2.0 * kRadius_mm * px_per_mm, 4.0);
}

TEST_F(Window, BadFileGetsASentenceAndLeavesTheStartPage) {
  const std::filesystem::path bad = folder_.path() / "bad.ply";
  ASSERT_TRUE(writeTextAtomically(bad, "this is no model"));
  openAndWait(bad);
  const Expected<TexturedMesh> read = readPly(bad);
  ASSERT_FALSE(read);
  EXPECT_EQ(screen_->problem().toStdString(), codeSentence(read.error().code));
  EXPECT_TRUE(shows(QStringLiteral("bad.ply was not opened")));
  EXPECT_TRUE(shows(QStringLiteral("No model open")));
}

TEST_F(Window, MissingFileKeepsTheModelThatIsShown) {
  openAndWait(good_);
  openAndWait(folder_.path() / "nothing.ply");
  EXPECT_EQ(screen_->problem().toStdString(), codeSentence(ErrorCode::FileMissing));
  EXPECT_NE(screen_->model(), nullptr);
  EXPECT_TRUE(shows(QStringLiteral("Not fit for measurement")));
  openAndWait(good_);
  EXPECT_TRUE(screen_->problem().isEmpty());
}

TEST_F(Window, DroppedFileIsOpened) {
  QMimeData data;
  data.setUrls({QUrl::fromLocalFile(QString::fromStdString(good_.string()))});
  QDragEnterEvent enter({100, 100}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(window_.get(), &enter);
  EXPECT_TRUE(enter.isAccepted());
  QSignalSpy shown(screen_, &ModelScreen::modelShown);
  QDropEvent drop({100, 100}, Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
  QCoreApplication::sendEvent(window_.get(), &drop);
  EXPECT_TRUE(QTest::qWaitFor([&] { return shown.count() > 0; }, kWait_ms));
}

}  // namespace
}  // namespace tarsus
