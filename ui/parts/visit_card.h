#pragma once

#include "ui/work/patient_summary.h"

#include <QAbstractButton>

namespace tarsus {

/// One visit of the strip: its picture, day, area, what changed since the start, week, state.
class VisitCard : public QAbstractButton {
  Q_OBJECT

 public:
  VisitCard(const VisitSummary& visit, const VisitSummary& baseline, QWidget* parent = nullptr);
  /// A picture of the wound, in place of the grey one.
  void setPicture(const QImage& picture);
  [[nodiscard]] QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintPicture(QPainter& painter, const QRectF& box) const;

  VisitSummary visit_;
  bool is_baseline_;
  QString change_;
  QString week_;
  QImage picture_;
};

}  // namespace tarsus
