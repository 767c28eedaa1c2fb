#include "ui/screens/patients_screen.h"

#include "ui/look/icons.h"
#include "ui/parts/chip.h"
#include "ui/parts/choice_row.h"
#include "ui/parts/controls.h"
#include "ui/parts/empty_place.h"
#include "ui/parts/note.h"
#include "ui/parts/words.h"
#include "ui/screens/patient_delegate.h"
#include "ui/screens/patient_list_model.h"
#include "ui/screens/review_model.h"
#include "ui/work/demo_patient.h"
#include "ui/work/session.h"

#include <QAction>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLineEdit>
#include <QListView>
#include <QStackedWidget>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {

PatientsScreen::PatientsScreen(Session& session, QWidget* parent)
    : Screen(parent), session_(session) {
  model_ = new PatientListModel(session_, this);
  review_model_ = new ReviewModel(this);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(24, 24, 24, 24);
  row->setSpacing(24);
  row->addWidget(makeLeft(), 5);
  review_ = makeReview();
  row->addWidget(review_, 2);
  connect(model_, &PatientListModel::shown, this, &PatientsScreen::showCounts);
  connect(model_, &PatientListModel::failed, this, [this](const Error& error) {
    if (error.code != ErrorCode::StoreLocked) {
      problem_->setText(tr("The list could not be read."), sentenceOf(error));
    }
  });
  connect(&session_, &Session::saved, this, [this] {
    if (isVisible()) {
      model_->reload();
    }
  });
}

QWidget* PatientsScreen::makeLeft() {
  auto* left = new QWidget;
  left->setMaximumWidth(1600);
  auto* column = new QVBoxLayout(left);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  column->addWidget(makeBar());
  problem_ = new Note(Note::Kind::Danger);
  column->addWidget(problem_);
  pages_ = new QStackedWidget;
  list_page_ = makeList();
  none_ = new EmptyPlace(QStringLiteral("sole"),
                         tr("No patients yet"),
                         tr("Add your first patient, or look round with the demo patient first."),
                         true);
  empty_demo_ = none_->addButton(tr("Load the demo patient"));
  empty_new_ = none_->addButton(tr("New patient"), QStringLiteral("primary"), "plus");
  connect(empty_demo_, &QPushButton::clicked, this, &PatientsScreen::loadDemo);
  connect(empty_new_, &QPushButton::clicked, this, &PatientsScreen::newPatient);
  no_match_ =
      new EmptyPlace(QStringLiteral("search"), {}, tr("Check the spelling, or search by number."));
  QPushButton* clear = no_match_->addButton(tr("Clear the search"));
  connect(clear, &QPushButton::clicked, this, [this] {
    search_->clear();
    filter_->setCurrent(0);
    model_->setFilter(PatientFilter::All);
    search_->setFocus();
  });
  pages_->addWidget(list_page_);
  pages_->addWidget(none_);
  pages_->addWidget(no_match_);
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* inside = new QVBoxLayout(card);
  inside->setContentsMargins(8, 4, 8, 8);
  inside->addWidget(pages_);
  column->addWidget(card, 1);
  return left;
}

QWidget* PatientsScreen::makeBar() {
  auto* bar = new QWidget;
  auto* row = new QHBoxLayout(bar);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(12);
  row->addWidget(makeLine(tr("Patients"), TypeRole::Title));
  row->addStretch();
  bar_ = new QWidget;
  auto* tools = new QHBoxLayout(bar_);
  tools->setContentsMargins(0, 0, 0, 0);
  tools->setSpacing(12);
  new_ = makeButton(tr("New patient"), {}, "plus");
  new_->setObjectName(QStringLiteral("new patient"));
  new_->setProperty("target", QStringLiteral("large"));
  connect(new_, &QPushButton::clicked, this, &PatientsScreen::newPatient);
  search_ = new QLineEdit;
  search_->setObjectName(QStringLiteral("search"));
  search_->setPlaceholderText(tr("Name, number or birth date"));
  search_->setAccessibleName(tr("Search patients"));
  search_->setToolTip(tr("Ctrl+F"));
  search_->setClearButtonEnabled(true);
  search_->addAction(themeIcon(QStringLiteral("search")), QLineEdit::LeadingPosition);
  search_->setMinimumWidth(Look::px(240));
  search_->installEventFilter(this);
  Look::setType(search_, TypeRole::Base);
  connect(search_, &QLineEdit::textChanged, model_, &PatientListModel::setQuery);
  filter_ = new ChoiceRow({tr("All"), tr("Today"), tr("Drafts")});
  filter_->setTicks(false);
  filter_->setCurrent(0);
  connect(filter_, &ChoiceRow::chosen, this, [this](int index) {
    model_->setFilter(static_cast<PatientFilter>(index));
  });
  tools->addWidget(new_);
  tools->addWidget(search_, 1);
  tools->addWidget(filter_);
  row->addWidget(bar_, 4);
  return bar;
}

QWidget* PatientsScreen::makeList() {
  auto* page = new QWidget;
  auto* column = new QVBoxLayout(page);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  list_ = new QListView;
  column->addWidget(new PatientColumns(list_));
  list_->setObjectName(QStringLiteral("patients"));
  list_->setAccessibleName(tr("Patients"));
  list_->setModel(model_);
  list_->setItemDelegate(new PatientDelegate(list_));
  list_->setUniformItemSizes(true);
  list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list_->setResizeMode(QListView::Adjust);
  list_->setMouseTracking(true);
  list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  list_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  connect(list_, &QListView::clicked, this, [this](const QModelIndex& at) { openRow(at.row()); });
  connect(list_, &QListView::activated, this, [this](const QModelIndex& at) { openRow(at.row()); });
  column->addWidget(list_, 1);
  return page;
}

QWidget* PatientsScreen::makeReview() {
  auto* panel = new QWidget;
  panel->setMinimumWidth(Look::px(280));
  panel->setMaximumWidth(Look::px(480));
  auto* column = new QVBoxLayout(panel);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  auto* top = new QHBoxLayout;
  QLabel* title = makeLine(tr("To review"), TypeRole::Heading);
  title->setMinimumHeight(Look::px(50));
  top->addWidget(title);
  review_count_ = new Chip;
  top->addWidget(review_count_);
  top->addStretch();
  column->addLayout(top);
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* inside = new QVBoxLayout(card);
  inside->setContentsMargins(8, 8, 8, 8);
  review_pages_ = new QStackedWidget;
  review_list_ = new QListView;
  review_list_->setAccessibleName(tr("To review"));
  review_list_->setModel(review_model_);
  review_list_->setItemDelegate(new ReviewDelegate(review_list_));
  review_list_->setMouseTracking(true);
  review_list_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  review_list_->setResizeMode(QListView::Adjust);
  review_list_->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  const auto open = [this](const QModelIndex& at) {
    emit patientChosen(review_model_->items().at(static_cast<std::size_t>(at.row())).patient_id);
  };
  connect(review_list_, &QListView::clicked, this, open);
  connect(review_list_, &QListView::activated, this, open);
  review_pages_->addWidget(review_list_);
  review_pages_->addWidget(new EmptyPlace(
      QStringLiteral("check"), tr("Nothing to review"), tr("Signed visits appear here.")));
  inside->addWidget(review_pages_);
  column->addWidget(card, 1);
  review_oldest_ = makeButton(tr("Review the oldest first"), QStringLiteral("primary"));
  connect(review_oldest_, &QPushButton::clicked, this, [this] {
    emit patientChosen(review_model_->items().front().patient_id);
  });
  column->addWidget(review_oldest_);
  return panel;
}

bool PatientsScreen::isPhysician() const {
  return session_.who() && session_.who()->role == Role::Physician;
}

void PatientsScreen::entered() {
  problem_->setText({});
  const bool may_edit = session_.mayEdit();
  new_->setVisible(may_edit);
  empty_new_->setVisible(may_edit);
  empty_demo_->setVisible(may_edit);
  // One filled button: the physician's is the review, the nurse's a new patient.
  setStyleProperty(new_, "role", isPhysician() ? QString() : QStringLiteral("primary"));
  new_->setIcon(themeIcon(QStringLiteral("plus"), isPhysician() ? Tone::Text : Tone::OnAccent));
  review_->setVisible(isPhysician());
  model_->reload();
  if (isPhysician()) {
    loadReview();
  }
  search_->setFocus();
}

void PatientsScreen::forget() {
  search_->clear();
  model_->clear();
  review_model_->setItems({});
}

void PatientsScreen::loadReview() {
  session_.ask<std::vector<ReviewItem>>(
      Session::Kind::Read, this, reviewItems, [this](Expected<std::vector<ReviewItem>> items) {
        if (!items) {
          return;
        }
        const auto count = static_cast<int>(items->size());
        review_model_->setItems(std::move(*items));
        review_pages_->setCurrentIndex(count > 0 ? 0 : 1);
        review_count_->setChip({QString::number(count), ChipTone::Warning, {}});
        review_count_->setVisible(count > 0);
        review_oldest_->setVisible(count > 0);
      });
}

void PatientsScreen::loadDemo() {
  empty_demo_->setEnabled(false);
  session_.ask<std::string>(
      Session::Kind::Write, this, addDemoPatient, [this](const Expected<std::string>& made) {
        empty_demo_->setEnabled(true);
        if (!made) {
          problem_->setText(tr("The demo patient was not loaded."), sentenceOf(made.error()));
        }
      });
}

void PatientsScreen::showCounts() {
  if (!model_->loaded()) {
    return;
  }
  const bool none = model_->countOf(PatientFilter::All) == 0;
  const bool no_match = !none && model_->rowCount() == 0;
  bar_->setVisible(!none);
  if (no_match && !model_->query().isEmpty()) {
    no_match_->setWords(tr("No one matches “%1”").arg(model_->query()),
                        tr("Check the spelling, or search by number."));
  } else if (no_match) {
    no_match_->setWords(tr("No one in this list"), tr("Choose All to see every patient."));
  }
  pages_->setCurrentWidget(none       ? static_cast<QWidget*>(none_)
                           : no_match ? static_cast<QWidget*>(no_match_)
                                      : list_page_);
  const auto text = [this](const QString& name, PatientFilter filter) {
    return tr("%1  %2", "name of a filter, number of patients")
        .arg(name)
        .arg(model_->countOf(filter));
  };
  filter_->setTexts({text(tr("All"), PatientFilter::All),
                     text(tr("Today"), PatientFilter::Today),
                     text(tr("Drafts"), PatientFilter::Drafts)});
  if (model_->rowCount() > 0) {
    list_->setCurrentIndex(model_->index(0));
  }
  emit statusChanged();
}

QString PatientsScreen::status() const {
  const int drafts = model_->countOf(PatientFilter::Drafts);
  const QString patients = tr("%n patients", nullptr, model_->countOf(PatientFilter::All));
  return drafts == 0 ? patients : tr("%1, %2").arg(patients, tr("%n drafts", nullptr, drafts));
}

void PatientsScreen::openRow(int row) {
  const QString id = model_->index(row).data(PatientListModel::IdRole).toString();
  if (!id.isEmpty()) {
    emit patientChosen(id);
  }
}

void PatientsScreen::primary() {
  if (isPhysician() && !review_model_->items().empty()) {
    emit patientChosen(review_model_->items().front().patient_id);
  } else if (session_.mayEdit()) {
    emit newPatient();
  }
}

void PatientsScreen::search() {
  search_->setFocus();
  search_->selectAll();
}

/// Arrows and Enter in the search field work the list, so that the hands stay where they are.
bool PatientsScreen::eventFilter(QObject* watched, QEvent* event) {
  if (watched == search_ && event->type() == QEvent::KeyPress) {
    const auto* key = static_cast<QKeyEvent*>(event);
    const int step = key->key() == Qt::Key_Down ? 1 : key->key() == Qt::Key_Up ? -1 : 0;
    const int at = list_->currentIndex().row();
    if (step != 0 && at + step >= 0 && at + step < model_->rowCount()) {
      list_->setCurrentIndex(model_->index(at + step));
      return true;
    }
    if ((key->key() == Qt::Key_Return || key->key() == Qt::Key_Enter) && at >= 0 &&
        key->modifiers() == Qt::NoModifier) {
      openRow(at);
      return true;
    }
  }
  return Screen::eventFilter(watched, event);
}

/// Typing anywhere goes into the search.
void PatientsScreen::keyPressEvent(QKeyEvent* event) {
  const bool letter = !event->text().isEmpty() && event->text().at(0).isPrint() &&
                      (event->modifiers() & (Qt::ControlModifier | Qt::AltModifier)) == 0;
  if (letter && bar_->isVisible()) {
    search_->setFocus();
    search_->insert(event->text());
    return;
  }
  Screen::keyPressEvent(event);
}

}  // namespace tarsus
