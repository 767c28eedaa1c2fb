#include "ui/parts/note.h"

#include "ui/parts/controls.h"
#include "ui/parts/icon_label.h"

#include <QHBoxLayout>
#include <QVariant>

namespace tarsus {

Note::Note(Kind kind, QWidget* parent) : QFrame(parent) {
  const bool danger = kind == Kind::Danger;
  setProperty("note", danger ? QStringLiteral("danger") : QStringLiteral("warning"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(14, 12, 14, 12);
  row->setSpacing(10);
  row->addWidget(new IconLabel(QStringLiteral("warning"), danger ? Tone::Danger : Tone::Warning));
  what_ = makeLabel({}, TypeRole::Base);
  what_->setTextFormat(Qt::RichText);
  row->addWidget(what_, 1);
  hide();
}

void Note::setText(const QString& what, const QString& then) {
  what_->setText(QStringLiteral("<b>%1</b> %2").arg(what.toHtmlEscaped(), then.toHtmlEscaped()));
  setAccessibleName(what + QLatin1Char(' ') + then);
  setVisible(!what.isEmpty() || !then.isEmpty());
}

QString Note::text() const { return isHidden() ? QString() : accessibleName(); }

}  // namespace tarsus
