#include "ui/parts/field_frame.h"

#include "ui/parts/controls.h"
#include "ui/parts/icon_label.h"

#include <QHBoxLayout>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {

FieldFrame::FieldFrame(const QString& label, QWidget* field, const QString& hint)
    : field_(field), hint_(hint) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  QLabel* name = makeLabel(label, TypeRole::Label);
  name->setBuddy(field);
  layout->addWidget(name);
  layout->addWidget(field);
  below_ = new QWidget;
  auto* row = new QHBoxLayout(below_);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(4);
  sign_ = new IconLabel(QStringLiteral("warning"), Tone::Danger, 16);
  row->addWidget(sign_, 0, Qt::AlignTop);
  text_ = makeLabel({}, TypeRole::Small);
  row->addWidget(text_, 1);
  layout->addWidget(below_);
  field->setAccessibleName(label);
  Look::setType(field, TypeRole::Base);
  showBelow();
}

void FieldFrame::setError(const QString& error) {
  error_ = error;
  showBelow();
}

void FieldFrame::setHint(const QString& hint) {
  hint_ = hint;
  showBelow();
}

void FieldFrame::showBelow() {
  const bool wrong = !error_.isEmpty();
  const QString text = wrong ? error_ : hint_;
  text_->setText(text);
  Look::setType(text_, wrong ? TypeRole::Chip : TypeRole::Small);
  setStyleProperty(text_, "tone", wrong ? QStringLiteral("danger") : QStringLiteral("secondary"));
  setStyleProperty(field_, "state", wrong ? QStringLiteral("error") : QString());
  field_->setAccessibleDescription(text);
  sign_->setVisible(wrong);
  below_->setVisible(!text.isEmpty());
}

}  // namespace tarsus
