// A robot user's visit: scan from a file or a camera, the model, the form.

#include "reconstruction/capture/openni/openni_library.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "tests/ui/robot.h"
#include "ui/parts/scan_dialog.h"
#include "ui/screens/form_field.h"
#include "ui/screens/patient_list_model.h"
#include "ui/screens/patient_screen.h"
#include "ui/screens/patients_screen.h"
#include "ui/screens/scan_page.h"
#include "ui/screens/visit_screen.h"
#include "ui/work/visit_work.h"

#include <QDropEvent>
#include <QMimeData>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalSpy>
#include <QToolButton>
#include <QUrl>

namespace tarsus {
namespace {

constexpr int kBuild_ms = 240000;  // a small model on a busy machine

/// A window with the demo patient and a foot's scan of a few frames.
class VisitTest : public Robot {
 protected:
  static void SetUpTestSuite() {
    if (qApp == nullptr) {
      return;
    }
    data_ = std::make_unique<TemporaryFolder>();
    SimulatorOptions options;
    options.foot = FootCase::Heel;
    options.frames = 120;
    const auto written = simulateScan(scan(), options, {});
    ASSERT_TRUE(written) << describe(written.error());
  }
  static void TearDownTestSuite() { data_.reset(); }
  static std::filesystem::path scan() { return data_->path() / "foot"; }

  [[nodiscard]] VisitScreen* visit() const { return window_->visitScreen(); }
  [[nodiscard]] VisitWork& work() const { return visit()->work(); }
  [[nodiscard]] bool at(int step) const {
    return window_->currentScreen() == static_cast<Screen*>(visit()) && visit()->step() == step &&
           work().isOpen();
  }
  void showDemoPatient() {
    PatientListModel* model = window_->patientsScreen()->model();
    ASSERT_TRUE(soon([&] { return model->rowCount() == 1; }));
    QSignalSpy loaded(window_->patientScreen(), &PatientScreen::loaded);
    window_->showPatient(model->index(0).data(PatientListModel::IdRole).toString());
    ASSERT_TRUE(soon([&] { return loaded.count() > 0; }));
  }
  void startVisit() {
    beginWithDemo();
    showDemoPatient();
    click("start visit");
    ASSERT_TRUE(soon([&] { return at(VisitScreen::Scan); }));
  }
  void drop(const std::filesystem::path& path) {
    QMimeData data;
    data.setUrls({QUrl::fromLocalFile(QString::fromStdString(path.string()))});
    QDragEnterEvent enter(QPoint(400, 400), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(window_.get(), &enter);
    EXPECT_TRUE(enter.isAccepted());
    QDropEvent event(QPointF(400, 400), Qt::CopyAction, &data, Qt::LeftButton, Qt::NoModifier);
    QApplication::sendEvent(window_.get(), &event);
  }
  /// Brings a control into sight as a person would by the wheel.
  void reveal(QWidget* control) {
    for (QScrollArea* area : window_->findChildren<QScrollArea*>()) {
      if (area->isVisible() && area->isAncestorOf(control)) {
        area->ensureWidgetVisible(control, 0, 80);
      }
    }
  }
  void choose(const char* field, int index) {
    auto* row = named<QWidget>(field);
    ASSERT_NE(row, nullptr) << field;
    reveal(row);
    QTest::mouseClick(row->findChildren<QToolButton*>().at(index), Qt::LeftButton);
  }
  void typeNumber(const char* field, const char* text) {
    ASSERT_NE(named<QLineEdit>(field), nullptr) << field;
    reveal(named<QLineEdit>(field));
    type(field, QLatin1String(text));
    QTest::keyClick(named<QLineEdit>(field), Qt::Key_Tab);
  }
  [[nodiscard]] QString errorIn(const char* name) const {
    for (const FormField* field : window_->findChildren<FormField*>()) {
      if (field->name() == QLatin1String(name)) {
        return field->error();
      }
    }
    return {};
  }
  /// As the records have it.
  [[nodiscard]] nlohmann::json stored() {
    nlohmann::json fields;
    bool read = false;
    window_->session().ask<Visit>(
        Session::Kind::Read,
        window_.get(),
        [id = work().facts().visit.id](Store& store) { return findVisit(store, id); },
        [&](const Expected<Visit>& visit) {
          read = true;
          fields = visit ? visit->content.fields : nlohmann::json();
        });
    EXPECT_TRUE(soon([&] { return read; }));
    return fields;
  }
  [[nodiscard]] bool storedIs(const char* name, const nlohmann::json& value) {
    return soon([&] {
      const auto fields = stored();
      return fields.contains(name) && fields[name] == value;
    });
  }
  [[nodiscard]] QString dialog() const {
    return named<ScanDialog>("scan dialog") != nullptr ? named<ScanDialog>("scan dialog")->shown()
                                                       : QString();
  }

 private:
  static inline std::unique_ptr<TemporaryFolder> data_;
};

TEST_F(VisitTest, AScanFromAFileBecomesAModelWhileTheFormIsFilled) {
  startVisit();
  drop(scan());
  EXPECT_TRUE(soon([&] { return at(VisitScreen::Form); }));
  EXPECT_EQ(work().build().state(), ScanBuild::State::Running);

  choose("exudate_amount", 1);
  EXPECT_TRUE(storedIs("exudate_amount", "light"));
  QTest::keyClick(QApplication::focusWidget(), Qt::Key_3);  // by its number
  EXPECT_TRUE(storedIs("exudate_amount", "moderate"));
  typeNumber("toe_pressure_mmhg", "999");
  EXPECT_FALSE(errorIn("toe_pressure_mmhg").isEmpty());
  typeNumber("toe_pressure_mmhg", "55");
  EXPECT_TRUE(errorIn("toe_pressure_mmhg").isEmpty());
  EXPECT_TRUE(storedIs("toe_pressure_mmhg", 55.0));
  EXPECT_FALSE(stored().contains("pain_of_10"));  // what is not known is left out

  ASSERT_TRUE(QTest::qWaitFor([&] { return work().build().state() != ScanBuild::State::Running; },
                              kBuild_ms));
  ASSERT_EQ(work().build().state(), ScanBuild::State::Ready) << describe(work().build().problem());
  EXPECT_GT(work().build().built().quality.frames_used, 60);
  ASSERT_NE(work().model(), nullptr);
  const std::string hash = work().model()->sha256;

  const std::string id = work().facts().visit.id;
  choose("exudate_odour", 2);
  window_->close();  // at once: nothing typed is lost
  window_.reset();
  makeWindow();
  window_->start();
  ASSERT_TRUE(soon([&] { return state() == Session::State::Locked; }));
  type("password", QLatin1String(kPassword));
  QTest::keyClick(named<QLineEdit>("password"), Qt::Key_Return);
  ASSERT_TRUE(soon([&] { return state() == Session::State::Open; }));
  showDemoPatient();
  click("continue");
  ASSERT_TRUE(soon([&] { return at(VisitScreen::Form); }));
  EXPECT_EQ(work().facts().visit.id, id);
  EXPECT_EQ(work().fields().value("exudate_odour", ""), "strong");
  EXPECT_TRUE(soon([&] { return work().build().state() == ScanBuild::State::Ready; }));
  EXPECT_EQ(work().model()->sha256, hash);  // found again, not built anew
  QTest::keyClick(window_.get(), Qt::Key_1, Qt::AltModifier);
  EXPECT_TRUE(at(VisitScreen::Scan));
}

TEST_F(VisitTest, AValueOfAnEarlierVisitIsTakenByATouchAndFindingsAreNot) {
  startVisit();
  click("no scan");
  ASSERT_TRUE(soon([&] { return at(VisitScreen::Form); }));
  EXPECT_FALSE(work().fields().contains("offloading"));  // never filled in by itself
  auto* keep = named<QPushButton>("offloading earlier");
  ASSERT_NE(keep, nullptr);
  reveal(keep);
  QTest::mouseClick(keep, Qt::LeftButton);
  EXPECT_TRUE(storedIs("offloading", "Removable walker"));
  ASSERT_NE(named<QPushButton>("probe_to_bone earlier"), nullptr);
  EXPECT_FALSE(named<QPushButton>("probe_to_bone earlier")->isEnabled());

  typeNumber("ruler_length_mm", "23");
  EXPECT_TRUE(storedIs("ruler_length_mm", 23.0));
  EXPECT_TRUE(soon([&] { return !work().facts().visit.content.usable_scan; }));
}

TEST_F(VisitTest, WhatAnotherStationWroteIsKeptToo) {
  startVisit();
  click("no scan");
  ASSERT_TRUE(soon([&] { return at(VisitScreen::Form); }));
  bool written = false;
  window_->session().ask<Visit>(
      Session::Kind::Write,
      window_.get(),
      [visit = work().facts().visit](Store& store) {
        VisitContent content = visit.content;
        content.fields["dressing"] = "Foam";
        return editVisit(store, visit.id, visit.revision, content);
      },
      [&](const Expected<Visit>& visit) { written = visit.has_value(); });
  ASSERT_TRUE(soon([&] { return written; }));
  QSignalSpy merged(&work(), &VisitWork::merged);
  choose("edge", 0);
  EXPECT_TRUE(soon([&] { return merged.count() == 1; }));
  EXPECT_EQ(stored().value("dressing", ""), "Foam");
  EXPECT_EQ(stored().value("edge", ""), "flat");
  EXPECT_EQ(named<QLineEdit>("dressing")->text(), QStringLiteral("Foam"));
}

TEST_F(VisitTest, AnUnpluggedCameraComesBackAndTheScanGoesOn) {
  startVisit();
  visit()->scanPage()->useCamera(simulatedUri(scan().string(), "unplug,6,9"));
  const auto& moment = visit()->scanPage()->moment();
  ASSERT_TRUE(soon([&] { return moment.camera == ScanMoment::Camera::Live; }));
  visit()->scanPage()->setFocus();
  QTest::keyClick(visit()->scanPage(), Qt::Key_Space);
  EXPECT_TRUE(soon([&] { return moment.recording && moment.frames > 5; }));
  EXPECT_TRUE(soon([&] { return moment.camera == ScanMoment::Camera::Gone; }));
  EXPECT_EQ(dialog(), QStringLiteral("gone"));
  EXPECT_TRUE(shows(QStringLiteral("The camera was unplugged")));
  const int before = moment.frames;
  EXPECT_TRUE(soon([&] { return moment.frames > before + 5; }));
  EXPECT_EQ(dialog(), QString());
  EXPECT_TRUE(moment.recording);
  QTest::keyClick(visit()->scanPage(), Qt::Key_Space);
  EXPECT_TRUE(soon([&] { return at(VisitScreen::Form); }));
  EXPECT_TRUE(work().hasScan());
  EXPECT_NE(work().build().state(), ScanBuild::State::None);
  click("cancel build");
  EXPECT_TRUE(shows(QStringLiteral("Stop building? The scan is kept.")));
  click("stop building");
  EXPECT_EQ(work().build().state(), ScanBuild::State::Cancelled);
  EXPECT_FALSE(scanIn(work().folder()).empty());
}

}  // namespace
}  // namespace tarsus
