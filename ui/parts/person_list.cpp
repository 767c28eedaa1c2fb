#include "ui/parts/person_list.h"

#include "ui/parts/controls.h"
#include "ui/parts/words.h"

#include <QAbstractButton>
#include <QKeyEvent>
#include <QPainter>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {

/// Initials, name, role, and whether it is the one.
class PersonRow : public QAbstractButton {
 public:
  explicit PersonRow(const Person& person)
      : name_(QString::fromStdString(person.name)), role_(roleWord(person.role)) {
    setCheckable(true);
    setAutoExclusive(true);
    setCursor(Qt::PointingHandCursor);
    setProperty("ring", true);
    setText(name_);
    setAccessibleName(PersonList::tr("Sign in as %1, %2").arg(name_, role_));
    Look::setFixedHeight(this, 64);
  }
  [[nodiscard]] QString name() const { return name_; }

 protected:
  void keyPressEvent(QKeyEvent* event) override {
    if (event->key() == Qt::Key_Up || event->key() == Qt::Key_Down) {
      event->ignore();  // the list walks
      return;
    }
    QAbstractButton::keyPressEvent(event);
  }
  void paintEvent(QPaintEvent*) override {
    const Theme& theme = Look::theme();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    const double edge = isChecked() ? 2.0 : 1.0;
    painter.setPen(QPen(isChecked() ? theme.accent : theme.line, edge));
    painter.setBrush(theme.surface);
    painter.drawRoundedRect(QRectF(rect()).adjusted(1, 1, -1, -1), 6.0, 6.0);
    const double disc = Look::px(40);
    const QRectF initials(Look::px(16), (height() - disc) / 2.0, disc, disc);
    painter.setPen(Qt::NoPen);
    painter.setBrush(theme.accent_weak);
    painter.drawEllipse(initials);
    painter.setPen(theme.accent_text);
    painter.setFont(Look::font(TypeRole::Strong));
    painter.drawText(initials, Qt::AlignCenter, initialsOf(name_));
    paintWords(painter, initials.right() + Look::px(12));
    paintDot(painter);
  }

 private:
  void paintWords(QPainter& painter, double left) const {
    const Theme& theme = Look::theme();
    const double width_px = width() - left - Look::px(52);
    painter.setPen(theme.text);
    painter.setFont(Look::font(TypeRole::Strong));
    const QFontMetrics metrics(painter.font());
    painter.drawText(QRectF(left, 0, width_px, height() / 2.0 + 1),
                     Qt::AlignLeft | Qt::AlignBottom,
                     metrics.elidedText(name_, Qt::ElideRight, static_cast<int>(width_px)));
    painter.setPen(theme.text_secondary);
    painter.setFont(Look::font(TypeRole::Small));
    painter.drawText(QRectF(left, height() / 2.0 + 1, width_px, height() / 2.0),
                     Qt::AlignLeft | Qt::AlignTop,
                     role_);
  }
  void paintDot(QPainter& painter) const {
    const Theme& theme = Look::theme();
    const double radius = Look::px(10);
    const QPointF at(width() - Look::px(27), height() / 2.0);
    painter.setPen(QPen(isChecked() ? theme.accent : theme.control_edge, theme.edge_px));
    painter.setBrush(isChecked() ? theme.accent : theme.surface);
    painter.drawEllipse(at, radius, radius);
    if (isChecked()) {
      painter.setPen(Qt::NoPen);
      painter.setBrush(theme.on_accent);
      painter.drawEllipse(at, 0.42 * radius, 0.42 * radius);
    }
  }

  QString name_;
  QString role_;
};

PersonList::PersonList(QWidget* parent) : QWidget(parent) {
  column_ = new QVBoxLayout(this);
  column_->setContentsMargins(0, 0, 0, 0);
  column_->setSpacing(8);
}

void PersonList::setPeople(const std::vector<Person>& people) {
  const QString before = currentName();
  for (PersonRow* row : rows_) {
    row->deleteLater();
    column_->removeWidget(row);
    row->hide();
  }
  rows_.clear();
  current_ = -1;
  int kept = 0;
  for (const Person& person : people) {
    auto* row = new PersonRow(person);
    const int index = static_cast<int>(rows_.size());
    if (row->name() == before) {
      kept = index;
    }
    connect(row, &QAbstractButton::clicked, this, [this, index] {
      setCurrent(index);
      emit chosen();
    });
    column_->addWidget(row);
    rows_.push_back(row);
  }
  if (!rows_.empty()) {
    setCurrent(kept);
  }
}

void PersonList::setCurrent(int index) {
  current_ = index;
  rows_.at(static_cast<std::size_t>(index))->setChecked(true);
}

QString PersonList::currentName() const {
  return current_ < 0 ? QString() : rows_.at(static_cast<std::size_t>(current_))->name();
}

void PersonList::keyPressEvent(QKeyEvent* event) {
  const int step = event->key() == Qt::Key_Down ? 1 : event->key() == Qt::Key_Up ? -1 : 0;
  const int next = current_ + step;
  if (step == 0 || next < 0 || next >= static_cast<int>(rows_.size())) {
    QWidget::keyPressEvent(event);
    return;
  }
  setCurrent(next);
  rows_.at(static_cast<std::size_t>(next))->setFocus(Qt::TabFocusReason);
}

}  // namespace tarsus
