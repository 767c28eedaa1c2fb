#include "ui/screens/gate_screen.h"

#include "ui/parts/brand_panel.h"
#include "ui/parts/controls.h"
#include "ui/parts/note.h"
#include "ui/parts/words.h"
#include "ui/screens/first_run_page.h"
#include "ui/screens/forgotten_page.h"
#include "ui/screens/recovery_page.h"
#include "ui/screens/sign_in_page.h"
#include "ui/work/session.h"

#include <QCoreApplication>
#include <QHBoxLayout>
#include <QStackedWidget>
#include <QVBoxLayout>

namespace tarsus {
namespace {

constexpr int kNarrow = 1000;  ///< under this the form has the window to itself

}  // namespace

GateScreen::GateScreen(Session& session, QWidget* parent) : Screen(parent), session_(session) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(0);
  brand_ = new BrandPanel;
  row->addWidget(brand_, 5);
  auto* right = new QVBoxLayout;
  right->setContentsMargins(32, 24, 32, 16);
  pages_ = new QStackedWidget;
  right->addWidget(pages_, 1);
  right->addWidget(makeLine(tr("Version %1").arg(QCoreApplication::applicationVersion()),
                            TypeRole::Small,
                            QStringLiteral("secondary")));
  row->addLayout(right, 7);
  opening_ = new GatePage(452, tr("Opening the records"), {});
  failed_ = makeFailed();
  sign_in_ = new SignInPage(session_);
  first_run_ = new FirstRunPage(session_);
  recovery_ = new RecoveryPage;
  forgotten_ = new ForgottenPage(session_);
  for (QWidget* page : {opening_,
                        failed_,
                        static_cast<QWidget*>(sign_in_),
                        static_cast<QWidget*>(first_run_),
                        static_cast<QWidget*>(recovery_),
                        static_cast<QWidget*>(forgotten_)}) {
    pages_->addWidget(page);
  }
  connect(first_run_, &FirstRunPage::created, this, [this](const QString& code) {
    recovery_->setCode(code);
    show(recovery_);
  });
  connect(recovery_, &RecoveryPage::kept, this, [this] { session_.begin(); });
  connect(sign_in_, &SignInPage::forgotten, this, [this] {
    forgotten_->setPerson(sign_in_->person());
    show(forgotten_);
  });
  connect(forgotten_, &ForgottenPage::givenUp, this, [this] { show(sign_in_); });
  connect(&session_, &Session::stateChanged, this, &GateScreen::follow);
}

QWidget* GateScreen::makeFailed() {
  auto* page = new QWidget;
  auto* column = new QVBoxLayout(page);
  column->setSpacing(16);
  column->addStretch();
  column->addWidget(makeLabel(tr("The records could not be opened"), TypeRole::Title));
  failure_ = new Note(Note::Kind::Danger);
  column->addWidget(failure_);
  QPushButton* again = makeButton(tr("Try again"), QStringLiteral("primary"));
  column->addWidget(again, 0, Qt::AlignLeft);
  column->addStretch();
  connect(again, &QPushButton::clicked, this, [this] { session_.open(); });
  return page;
}

void GateScreen::show(QWidget* page) {
  pages_->setCurrentWidget(page);
  if (auto* gate = qobject_cast<GatePage*>(page); gate != nullptr) {
    gate->entered();
  }
}

void GateScreen::follow() {
  switch (session_.state()) {
    case Session::State::Opening:
      show(opening_);
      break;
    case Session::State::New:
      show(first_run_);
      break;
    case Session::State::Failed:
      failure_->setText(sentenceOf(session_.problem()),
                        QString::fromStdString(session_.problem().detail));
      show(failed_);
      break;
    case Session::State::Locked:
      show(sign_in_);
      break;
    case Session::State::Open:
      break;
  }
}

void GateScreen::entered() { follow(); }

void GateScreen::primary() {
  if (auto* gate = qobject_cast<GatePage*>(pages_->currentWidget()); gate != nullptr) {
    gate->primary();
  }
}

void GateScreen::resizeEvent(QResizeEvent* event) {
  Screen::resizeEvent(event);
  brand_->setVisible(width() * 100 / Look::percent() >= kNarrow);
}

}  // namespace tarsus
