#include "ui/main_window.h"

#include "ui/parts/controls.h"
#include "ui/parts/focus_ring.h"
#include "ui/parts/header.h"
#include "ui/parts/status_bar.h"
#include "ui/parts/step_bar.h"
#include "ui/parts/words.h"
#include "ui/screens/gate_screen.h"
#include "ui/screens/model_screen.h"
#include "ui/screens/new_patient_screen.h"
#include "ui/screens/patient_screen.h"
#include "ui/screens/patients_screen.h"
#include "ui/screens/visit_screen.h"

#include <QAction>
#include <QCloseEvent>
#include <QDateTime>
#include <QDragEnterEvent>
#include <QLocale>
#include <QMimeData>
#include <QStackedWidget>
#include <QVBoxLayout>

namespace tarsus {
namespace {

QString firstFile(const QMimeData* data) {
  for (const QUrl& url : data->urls()) {
    if (url.isLocalFile()) {
      return url.toLocalFile();
    }
  }
  return {};
}

}  // namespace

MainWindow::MainWindow(SessionOptions options, QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("window"));
  setAttribute(Qt::WA_StyledBackground);
  setWindowTitle(tr("Tarsus"));
  setMinimumSize(900, 600);
  resize(1440, 900);
  setAcceptDrops(true);
  session_ = new Session(std::move(options), this);
  header_ = new Header;
  status_ = new StatusBar;
  stack_ = new QStackedWidget;
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(0);
  layout->addWidget(header_);
  layout->addWidget(stack_, 1);
  layout->addWidget(status_);
  makeScreens();
  makeKeys();
  new FocusRing(this);
  saved_ = tr("All work saved");
  status_->setSaved(saved_);
  connect(header_, &Header::crumbClicked, this, &MainWindow::goToCrumb);
  connect(header_, &Header::lockClicked, this, &MainWindow::lock);
  connect(header_->steps(), &StepBar::stepChosen, this, [this](int step) { visit_->goTo(step); });
  connect(header_, &Header::openModelClicked, this, [this] { model_->chooseFile(); });
  connect(session_, &Session::stateChanged, this, &MainWindow::follow);
  connect(session_, &Session::saved, this, [this] {
    const QTime now = QDateTime::fromMSecsSinceEpoch(session_->nowMs()).time();
    saved_ = tr("All work saved, %1").arg(QLocale().toString(now, QLocale::ShortFormat));
    showFrame();
  });
  bring(gate_);
}

// The session's thread ends before the screens it answers to.
MainWindow::~MainWindow() { delete session_; }

void MainWindow::makeScreens() {
  gate_ = new GateScreen(*session_);
  patients_ = new PatientsScreen(*session_);
  new_patient_ = new NewPatientScreen(*session_);
  patient_ = new PatientScreen(*session_);
  model_ = new ModelScreen;
  visit_ = new VisitScreen(*session_);
  for (Screen* screen : {static_cast<Screen*>(gate_),
                         static_cast<Screen*>(patients_),
                         static_cast<Screen*>(new_patient_),
                         static_cast<Screen*>(patient_),
                         static_cast<Screen*>(visit_),
                         static_cast<Screen*>(model_)}) {
    stack_->addWidget(screen);
    connect(screen, &Screen::crumbsChanged, this, &MainWindow::showFrame);
    connect(screen, &Screen::statusChanged, this, &MainWindow::showFrame);
  }
  connect(patients_, &PatientsScreen::patientChosen, this, &MainWindow::showPatient);
  connect(patients_, &PatientsScreen::newPatient, this, [this] { go(new_patient_); });
  connect(new_patient_, &NewPatientScreen::givenUp, this, &MainWindow::back);
  connect(new_patient_, &NewPatientScreen::added, this, [this](const QString& id) {
    history_ = {patients_};  // back from the new patient leads to the list, not to the form
    patient_->open(id);
    bring(patient_);
  });
  connect(patient_, &PatientScreen::visitChosen, this, &MainWindow::showVisit);
  const auto to_model = [this] {
    if (currentScreen() != model_) {
      go(model_);
    }
  };
  connect(model_, &ModelScreen::modelShown, this, to_model);
  connect(model_, &ModelScreen::modelRefused, this, to_model);
}

void MainWindow::addKey(const QString& name, const QKeySequence& key, std::function<void()> act) {
  auto* action = new QAction(name, this);
  action->setShortcut(key);
  connect(action, &QAction::triggered, this, std::move(act));
  addAction(action);
}

void MainWindow::makeKeys() {
  addKey(tr("Open a model"), QKeySequence::Open, [this] { model_->chooseFile(); });
  addKey(tr("Back"), QKeySequence(static_cast<int>(Qt::ALT) + Qt::Key_Left), [this] { back(); });
  addKey(tr("Lock"), QKeySequence(static_cast<int>(Qt::CTRL) + Qt::Key_L), [this] { lock(); });
  for (int i = 0; i < VisitScreen::kSteps; ++i) {
    addKey(tr("Step %1").arg(i + 1),
           QKeySequence(static_cast<int>(Qt::ALT) + Qt::Key_1 + i),
           [this, i] {
             if (currentScreen() == visit_) {
               visit_->goTo(i);
             }
           });
  }
  addKey(tr("Search"), QKeySequence::Find, [this] { currentScreen()->search(); });
  addKey(tr("The filled button"),
         QKeySequence(static_cast<int>(Qt::CTRL) + Qt::Key_Return),
         [this] { currentScreen()->primary(); });
  addKey(tr("New patient"), QKeySequence::New, [this] {
    if (session_->mayEdit() && currentScreen() == patients_) {
      go(new_patient_);
    }
  });
}

void MainWindow::start() { session_->open(); }

void MainWindow::openModel(const QString& path) { model_->open(path); }

Screen* MainWindow::currentScreen() const { return static_cast<Screen*>(stack_->currentWidget()); }

void MainWindow::go(Screen* screen) {
  if (currentScreen() != screen) {
    history_.push_back(currentScreen());
  }
  bring(screen);
}

void MainWindow::bring(Screen* screen) {
  if (currentScreen() != nullptr && currentScreen() != screen) {
    currentScreen()->left();
  }
  stack_->setCurrentWidget(screen);
  showFrame();
  screen->entered();
}

void MainWindow::back() {
  if (history_.empty()) {
    return;
  }
  Screen* before = history_.back();
  history_.pop_back();
  if (before == patient_) {
    patient_->open(patient_->id());  // a visit may have changed it
  }
  bring(before);
}

void MainWindow::showPatient(const QString& id) {
  patient_->open(id);
  go(patient_);
}

void MainWindow::showVisit(const QString& visit_id) {
  visit_->open(visit_id);
  go(visit_);
}

void MainWindow::lock() {
  visit_->save();
  session_->lock();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  visit_->save();
  QWidget::closeEvent(event);
}

void MainWindow::goToCrumb(int index) {
  if (index == 1 && currentScreen() == visit_) {
    history_ = {patients_};
    patient_->open(visit_->patientId());
    bring(patient_);
  } else if (index == 0 && session_->state() == Session::State::Open) {
    history_.clear();
    bring(patients_);
  } else if (index == 0) {
    bring(gate_);
  }
}

void MainWindow::forget() {
  history_.clear();
  kept_ = nullptr;
  patient_->forget();
  patients_->forget();
  visit_->close();
}

void MainWindow::follow() {
  if (session_->state() == Session::State::Open) {
    const bool same = kept_ != nullptr && kept_for_ == session_->who()->id;
    Screen* next = same ? kept_ : static_cast<Screen*>(patients_);
    if (!same) {
      forget();
    }
    kept_ = nullptr;
    stack_->setCurrentWidget(next);
    showFrame();
    if (next != new_patient_) {
      next->entered();  // a half-filled form stays as it was
    }
    kept_for_ = session_->who()->id;
    return;
  }
  Screen* shown = currentScreen();
  const bool nobody_was_in = kept_for_.empty();
  if (shown == gate_ || (shown == model_ && nobody_was_in)) {
    return;  // the gate follows by itself; a model file belongs to nobody
  }
  kept_ = shown == model_ ? static_cast<Screen*>(patients_) : shown;
  bring(gate_);
}

void MainWindow::showFrame() {
  const Screen* screen = currentScreen();
  const bool framed = screen != gate_;
  header_->setVisible(framed);
  status_->setVisible(framed);
  QStringList crumbs = screen->crumbs();
  if (screen == model_) {
    crumbs.prepend(session_->who() ? tr("Patients") : tr("Sign in"));
  }
  header_->setCrumbs(crumbs);
  status_->setMiddle(screen->status());
  status_->setSaved(screen->saved().isEmpty() ? saved_ : screen->saved());
  header_->steps()->setVisible(screen->step() >= 0);
  if (screen->step() >= 0) {
    header_->steps()->setStep(screen->step(), screen->reached());
  }
  bool trouble = false;
  const QString note = screen->headerNote(&trouble);
  header_->setNote(note, trouble);
  const auto& who = session_->who();
  header_->setPerson(who ? QString::fromStdString(who->name) : QString(),
                     who ? roleWord(who->role) : QString());
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (!firstFile(event->mimeData()).isEmpty()) {
    event->acceptProposedAction();
  }
}

void MainWindow::dropEvent(QDropEvent* event) {
  const QString path = firstFile(event->mimeData());
  if (!path.isEmpty()) {
    event->acceptProposedAction();
    if (!currentScreen()->takeFile(path)) {
      openModel(path);
    }
  }
}

}  // namespace tarsus
