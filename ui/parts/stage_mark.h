#pragma once

#include <QWidget>

namespace tarsus {

/// A small disc: to come (ring), at work (part of a ring), done (tick), looked at (clock), of care
/// (triangle), refused (cross).
class StageMark : public QWidget {
  Q_OBJECT

 public:
  enum class Kind { ToCome, Running, Done, Checked, Waiting, Care, Refused };
  explicit StageMark(QWidget* parent = nullptr);
  void setKind(Kind kind);
  /// Of the running one, 0 to 1.
  void setFraction(double fraction);
  [[nodiscard]] QSize sizeHint() const override;
  [[nodiscard]] QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Kind kind_ = Kind::ToCome;
  double fraction_ = 0.25;
};

}  // namespace tarsus
