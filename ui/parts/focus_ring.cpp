#include "ui/parts/focus_ring.h"

#include "ui/look/look.h"

#include <QAbstractButton>
#include <QApplication>
#include <QComboBox>
#include <QEvent>
#include <QLineEdit>
#include <QPainter>
#include <QVariant>

namespace tarsus {
namespace {

constexpr int kReach = 4;  ///< gap and ring

/// Where a window is dressed and filled, many widgets move before the next paint.
bool movesThings(QEvent::Type type) {
  return type == QEvent::Move || type == QEvent::Resize || type == QEvent::Show ||
         type == QEvent::Hide || type == QEvent::LayoutRequest;
}

}  // namespace

FocusRing::FocusRing(QWidget* window) : QWidget(window) {
  setAttribute(Qt::WA_TransparentForMouseEvents);
  setFocusPolicy(Qt::NoFocus);
  hide();
  qApp->installEventFilter(this);
  connect(qApp, &QApplication::focusChanged, this, [this](QWidget*, QWidget* now) { follow(now); });
}

void FocusRing::follow(QWidget* target) {
  const bool is_field = qobject_cast<QLineEdit*>(target) != nullptr;
  const bool is_button = qobject_cast<QAbstractButton*>(target) != nullptr ||
                         qobject_cast<QComboBox*>(target) != nullptr ||
                         (target != nullptr && target->property("ring").toBool());
  const bool ours = target != nullptr && target->window() == parentWidget()->window();
  target_ = ours && (is_field || (is_button && by_keys_)) ? target : nullptr;
  place();
}

void FocusRing::place() {
  if (target_ == nullptr || !target_->isVisible()) {
    hide();
    return;
  }
  const QRect box(target_->mapTo(parentWidget(), QPoint(0, 0)), target_->size());
  const QRect around = box.adjusted(-kReach, -kReach, kReach, kReach);
  QRect seen = parentWidget()->rect();  // a control may be scrolled out of its place
  for (QWidget* each = target_->parentWidget(); each != nullptr && each != parentWidget();
       each = each->parentWidget()) {
    seen &= QRect(each->mapTo(parentWidget(), QPoint(0, 0)), each->size())
                .adjusted(-kReach, -kReach, kReach, kReach);
  }
  seen &= around;
  if (seen.isEmpty()) {
    hide();
    return;
  }
  setGeometry(around);
  setMask(seen.translated(-around.topLeft()));
  raise();
  show();
}

bool FocusRing::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress) {
    by_keys_ = true;
  } else if (event->type() == QEvent::MouseButtonPress) {
    by_keys_ = false;
  } else if (movesThings(event->type()) && watched != this && target_ != nullptr) {
    QMetaObject::invokeMethod(
        this, [this] { place(); }, Qt::QueuedConnection);
  }
  return QWidget::eventFilter(watched, event);
}

void FocusRing::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(Look::theme().accent, 2.0));
  painter.drawRoundedRect(QRectF(rect()).adjusted(1, 1, -1, -1), 8.0, 8.0);
}

}  // namespace tarsus
