// Grabs each screen in light and dark, in English and in words 40 % longer, at two sizes.

#include "measurement/records/feet.h"
#include "measurement/records/patients.h"
#include "measurement/records/users.h"
#include "measurement/records/visits.h"
#include "measurement/records/wounds.h"
#include "reconstruction/base/temporary_folder.h"
#include "reconstruction/capture/openni/openni_library.h"
#include "ui/look/look.h"
#include "ui/main_window.h"
#include "ui/parts/foot_map.h"
#include "ui/scene/model_view.h"
#include "ui/screens/patient_list_model.h"
#include "ui/screens/patient_screen.h"
#include "ui/screens/patients_screen.h"
#include "ui/screens/scan_page.h"
#include "ui/screens/visit_screen.h"
#include "ui/work/visit_work.h"

#include <QApplication>
#include <QDir>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QTest>
#include <QToolButton>
#include <QTranslator>

#include <cstdio>
#include <cstdlib>
#include <functional>

namespace tarsus {
namespace {

/// Stands for a language whose words are longer: "Sign in" becomes "Sign in§§§".
class LongWords : public QTranslator {
 public:
  [[nodiscard]] bool isEmpty() const override { return false; }
  [[nodiscard]] QString translate(const char* context,
                                  const char* text,
                                  const char* comment,
                                  int) const override {
    const QString english = QString::fromUtf8(text);
    const bool is_format = QLatin1String(comment).contains(QLatin1String("day"));
    if (qstrncmp(context, "Q", 1) == 0 || english.isEmpty() || is_format) {
      return {};
    }
    const int more = std::max(1, static_cast<int>(english.size()) * 2 / 5);
    QString longer = english;
    for (int i = 0; i < more; ++i) {
      longer += i % 6 == 5 ? QLatin1Char(' ') : QLatin1Char('e');
    }
    return longer;
  }
};

struct Invented {
  const char* family;
  const char* given;
  const char* born;
  const char* number;
  FootSide side;
  const char* place;
  std::vector<double> areas_cm2;
  int days_ago;
  VisitState state;
  bool healed;
};

const std::vector<Invented>& invented() {
  static const std::vector<Invented> list{{"Mensah",
                                           "Kwame",
                                           "1966-04-04",
                                           "40-2950",
                                           FootSide::Right,
                                           "mth_1",
                                           {4.5, 4.4, 4.47},
                                           12,
                                           VisitState::Reviewed,
                                           false},
                                          {"Fischer",
                                           "Hannelore",
                                           "1947-12-11",
                                           "40-1735",
                                           FootSide::Right,
                                           "heel",
                                           {2.5, 1.7, 0.8, 0.3},
                                           10,
                                           VisitState::Reviewed,
                                           true},
                                          {"Alvarez",
                                           "Pedro",
                                           "1970-09-30",
                                           "40-3127",
                                           FootSide::Left,
                                           "mth_4",
                                           {3.4, 2.9, 2.5, 2.20},
                                           7,
                                           VisitState::Reviewed,
                                           false},
                                          {"Aasen",
                                           "Ingrid",
                                           "1941-05-19",
                                           "40-0877",
                                           FootSide::Left,
                                           "midfoot",
                                           {2.9, 3.0, 2.9, 2.95},
                                           6,
                                           VisitState::Reviewed,
                                           false},
                                          {"Wilk",
                                           "Tomasz",
                                           "1955-11-08",
                                           "40-2291",
                                           FootSide::Right,
                                           "toe_1",
                                           {1.2, 0.9, 0.8, 0.41},
                                           4,
                                           VisitState::Reviewed,
                                           false},
                                          {"Solberg",
                                           "Erik",
                                           "1952-08-21",
                                           "40-2664",
                                           FootSide::Left,
                                           "mth_2",
                                           {6.1, 6.3, 6.1, 7.41},
                                           4,
                                           VisitState::Signed,
                                           false},
                                          {"Demir",
                                           "Aylin",
                                           "1963-01-27",
                                           "40-3004",
                                           FootSide::Right,
                                           "mth_3",
                                           {2.2, 1.7, 1.3, 1.06},
                                           3,
                                           VisitState::Signed,
                                           false},
                                          {"Pettersson",
                                           "Johan",
                                           "1949-07-02",
                                           "40-1120",
                                           FootSide::Left,
                                           "heel",
                                           {4.8, 5.0, 5.1, 5.12},
                                           0,
                                           VisitState::Signed,
                                           false}};
  return list;
}

template <typename T>
T must(Expected<T> result) {
  if (!result) {
    std::fprintf(stderr, "tarsus-ui-pictures: %s\n", describe(result.error()).c_str());
    std::exit(1);
  }
  return std::move(*result);
}

void fill(Store& store, const Invented& who) {
  const auto patient = must(addPatient(store,
                                       {.family_name = who.family,
                                        .given_name = who.given,
                                        .birth_date = who.born,
                                        .identifier = who.number}));
  const auto foot = must(addFoot(store, patient.id, {.side = who.side, .missing_toes = {}}));
  const WoundFields fields{.place = who.place,
                           .aspect = "plantar",
                           .onset = "2026-09-01",
                           .aetiology = "neuropathic",
                           .parents = {},
                           .healed_on = who.healed ? "2026-11-06" : ""};
  const auto wound = must(addWound(store, foot.id, fields));
  const auto count = static_cast<int>(who.areas_cm2.size());
  for (int i = 0; i < count; ++i) {
    const double area = 100.0 * who.areas_cm2[static_cast<std::size_t>(i)];
    const std::int64_t days = who.days_ago + 7 * (count - 1 - i);
    auto visit = must(
        addVisit(store,
                 wound.id,
                 {.taken_at_ms = store.environment().now_ms() - days * 86'400'000, .files = {}}));
    const nlohmann::json numbers = {
        {"opening_area_mm2", area},
        {"perimeter_mm", 3.8 * std::sqrt(area)},
        {"intervals", {{"opening_area_mm2", {0.93 * area, 1.07 * area}}}}};
    must(addMeasurement(store, visit.revision, {.visit_id = visit.id, .numbers = numbers}));
    visit = must(findVisit(store, visit.id));
    must(stepVisit(store, visit.id, visit.revision, VisitStep::Sign));
    if (who.state == VisitState::Reviewed || i + 1 < count) {
      visit = must(findVisit(store, visit.id));
      must(stepVisit(store, visit.id, visit.revision, VisitStep::Review));
    }
  }
}

class Pictures {
 public:
  explicit Pictures(QString out) : out_(std::move(out)) {}

  void takeAll() {
    if (!scan_.isEmpty()) {
      firstRun(true, false);
      takeVisit();
      return;
    }
    takeEmpty();
    firstRun(true);
    lockAndTake();
    takeWork();
  }

 private:
  void makeWindow(const std::filesystem::path& folder) {
    window_.reset();
    window_ = std::make_unique<MainWindow>(SessionOptions{
        .folder = folder, .now_ms = {}, .key_cost = {.operations = 1, .memory_bytes = 8192}});
    window_->show();
    QTest::qWait(50);
    QApplication::setActiveWindow(window_.get());
    window_->start();
    QTest::qWait(300);
  }

  void take(const QString& name) {
    for (const QSize& size : {QSize(1440, 900), QSize(1280, 800)}) {
      for (const ThemeChoice theme : kThemeChoices) {
        if (theme == ThemeChoice::HighContrast && size.width() == 1280) {
          continue;
        }
        Look::instance().set(theme, 100);
        window_->resize(size);
        QTest::qWait(120);
        const char* themes[] = {"light", "dark", "contrast"};
        const QString file = QStringLiteral("%1/%2-%3-%4%5.png")
                                 .arg(out_, name, QLatin1String(themes[static_cast<int>(theme)]))
                                 .arg(size.width())
                                 .arg(suffix_);
        if (!window_->grab().save(file)) {
          std::fprintf(stderr, "tarsus-ui-pictures: %s was not written\n", qPrintable(file));
          std::exit(1);
        }
      }
    }
    Look::instance().set(ThemeChoice::Light, 100);
  }

  template <typename Widget>
  Widget* named(const char* name) {
    for (Widget* widget : window_->findChildren<Widget*>(QLatin1String(name))) {
      if (widget->isVisible()) {
        return widget;
      }
    }
    std::fprintf(stderr, "tarsus-ui-pictures: no %s\n", name);
    std::exit(1);
  }
  void type(const char* name, const char* text) {
    named<QLineEdit>(name)->setText(QLatin1String(text));
  }

  void firstRun(bool with_demo, bool with_pictures = true) {
    folder_ = std::make_unique<TemporaryFolder>();
    makeWindow(folder_->path());
    type("name", "Sofia Lindqvist");
    type("clinic", "Foot clinic, room 3");
    type("new password", "a long password");
    type("password again", "a long one");
    named<QPushButton>("create")->click();
    if (with_demo && with_pictures) {
      take(QStringLiteral("01b-first-run"));
    }
    type("password again", "a long password");
    named<QAbstractButton>("demo")->setChecked(with_demo);
    named<QPushButton>("create")->click();
    QTest::qWait(1500);
    if (with_demo && with_pictures) {
      take(QStringLiteral("01c-recovery-code"));
    }
    const QString code = named<QLabel>("recovery code")->text().simplified();
    type("code group", qPrintable(code.split(QLatin1Char(' ')).value(3)));
    named<QPushButton>("kept")->click();
    QTest::qWait(500);
  }

  static bool soon(const std::function<bool()>& holds, int ms = 60000) {
    return QTest::qWaitFor(holds, ms);
  }
  void startVisit() {
    PatientListModel* model = window_->patientsScreen()->model();
    soon([&] { return model->rowCount() > 0; });
    window_->showPatient(model->index(0).data(PatientListModel::IdRole).toString());
    QTest::qWait(800);
    named<QPushButton>("start visit")->click();
    soon([&] { return window_->visitScreen()->work().isOpen(); });
    QTest::qWait(500);
  }
  void choose(const char* field, int index) {
    named<QWidget>(field)->findChildren<QToolButton*>().at(index)->click();
  }

  /// The steps of a visit, from a scan folder that plays as the camera.
  void takeVisit() {
    startVisit();
    ScanPage* page = window_->visitScreen()->scanPage();
    const ScanMoment& moment = page->moment();
    soon([&] { return moment.camera == ScanMoment::Camera::None; }, 15000);
    take(QStringLiteral("05e-no-camera"));
    page->useCamera(simulatedUri(scan_.toStdString()));
    soon([&] { return moment.camera == ScanMoment::Camera::Live && !moment.color.isNull(); });
    QTest::qWait(500);
    take(QStringLiteral("05d-ready"));
    QTest::keyClick(page, Qt::Key_Space);
    soon([&] { return moment.guidance.passed_s > 9.0; });
    take(QStringLiteral("05-scan"));
    QTest::keyClick(page, Qt::Key_Escape);
    QTest::qWait(200);
    take(QStringLiteral("05f-leave-out"));
    named<QPushButton>("leave out")->click();
    QTest::qWait(500);
    page->useCamera(simulatedUri(scan_.toStdString(), "garbage,6,60"));
    soon([&] { return moment.camera != ScanMoment::Camera::Live; });
    soon([&] { return moment.camera == ScanMoment::Camera::Live; });
    QTest::keyClick(page, Qt::Key_Space);
    soon([&] { return moment.recording && moment.guidance.why_lost.has_value(); });
    QTest::qWait(300);
    take(QStringLiteral("05b-scan-lost"));
    page->setFocus();
    QTest::keyClick(page, Qt::Key_Escape);
    QTest::qWait(300);
    if (auto* leave = window_->findChild<QPushButton*>(QStringLiteral("leave out"))) {
      leave->click();
    }
    QTest::qWait(500);
    page->useCamera(simulatedUri(scan_.toStdString(), "unplug,8,200"));
    soon([&] { return moment.camera != ScanMoment::Camera::Live; });
    soon([&] { return moment.camera == ScanMoment::Camera::Live; });
    QTest::keyClick(page, Qt::Key_Space);
    soon([&] { return moment.camera == ScanMoment::Camera::Gone; });
    QTest::qWait(300);
    take(QStringLiteral("11-camera-unplugged"));
    named<QPushButton>("scan later")->click();
    QTest::qWait(500);
    window_->visitScreen()->takeFile(scan_);
    soon([&] { return window_->visitScreen()->work().build().fraction() > 0.3; });
    choose("pulse_dorsalis_pedis", 0);
    choose("pulse_tibialis_posterior", 2);
    named<QLineEdit>("toe_pressure_mmhg")->setFocus();
    QTest::keyClicks(named<QLineEdit>("toe_pressure_mmhg"), QStringLiteral("620"));
    take(QStringLiteral("04-form"));
    named<QPushButton>("section infection")->click();
    named<QAbstractButton>("infection_warmth")->click();
    choose("probe_to_bone", 1);
    choose("exudate_amount", 1);
    choose("edge", 1);
    take(QStringLiteral("04b-form-infection"));
    named<QPushButton>("section bed")->click();
    choose("undermining", 1);
    take(QStringLiteral("04c-form-bed"));
    named<QPushButton>("section notes")->click();
    if (auto* cancel = named<QPushButton>("cancel build")) {
      cancel->click();
    }
    take(QStringLiteral("04d-form-stop"));
    named<QPushButton>("go on building")->click();
    soon(
        [&] { return window_->visitScreen()->work().build().state() != ScanBuild::State::Running; },
        400000);
    QTest::qWait(2500);
    take(QStringLiteral("04e-form-ready"));
    window_->visitScreen()->goTo(VisitScreen::Outline);
    take(QStringLiteral("06-outline-to-come"));
    window_->visitScreen()->goTo(VisitScreen::Form);
    Look::instance().set(ThemeChoice::Light, 200);
    window_->resize(1280, 800);
    QTest::qWait(300);
    window_->grab().save(out_ + QStringLiteral("/04-form-200%1.png").arg(suffix_));
    window_->visitScreen()->goTo(VisitScreen::Scan);
    QTest::qWait(1500);
    window_->grab().save(out_ + QStringLiteral("/05-scan-200%1.png").arg(suffix_));
    Look::instance().set(ThemeChoice::Light, 100);
    window_->resize(1440, 900);
    named<QPushButton>("no scan")->click();
    QTest::qWait(300);
    take(QStringLiteral("04f-no-scan"));
  }

  void takeEmpty() {
    firstRun(false);
    take(QStringLiteral("11b-empty"));
  }

  void lockAndTake() {
    window_->session().ask<int>(
        Session::Kind::Write,
        window_.get(),
        [](Store& store) -> Expected<int> {
          must(signIn(store, "Administrator", "a long password"));
          must(addUser(store, "Dr Marek Brandt", Role::Physician, "a long password"));
          must(addUser(store, "Amara Nwosu", Role::Nurse, "a long password"));
          must(signIn(store, "Dr Marek Brandt", "a long password"));
          for (const Invented& who : invented()) {
            fill(store, who);
          }
          return 0;
        },
        [](const Expected<int>&) {});
    QTest::qWait(4000);
    window_->session().signIn("Dr Marek Brandt", "a long password", [](const auto&) {});
    QTest::qWait(1000);
    window_->session().lock();
    QTest::qWait(200);
    type("password", "1234567");
    take(QStringLiteral("01-sign-in"));
    type("password", "wrong");
    named<QPushButton>("sign in")->click();
    QTest::qWait(300);
    take(QStringLiteral("01d-wrong-password"));
    named<QPushButton>("forgot")->click();
    take(QStringLiteral("01e-forgotten"));
  }

  void takeWork() {
    window_->session().signIn("Dr Marek Brandt", "a long password", [](const auto&) {});
    QTest::qWait(1200);
    take(QStringLiteral("02-patients-physician"));
    window_->session().lock();
    window_->session().signIn("Sofia Lindqvist", "a long password", [](const auto&) {});
    QTest::qWait(1200);
    take(QStringLiteral("02-patients-nurse"));
    type("search", "holn");
    QTest::qWait(300);
    take(QStringLiteral("02b-no-match"));
    type("search", "holm");
    QTest::qWait(400);
    PatientListModel* model = window_->patientsScreen()->model();
    window_->showPatient(model->index(0).data(PatientListModel::IdRole).toString());
    QTest::qWait(600);
    take(QStringLiteral("03-patient"));
    FootMap* map = window_->patientScreen()->map();
    QTest::mouseClick(
        map, Qt::LeftButton, {}, map->pointOf(FootSide::Left, QStringLiteral("heel")).toPoint());
    QTest::qWait(100);
    take(QStringLiteral("03b-place-wound"));
    window_->back();
    QTest::qWait(300);
    named<QLineEdit>("search")->clear();
    named<QPushButton>("new patient")->click();
    QTest::qWait(200);
    type("birth date", "31.2.1958");
    named<QPushButton>("add")->click();
    take(QStringLiteral("02c-new-patient"));
    type("family name", "Nobody");
    named<QLineEdit>("birth date")->clear();
    named<QPushButton>("add")->click();
    QTest::qWait(600);
    take(QStringLiteral("03c-no-wound"));
    Look::instance().set(ThemeChoice::Light, 200);
    window_->back();
    QTest::qWait(400);
    window_->resize(1280, 800);
    QTest::qWait(400);
    window_->grab().save(out_ + QStringLiteral("/02-patients-200%1.png").arg(suffix_));
    Look::instance().set(ThemeChoice::Light, 100);
  }

 public:
  QString suffix_;
  QString scan_;  ///< then the steps of a visit are taken, and nothing else

 private:
  QString out_;
  std::unique_ptr<TemporaryFolder> folder_;
  std::unique_ptr<MainWindow> window_;
};

}  // namespace
}  // namespace tarsus

int main(int argc, char** argv) {
  if (argc != 2 && argc != 3) {
    std::fprintf(stderr, "usage: tarsus-ui-pictures OUT_DIR [SCAN]\n");
    return 2;
  }
  tarsus::prepareGraphics();
  QApplication application(argc, argv);
  QApplication::setApplicationVersion(QStringLiteral("1.0.0"));
  QLocale::setDefault(QLocale(QLocale::English, QLocale::UnitedKingdom));
  tarsus::Look::instance().set(tarsus::ThemeChoice::Light, 100);
  QDir().mkpath(QString::fromLocal8Bit(argv[1]));
  {
    tarsus::Pictures pictures(QString::fromLocal8Bit(argv[1]));
    pictures.scan_ = argc == 3 ? QString::fromLocal8Bit(argv[2]) : QString();
    pictures.takeAll();
  }
  tarsus::LongWords longer;
  QApplication::installTranslator(&longer);
  tarsus::Pictures pictures(QString::fromLocal8Bit(argv[1]));
  pictures.suffix_ = QStringLiteral("-long");
  pictures.scan_ = argc == 3 ? QString::fromLocal8Bit(argv[2]) : QString();
  pictures.takeAll();
  return 0;
}
