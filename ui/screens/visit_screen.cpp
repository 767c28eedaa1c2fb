#include "ui/screens/visit_screen.h"

#include "ui/parts/note.h"
#include "ui/parts/words.h"
#include "ui/screens/coming_page.h"
#include "ui/screens/form_page.h"
#include "ui/screens/form_words.h"
#include "ui/screens/scan_page.h"
#include "ui/work/patient_summary.h"
#include "ui/work/session.h"
#include "ui/work/visit_work.h"

#include <QFileInfo>
#include <QStackedWidget>
#include <QVBoxLayout>

namespace tarsus {

VisitScreen::VisitScreen(Session& session, QWidget* parent) : Screen(parent) {
  work_ = new VisitWork(session, this);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  auto* notes = new QVBoxLayout;
  notes->setContentsMargins(24, 0, 24, 0);
  notes->setSpacing(0);
  problem_ = new Note(Note::Kind::Danger);
  problem_->setObjectName(QStringLiteral("visit problem"));
  told_ = new Note(Note::Kind::Warning);
  told_->setObjectName(QStringLiteral("visit note"));
  notes->addWidget(problem_);
  notes->addWidget(told_);
  column->addLayout(notes);
  stack_ = new QStackedWidget;
  column->addWidget(stack_, 1);
  scan_ = new ScanPage(*work_);
  setPage(Scan, scan_);
  setPage(Form, new FormPage(*work_));
  setPage(Outline,
          new ComingPage(*work_,
                         QStringLiteral("foot"),
                         tr("Outline"),
                         tr("Here the wound's edge is drawn on the model.")));
  setPage(Review,
          new ComingPage(*work_,
                         QStringLiteral("eye"),
                         tr("Review"),
                         tr("Here the numbers are checked and the visit is signed.")));
  setPage(Report,
          new ComingPage(*work_,
                         QStringLiteral("print"),
                         tr("Report"),
                         tr("Here the report is looked at, printed and saved.")));
  connect(work_, &VisitWork::opened, this, [this] {
    problem_->setText({});
    emit crumbsChanged();
    const bool done = work_->hasScan() || work_->noScan();
    show(done ? Form : Scan);
  });
  connect(work_, &VisitWork::refused, this, &VisitScreen::showProblem);
  connect(work_, &VisitWork::saveFailed, this, &VisitScreen::showProblem);
  connect(work_, &VisitWork::merged, this, [this](const QStringList& disputed) {
    QStringList names;
    for (const QString& name : disputed) {
      names << fieldWord(name);
    }
    told_->setText(tr("This visit was changed at another station too."),
                   names.isEmpty()
                       ? tr("Both entries are kept.")
                       : tr("Please check: %1. The other entry is kept as an earlier version.")
                             .arg(names.join(QStringLiteral(", "))));
  });
  connect(work_, &VisitWork::scanChanged, this, &Screen::crumbsChanged);
  connect(&work_->build(), &ScanBuild::changed, this, [this, was = -1]() mutable {
    if (const int now = reached(); now != was) {
      was = now;
      emit crumbsChanged();
    }
  });
}

VisitScreen::~VisitScreen() = default;

void VisitScreen::setPage(Step step, VisitPage* page) {
  pages_.at(step) = page;
  stack_->addWidget(page);
  connect(page, &VisitPage::statusChanged, this, &Screen::statusChanged);
  connect(page, &VisitPage::stepWanted, this, &VisitScreen::goTo);
}

void VisitScreen::open(const QString& visit_id) {
  problem_->setText({});
  told_->setText({});
  if (!work_->isOpen() || work_->facts().visit.id != visit_id.toStdString()) {
    close();
  }
  work_->open(visit_id);
}

void VisitScreen::close() {
  left();
  work_->close();
  for (VisitPage* page : pages_) {
    page->reset();
  }
  step_ = Scan;
  stack_->setCurrentIndex(Scan);
}

void VisitScreen::save() { work_->save(); }

int VisitScreen::reached() const {
  if (!work_->isOpen()) {
    return Scan;
  }
  return work_->modelIsFit() ? Outline : work_->noScan() ? Review : Form;
}

void VisitScreen::goTo(int step) {
  if (work_->isOpen() && step >= Scan && step <= reached() && step != step_) {
    show(step);
  }
}

void VisitScreen::show(int step) {
  if (in_front_) {
    pages_.at(static_cast<std::size_t>(step_))->leave();
  }
  step_ = step;
  stack_->setCurrentWidget(pages_.at(static_cast<std::size_t>(step)));
  if (in_front_) {
    pages_.at(static_cast<std::size_t>(step))->enter();
  }
  emit crumbsChanged();
}

void VisitScreen::showProblem(const Error& error) {
  if (error.code == ErrorCode::StoreLocked) {
    return;
  }
  if (error.code == ErrorCode::StepNotAllowed) {
    problem_->setText(tr("This visit is no draft any more."),
                      tr("What you typed last is still shown, but not saved."));
    return;
  }
  problem_->setText(tr("Not saved."), sentenceOf(error));
}

QString VisitScreen::patientId() const { return QString::fromStdString(work_->facts().patient.id); }

bool VisitScreen::takeFile(const QString& path) {
  const QFileInfo file(path);
  const bool is_scan = file.isDir() || file.suffix().toLower() == QLatin1String("oni");
  if (!is_scan || !work_->mayEdit()) {
    return false;
  }
  work_->useFile(path.toStdString());
  show(Form);
  return true;
}

void VisitScreen::entered() {
  in_front_ = true;
  if (work_->isOpen()) {
    pages_.at(static_cast<std::size_t>(step_))->enter();
  }
}

void VisitScreen::left() {
  if (in_front_) {
    in_front_ = false;
    work_->save();
    pages_.at(static_cast<std::size_t>(step_))->leave();
  }
}

void VisitScreen::primary() { pages_.at(static_cast<std::size_t>(step_))->primary(); }

QStringList VisitScreen::crumbs() const {
  if (!work_->isOpen()) {
    return {tr("Patients"), {}, {}};
  }
  const VisitFacts& facts = work_->facts();
  return {tr("Patients"),
          fullName(facts.patient.fields),
          facts.foot.fields.side == FootSide::Right
              ? tr("Right foot, wound %1").arg(facts.wound.number)
              : tr("Left foot, wound %1").arg(facts.wound.number)};
}

QString VisitScreen::status() const {
  if (!work_->isOpen()) {
    return {};
  }
  const QString own = pages_.at(static_cast<std::size_t>(step_))->status();
  if (!own.isEmpty()) {
    return own;
  }
  const VisitFacts& facts = work_->facts();
  return tr("%1, week %2")
      .arg(dayMonthYear(dateAt(facts.visit.content.taken_at_ms)))
      .arg(facts.week);
}

QString VisitScreen::saved() const { return pages_.at(static_cast<std::size_t>(step_))->saved(); }

QString VisitScreen::headerNote(bool* trouble) const {
  return pages_.at(static_cast<std::size_t>(step_))->headerNote(trouble);
}

}  // namespace tarsus
