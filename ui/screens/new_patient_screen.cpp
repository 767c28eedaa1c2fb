#include "ui/screens/new_patient_screen.h"

#include "ui/parts/controls.h"
#include "ui/parts/field_frame.h"
#include "ui/parts/note.h"
#include "ui/parts/words.h"
#include "ui/work/session.h"

#include <QDateTime>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QLocale>
#include <QVBoxLayout>

namespace tarsus {
namespace {

constexpr int kOldest = 120;

QLineEdit* makeField(const QString& name) {
  auto* field = new QLineEdit;
  field->setObjectName(name);
  return field;
}

}  // namespace

QDate typedDate(const QString& typed) {
  const QString text = typed.simplified();
  const QLocale locale;
  QStringList formats{locale.dateFormat(QLocale::ShortFormat),
                      locale.dateFormat(QLocale::LongFormat),
                      QStringLiteral("yyyy-M-d"),
                      QStringLiteral("d.M.yyyy"),
                      QStringLiteral("d. M. yyyy"),
                      QStringLiteral("d MMM yyyy"),
                      QStringLiteral("d MMMM yyyy")};
  if (!locale.dateFormat(QLocale::ShortFormat).startsWith(QLatin1Char('M'))) {
    formats << QStringLiteral("d/M/yyyy");
  } else {
    formats << QStringLiteral("M/d/yyyy");
  }
  for (const QString& format : formats) {
    if (!format.contains(QLatin1String("yyyy"))) {
      continue;  // two digits do not say the century of somebody born 1926 or 2026
    }
    const QDate date = locale.toDate(text, format);
    if (date.isValid()) {
      return date;
    }
  }
  return {};
}

NewPatientScreen::NewPatientScreen(Session& session, QWidget* parent)
    : Screen(parent), session_(session) {
  auto* holder = new QWidget;
  holder->setMaximumWidth(820);
  auto* column = new QVBoxLayout(holder);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  column->addWidget(makeLabel(tr("New patient"), TypeRole::Title));
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* grid = new QGridLayout(card);
  grid->setContentsMargins(24, 24, 24, 24);
  grid->setHorizontalSpacing(16);
  grid->setVerticalSpacing(20);
  given_ = makeField(QStringLiteral("given name"));
  family_ = makeField(QStringLiteral("family name"));
  birth_ = makeField(QStringLiteral("birth date"));
  number_ = makeField(QStringLiteral("number"));
  family_frame_ = new FieldFrame(tr("Family name"), family_);
  birth_frame_ = new FieldFrame(
      tr("Birth date"),
      birth_,
      tr("Such as %1. Leave it empty if it is not known.").arg(dayMonthYear(QDate(1958, 3, 14))));
  grid->addWidget(new FieldFrame(tr("Given name"), given_), 0, 0, Qt::AlignTop);
  grid->addWidget(family_frame_, 0, 1, Qt::AlignTop);
  grid->addWidget(birth_frame_, 1, 0, Qt::AlignTop);
  grid->addWidget(
      new FieldFrame(tr("Patient number"), number_, tr("Of your clinic, if there is one")),
      1,
      1,
      Qt::AlignTop);
  grid->setColumnStretch(0, 1);
  grid->setColumnStretch(1, 1);
  column->addWidget(card);
  problem_ = new Note(Note::Kind::Danger);
  column->addWidget(problem_);
  auto* buttons = new QHBoxLayout;
  buttons->setSpacing(12);
  buttons->addStretch();
  QPushButton* cancel = makeButton(tr("Cancel"));
  cancel->setProperty("target", QStringLiteral("large"));
  go_ = makeButton(tr("Add the patient"), QStringLiteral("primary"));
  go_->setObjectName(QStringLiteral("add"));
  buttons->addWidget(cancel);
  buttons->addWidget(go_);
  column->addLayout(buttons);
  column->addStretch();
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(24, 24, 24, 24);
  row->addStretch(1);
  row->addWidget(holder, 100);
  row->addStretch(1);
  connect(birth_, &QLineEdit::editingFinished, this, &NewPatientScreen::checkBirth);
  connect(birth_, &QLineEdit::textEdited, birth_frame_, &FieldFrame::clearError);
  connect(family_, &QLineEdit::textEdited, family_frame_, &FieldFrame::clearError);
  connect(go_, &QPushButton::clicked, this, &NewPatientScreen::primary);
  connect(cancel, &QPushButton::clicked, this, &NewPatientScreen::givenUp);
  for (QLineEdit* field : {given_, family_, birth_, number_}) {
    connect(field, &QLineEdit::returnPressed, this, &NewPatientScreen::primary);
  }
}

void NewPatientScreen::entered() {
  for (QLineEdit* field : {given_, family_, birth_, number_}) {
    field->clear();
  }
  family_frame_->clearError();
  birth_frame_->clearError();
  problem_->setText({});
  given_->setFocus();
}

void NewPatientScreen::checkBirth() {
  const QString text = birth_->text().simplified();
  if (text.isEmpty()) {
    birth_frame_->clearError();
    return;
  }
  const QDate date = typedDate(text);
  const QDate today = QDateTime::fromMSecsSinceEpoch(session_.nowMs()).date();
  if (!date.isValid()) {
    birth_frame_->setError(tr("There is no such date."));
  } else if (date > today) {
    birth_frame_->setError(tr("This date is still to come."));
  } else if (date < today.addYears(-kOldest)) {
    birth_frame_->setError(tr("More than %n years ago, please check.", nullptr, kOldest));
  } else {
    birth_frame_->clearError();
    birth_->setText(dayMonthYear(date));
  }
}

bool NewPatientScreen::check() {
  checkBirth();
  if (family_->text().trimmed().isEmpty()) {
    family_frame_->setError(tr("Type the family name."));
    family_->setFocus();
    return false;
  }
  if (!birth_frame_->error().isEmpty()) {
    birth_->setFocus();
    return false;
  }
  return true;
}

void NewPatientScreen::primary() {
  if (busy_ || !check()) {
    return;
  }
  const QDate birth = typedDate(birth_->text());
  const PatientFields fields{
      .family_name = family_->text().simplified().toStdString(),
      .given_name = given_->text().simplified().toStdString(),
      .birth_date = birth.isValid() ? birth.toString(Qt::ISODate).toStdString() : std::string(),
      .identifier = number_->text().simplified().toStdString()};
  busy_ = true;
  go_->setEnabled(false);
  session_.ask<Patient>(
      Session::Kind::Write,
      this,
      [fields](Store& store) { return addPatient(store, fields); },
      [this](const Expected<Patient>& patient) {
        busy_ = false;
        go_->setEnabled(true);
        if (!patient) {
          problem_->setText(tr("The patient was not added."), sentenceOf(patient.error()));
          return;
        }
        emit added(QString::fromStdString(patient->id));
      });
}

}  // namespace tarsus
