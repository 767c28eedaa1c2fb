#include "ui/screens/wound_form.h"

#include "ui/parts/controls.h"
#include "ui/parts/field_frame.h"
#include "ui/parts/words.h"
#include "ui/screens/new_patient_screen.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {
namespace {

QString fromView(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

template <typename List, typename Word>
QComboBox* makeCombo(const List& list, Word word) {
  auto* combo = new QComboBox;
  combo->setProperty("target", QStringLiteral("desk"));
  combo->setMinimumContentsLength(12);
  combo->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  for (const std::string_view item : list) {
    QString text = word(fromView(item));
    text[0] = text.at(0).toUpper();
    combo->addItem(text, fromView(item));
  }
  return combo;
}

}  // namespace

WoundForm::WoundForm(QWidget* parent) : QFrame(parent) {
  setProperty("role", QStringLiteral("well"));
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(12, 12, 12, 12);
  column->setSpacing(10);
  column->addWidget(makeLabel(tr("New wound"), TypeRole::Strong));
  side_ = new QComboBox;
  side_->setProperty("target", QStringLiteral("desk"));
  side_->addItems({sideWord(FootSide::Left), sideWord(FootSide::Right)});
  place_ = makeCombo(kWoundPlaces, placeWord);
  place_->setObjectName(QStringLiteral("place"));
  aspect_ = makeCombo(kWoundAspects, aspectWord);
  cause_ = makeCombo(kAetiologies, aetiologyWord);
  cause_->setCurrentIndex(cause_->count() - 1);  // unknown until somebody says otherwise
  onset_ = new QLineEdit;
  onset_->setProperty("target", QStringLiteral("desk"));
  onset_frame_ = new FieldFrame(tr("Open since"), onset_, tr("A date, or empty"));
  auto* first = new QHBoxLayout;
  first->setSpacing(8);
  first->addWidget(new FieldFrame(tr("Foot"), side_), 2);
  first->addWidget(new FieldFrame(tr("Side of the foot"), aspect_), 3);
  column->addLayout(first);
  column->addWidget(new FieldFrame(tr("Place"), place_));
  auto* second = new QHBoxLayout;
  second->setSpacing(8);
  second->addWidget(new FieldFrame(tr("Cause"), cause_), 1, Qt::AlignTop);
  second->addWidget(onset_frame_, 1, Qt::AlignTop);
  column->addLayout(second);
  auto* buttons = new QHBoxLayout;
  buttons->setSpacing(8);
  QPushButton* cancel = makeButton(tr("Cancel"));
  QPushButton* add = makeButton(tr("Add the wound"), QStringLiteral("primary"));
  add->setObjectName(QStringLiteral("add wound"));
  buttons->addWidget(cancel);
  buttons->addWidget(add, 1);
  column->addLayout(buttons);
  connect(add, &QPushButton::clicked, this, &WoundForm::accept);
  connect(cancel, &QPushButton::clicked, this, &WoundForm::givenUp);
  connect(onset_, &QLineEdit::textEdited, onset_frame_, &FieldFrame::clearError);
  for (QComboBox* combo : {side_, place_}) {
    connect(combo, QOverload<int>::of(&QComboBox::activated), this, [this] {
      emit proposed(side_->currentIndex() == 1 ? FootSide::Right : FootSide::Left,
                    place_->currentData().toString());
    });
  }
}

void WoundForm::propose(FootSide side, const QString& place) {
  side_->setCurrentIndex(side == FootSide::Right ? 1 : 0);
  place_->setCurrentIndex(place_->findData(place));
  onset_frame_->clearError();
}

void WoundForm::accept() {
  const QString text = onset_->text().simplified();
  const QDate onset = typedDate(text);
  if (!text.isEmpty() && (!onset.isValid() || onset > today_)) {
    onset_frame_->setError(onset.isValid() ? tr("This date is still to come.")
                                           : tr("There is no such date."));
    onset_->setFocus();
    return;
  }
  WoundFields fields;
  fields.place = place_->currentData().toString().toStdString();
  fields.aspect = aspect_->currentData().toString().toStdString();
  fields.aetiology = cause_->currentData().toString().toStdString();
  fields.onset = onset.isValid() ? onset.toString(Qt::ISODate).toStdString() : std::string();
  onset_->clear();
  emit accepted(side_->currentIndex() == 1 ? FootSide::Right : FootSide::Left, fields);
}

}  // namespace tarsus
