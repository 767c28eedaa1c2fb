// A robot user's first day, with the mouse and the keys only.

#include "measurement/records/patients.h"
#include "tests/ui/robot.h"
#include "ui/parts/foot_map.h"
#include "ui/screens/patient_list_model.h"
#include "ui/screens/patient_screen.h"
#include "ui/screens/patients_screen.h"

#include <QListView>
#include <QSignalSpy>

namespace tarsus {
namespace {

class FirstDay : public Robot {
 protected:
  void addPatientByHand() {
    QTest::keyClick(window_.get(), Qt::Key_N, Qt::ControlModifier);
    type("given name", QStringLiteral("Margarete"));
    type("family name", QStringLiteral("Holm"));
    type("birth date", QStringLiteral("14.3.1958"));
    type("number", QStringLiteral("40-2817"));
    QSignalSpy loaded(window_->patientScreen(), &PatientScreen::loaded);
    click("add");
    EXPECT_TRUE(soon([&] { return loaded.count() > 0; }));
  }
};

TEST_F(FirstDay, FromTheFirstStartToAWoundOnTheMapAndBackAfterLocking) {
  leaveOutTheDemo();
  fillFirstRun(QStringLiteral("another one"));
  click("create");
  EXPECT_EQ(errorAt("password again"), QStringLiteral("The two passwords differ."));
  EXPECT_EQ(state(), Session::State::New);
  type("password again", QLatin1String(kPassword));
  click("create");
  keepTheCode();
  EXPECT_TRUE(soon([&] { return shows(QStringLiteral("No patients yet")); }));

  addPatientByHand();
  EXPECT_TRUE(shows(QStringLiteral("Margarete Holm")));
  EXPECT_TRUE(shows(QStringLiteral("No wound placed")));

  FootMap* map = window_->patientScreen()->map();
  QTest::mouseClick(
      map, Qt::LeftButton, {}, map->pointOf(FootSide::Right, QStringLiteral("mth_2")).toPoint());
  QSignalSpy loaded(window_->patientScreen(), &PatientScreen::loaded);
  click("add wound");
  ASSERT_TRUE(soon([&] { return loaded.count() > 0; }));
  ASSERT_EQ(window_->patientScreen()->summary().wounds.size(), 1U);
  EXPECT_EQ(window_->patientScreen()->summary().wounds.front().fields.place, "mth_2");
  EXPECT_EQ(window_->patientScreen()->summary().wounds.front().side, FootSide::Right);
  EXPECT_TRUE(shows(QStringLiteral("Wound 1: right foot, sole, 2nd metatarsal head")));

  QTest::keyClick(window_.get(), Qt::Key_Left, Qt::AltModifier);
  type("search", QStringLiteral("hol 40-28"));
  PatientListModel* model = window_->patientsScreen()->model();
  EXPECT_TRUE(soon([&] { return model->rowCount() == 1; }));
  type("search", QStringLiteral("holn"));
  EXPECT_TRUE(soon([&] { return shows(QStringLiteral("No one matches")); }));
  type("search", QStringLiteral("holm"));
  EXPECT_TRUE(soon([&] { return model->rowCount() == 1; }));
  QTest::keyClick(named<QLineEdit>("search"), Qt::Key_Return);
  EXPECT_EQ(window_->currentScreen(), static_cast<Screen*>(window_->patientScreen()));

  QTest::keyClick(window_.get(), Qt::Key_L, Qt::ControlModifier);
  EXPECT_TRUE(soon([&] { return state() == Session::State::Locked; }));
  EXPECT_FALSE(shows(QStringLiteral("Margarete Holm")));
  type("password", QStringLiteral("wrong"));
  click("sign in");
  EXPECT_TRUE(soon([&] { return !errorAt("password").isEmpty(); }));
  EXPECT_TRUE(errorAt("password").startsWith(QStringLiteral("Wrong password. 2")));
  type("password", QLatin1String(kPassword));
  QTest::keyClick(named<QLineEdit>("password"), Qt::Key_Return);
  EXPECT_TRUE(soon([&] { return state() == Session::State::Open; }));
  EXPECT_EQ(window_->currentScreen(), static_cast<Screen*>(window_->patientScreen()));
}

TEST_F(FirstDay, ImpossibleDatesAreRefusedAtTheField) {
  begin();
  QTest::keyClick(window_.get(), Qt::Key_N, Qt::ControlModifier);
  type("family name", QStringLiteral("Holm"));
  for (const auto& [typed, error] :
       {std::pair("31.2.1958", "There is no such date."),
        std::pair("1.1.2999", "This date is still to come."),
        std::pair("1.1.1850", "More than 120 years ago, please check.")}) {
    type("birth date", QLatin1String(typed));
    click("add");
    EXPECT_EQ(errorAt("birth date"), QLatin1String(error)) << typed;
  }
}

TEST_F(FirstDay, TooManyWrongPasswordsHaveToWait) {
  begin();
  window_->session().lock();
  for (int i = 0; i < 4; ++i) {
    type("password", QStringLiteral("wrong"));
    click("sign in");
    EXPECT_TRUE(soon([&] { return !errorAt("password").isEmpty(); }));
  }
  EXPECT_TRUE(errorAt("password").startsWith(QStringLiteral("Too many tries.")));
}

TEST_F(FirstDay, TheRecoveryCodeMakesANewPassword) {
  leaveOutTheDemo();
  fillFirstRun(QLatin1String(kPassword));
  click("create");
  const QString code = keepTheCode();
  window_->session().lock();
  click("forgot");
  type("typed recovery code", code.simplified());
  for (QLineEdit* field : window_->findChildren<QLineEdit*>()) {
    if (field->isVisible() && field->echoMode() == QLineEdit::Password) {
      QTest::keyClicks(field, QStringLiteral("another password"));
    }
  }
  QTest::keyClick(window_.get(), Qt::Key_Return, Qt::ControlModifier);
  EXPECT_TRUE(soon([&] { return state() == Session::State::Open; }));
}

TEST_F(FirstDay, TheDemoPatientIsListedWithItsDraft) {
  fillFirstRun(QLatin1String(kPassword));
  click("create");
  keepTheCode();
  PatientListModel* model = window_->patientsScreen()->model();
  EXPECT_TRUE(soon([&] { return model->rowCount() == 1; }));
  EXPECT_EQ(model->countOf(PatientFilter::Drafts), 1);
  EXPECT_TRUE(soon([&] { return model->index(0).data(PatientListModel::RowRole).isValid(); }));
  const auto row = model->index(0).data(PatientListModel::RowRole).value<PatientRow>();
  EXPECT_EQ(row.areas_mm2.size(), 5U);
  EXPECT_NEAR(row.area_mm2.value_or(0.0), 363.0, 1e-9);
  EXPECT_EQ(row.state, VisitState::Draft);
}

/// The rows behind a search are read only when they are seen.
TEST_F(FirstDay, OnlyWhatIsShownIsRead) {
  begin();
  static constexpr int kPatients = 200;
  bool added = false;
  window_->session().ask<int>(
      Session::Kind::Write,
      window_.get(),
      [](Store& store) -> Expected<int> {
        auto change = StoreChange::begin(store, Permission::EditRecords);
        for (int i = 0; i < kPatients; ++i) {
          const auto patient = addPatient(
              store, {.family_name = "Family" + std::to_string(i), .given_name = "Given"});
          if (!patient) {
            return tl::unexpected(patient.error());
          }
        }
        const auto done = change->commit();
        return done ? Expected<int>(kPatients) : tl::unexpected(done.error());
      },
      [&](const Expected<int>& done) { added = done.has_value(); });
  PatientListModel* model = window_->patientsScreen()->model();
  ASSERT_TRUE(soon([&] { return added && model->rowCount() == kPatients; }));
  ASSERT_TRUE(soon([&] { return model->loadedRows() > 0; }));
  QTest::qWait(200);
  EXPECT_LT(model->loadedRows(), 60);
  type("search", QStringLiteral("family17"));
  EXPECT_TRUE(soon([&] { return model->rowCount() == 11; }));  // 17 and 170 to 179
}

}  // namespace
}  // namespace tarsus
