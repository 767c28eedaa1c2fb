#pragma once

#include <QRectF>
#include <QWidget>

#include <optional>
#include <vector>

class QPainter;

namespace tarsus {

/// Area of a wound over the weeks with its 95 % ranges.
struct AreaPoint {
  double weeks = 0.0;
  double area_mm2 = 0.0;
  std::optional<double> low_mm2;
  std::optional<double> high_mm2;
  bool draft = false;  ///< not yet signed: an open disc would say settled, so it is filled
};

/// A line of list size, ending in a dot; from the least to the greatest area, at least half of it.
void paintSparkline(QPainter& painter, const QRectF& box, const std::vector<double>& areas_mm2);

/// The same as a chart with axes; a plain line until the comparison's charts stand.
class AreaChart : public QWidget {
  Q_OBJECT

 public:
  explicit AreaChart(QWidget* parent = nullptr);
  void setPoints(std::vector<AreaPoint> points);
  [[nodiscard]] QSize minimumSizeHint() const override { return {240, 180}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  std::vector<AreaPoint> points_;
};

}  // namespace tarsus
