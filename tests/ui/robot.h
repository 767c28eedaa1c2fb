#pragma once

#include "tests/ui/ui_test.h"
#include "ui/parts/field_frame.h"

#include <QAbstractButton>
#include <QCheckBox>
#include <QLabel>
#include <QLineEdit>

namespace tarsus {

inline constexpr const char* kPassword = "a long password";

/// Works the window with the mouse and the keys only.
class Robot : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (window_) {
      window_->start();
    }
  }

  template <typename Condition>
  [[nodiscard]] static bool soon(Condition condition) {
    return QTest::qWaitFor(condition, kWait_ms);
  }
  void click(const char* name) {
    ASSERT_TRUE(soon([&] { return named<QAbstractButton>(name) != nullptr; })) << name;
    QTest::mouseClick(named<QAbstractButton>(name), Qt::LeftButton);
  }
  void type(const char* name, const QString& text) {
    ASSERT_TRUE(soon([&] { return named<QLineEdit>(name) != nullptr; })) << name;
    auto* field = named<QLineEdit>(name);
    QTest::mouseClick(field, Qt::LeftButton);
    field->selectAll();
    QTest::keyClicks(field, text);
  }
  [[nodiscard]] QString errorAt(const char* name) const {
    for (const FieldFrame* frame : window_->findChildren<FieldFrame*>()) {
      if (frame->field()->objectName() == QLatin1String(name)) {
        return frame->error();
      }
    }
    return {};
  }
  [[nodiscard]] Session::State state() const { return window_->session().state(); }

  void fillFirstRun(const QString& again) {
    type("name", QStringLiteral("Sofia Lindqvist"));
    type("clinic", QStringLiteral("Foot clinic, room 3"));
    type("new password", QLatin1String(kPassword));
    type("password again", again);
  }
  void leaveOutTheDemo() {
    ASSERT_TRUE(soon([&] { return named<QCheckBox>("demo") != nullptr; }));
    named<QCheckBox>("demo")->setChecked(false);
  }
  /// @return the recovery code, as shown
  QString keepTheCode() {
    EXPECT_TRUE(soon([&] { return named<QLabel>("recovery code") != nullptr; }));
    const QString code = named<QLabel>("recovery code")->text();
    const QStringList groups = code.simplified().split(QLatin1Char(' '));
    EXPECT_EQ(groups.size(), 7);
    type("code group", groups.value(3).toLower());
    click("kept");
    EXPECT_TRUE(soon([&] { return state() == Session::State::Open; }));
    return code;
  }
  void begin() {
    leaveOutTheDemo();
    fillFirstRun(QLatin1String(kPassword));
    click("create");
    keepTheCode();
  }
  void beginWithDemo() {
    fillFirstRun(QLatin1String(kPassword));
    click("create");
    keepTheCode();
  }
};

}  // namespace tarsus
