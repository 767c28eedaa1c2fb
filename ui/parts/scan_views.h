#pragma once

#include <QImage>
#include <QRectF>
#include <QWidget>

#include <optional>

namespace tarsus {

/// A live picture with its name on it; without a picture it says what is missing.
class LivePicture : public QWidget {
  Q_OBJECT

 public:
  enum class Kind { Color, Depth };
  explicit LivePicture(Kind kind, QWidget* parent = nullptr);
  /// Null: none.
  void setPicture(const QImage& picture);
  /// What stands there without a picture.
  void setEmpty(const QString& icon, const QString& text);
  /// Of the depth's scale [cm].
  void setRange(double near_cm, double far_cm);
  [[nodiscard]] QSize sizeHint() const override { return {320, 240}; }
  [[nodiscard]] QSize minimumSizeHint() const override { return {200, 130}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  void paintScale(QPainter& painter) const;

  Kind kind_;
  QImage picture_;
  QString icon_;
  QString text_;
  double near_cm_ = 0.0;
  double far_cm_ = 0.0;
};

/// The growing foot with what to do now on top, where to point when tracking is lost, and the
/// legend.
class GrowingView : public QWidget {
  Q_OBJECT

 public:
  explicit GrowingView(QWidget* parent = nullptr);
  void setFoot(const QImage& foot);
  /// Empty: none.
  void setOrder(const QString& icon, const QString& words);
  /// What happened and what to do, across the top; empty: all is well.
  void setTrouble(const QString& title, const QString& text);
  /// In parts of the foot's picture.
  void setAim(const QRectF& aim);
  void setEmpty(const QString& title, const QString& text);
  [[nodiscard]] QString order() const { return order_; }
  [[nodiscard]] QString trouble() const { return trouble_; }
  [[nodiscard]] bool hasFoot() const { return !foot_.isNull(); }
  [[nodiscard]] QSize minimumSizeHint() const override { return {320, 360}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  [[nodiscard]] int paintTrouble(QPainter& painter) const;
  void paintOrder(QPainter& painter, int top) const;
  void paintLegend(QPainter& painter) const;
  void describe();

  QImage foot_;
  QString icon_;
  QString order_;
  QString trouble_;
  QString what_to_do_;
  QString empty_title_;
  QString empty_text_;
  QRectF aim_;
};

/// How far the camera is from the foot, 20 to 60 cm, with the band that it must keep.
class DistanceGauge : public QWidget {
  Q_OBJECT

 public:
  explicit DistanceGauge(QWidget* parent = nullptr);
  /// Empty: nothing is in the middle of the picture.
  void setDistance(std::optional<double> mm);
  [[nodiscard]] QString words() const;
  [[nodiscard]] QSize sizeHint() const override;
  [[nodiscard]] QSize minimumSizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::optional<double> mm_;
};

}  // namespace tarsus
