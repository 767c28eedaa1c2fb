#pragma once

#include "measurement/records/feet.h"

#include <QWidget>

#include <vector>

namespace tarsus {

/// Both soles with the wounds on them: an open wound is a number, a healed one a tick. Touching a
/// sole elsewhere asks for a wound there. By keys: arrows walk the wounds, Enter picks.
class FootMap : public QWidget {
  Q_OBJECT

 public:
  struct Marker {
    QString id;
    FootSide side = FootSide::Right;
    QString place;
    int number = 1;
    bool healed = false;
    QString words;  ///< for reading aloud
  };

  explicit FootMap(QWidget* parent = nullptr);
  void setMarkers(std::vector<Marker> markers);
  void setSelected(const QString& id);
  /// A ring where a wound is being placed; an empty place takes it away.
  void setProposal(FootSide side, const QString& place);
  void setCanPlace(bool can_place);
  /// Where a marker or a place is painted, in widget coordinates.
  [[nodiscard]] QPointF pointOf(FootSide side, const QString& place) const;

  [[nodiscard]] QSize sizeHint() const override { return {312, 290}; }
  [[nodiscard]] QSize minimumSizeHint() const override { return {240, 230}; }

 signals:
  void placeTouched(tarsus::FootSide side, const QString& place);
  void woundPicked(const QString& id);

 protected:
  void paintEvent(QPaintEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  [[nodiscard]] QRectF soleRect(FootSide side) const;
  void paintMarker(QPainter& painter, const Marker& marker) const;
  void describe();

  std::vector<Marker> markers_;
  QString selected_;
  FootSide proposal_side_ = FootSide::Right;
  QString proposal_;
  bool can_place_ = true;
};

}  // namespace tarsus
