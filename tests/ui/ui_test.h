#pragma once

#include "tests/support/temporary_folder.h"
#include "ui/look/look.h"
#include "ui/main_window.h"
#include "ui/scene/model_view.h"

#include <QApplication>
#include <QTest>

#include <gtest/gtest.h>

#include <memory>

namespace tarsus {

inline constexpr int kWait_ms = 20000;  // software rendering on a busy machine

/// Tries a password at almost no cost.
inline constexpr KeyCost kCheapKey{.operations = 1, .memory_bytes = 8192};

/// The application of a test program; without a display there is none and the tests are skipped.
class Application : public testing::Environment {
 public:
  void SetUp() override {
    if (qEnvironmentVariableIsEmpty("DISPLAY")) {
      return;
    }
    prepareGraphics();
    application_ = std::make_unique<QApplication>(count_, arguments_);
    Look::instance().set(ThemeChoice::Light, 100);
  }
  void TearDown() override { application_.reset(); }

 private:
  int count_ = 1;
  char name_[5] = "test";
  char* arguments_[2] = {name_, nullptr};
  std::unique_ptr<QApplication> application_;
};

/// A window on records of its own.
class WindowTest : public testing::Test {
 protected:
  void SetUp() override {
    if (qApp == nullptr) {
      GTEST_SKIP() << "no display; run with: xvfb-run -a -s \"-screen 0 1440x900x24\" ctest";
    }
    makeWindow();
  }

  virtual void makeWindow() {
    window_ = std::make_unique<MainWindow>(
        SessionOptions{.folder = folder_.path() / "records", .now_ms = {}, .key_cost = kCheapKey});
    window_->show();
    ASSERT_TRUE(QTest::qWaitForWindowExposed(window_.get()));
    QApplication::setActiveWindow(window_.get());  // no window manager in a virtual screen
  }

  /// A visible widget by its name, or nothing.
  template <typename Widget>
  [[nodiscard]] Widget* named(const char* name) const {
    for (Widget* widget : window_->findChildren<Widget*>(QLatin1String(name))) {
      if (widget->isVisible()) {
        return widget;
      }
    }
    return nullptr;
  }
  [[nodiscard]] bool shows(const QString& words) const;

  TemporaryFolder folder_;
  std::unique_ptr<MainWindow> window_;
};

}  // namespace tarsus
