#pragma once

#include "measurement/records/feet.h"

#include <QPainterPath>
#include <QRectF>
#include <QString>

class QPainter;

namespace tarsus {

/// The sole of a foot as it is seen from below with the toes up, fitted into a box (its sides are
/// 163 : 435). The great toe is at the right of the right foot.
[[nodiscard]] QPainterPath solePath(FootSide side, const QRectF& box);
/// Greatest rectangle of the sole's sides inside a box, in its middle.
[[nodiscard]] QRectF soleBox(const QRectF& box);

/// The place (wounds.h) that a point of the sole lies in.
/// @param at  in the box of solePath, 0 to 1
[[nodiscard]] QString placeAt(FootSide side, const QPointF& at);
/// Where the middle of a place lies, 0 to 1; the middle of the sole for a word that is none.
[[nodiscard]] QPointF middleOf(FootSide side, const QString& place);

/// A sole of list size with a dot where the wound is: filled while open, a ring when healed.
void paintMiniFoot(
    QPainter& painter, const QRectF& box, FootSide side, const QString& place, bool healed);

}  // namespace tarsus
