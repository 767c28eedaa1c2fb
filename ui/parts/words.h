#pragma once

#include "measurement/records/feet.h"
#include "measurement/records/roles.h"
#include "reconstruction/base/error.h"

#include <QDate>
#include <QString>

namespace tarsus {

// The words of records as they are shown, in the language of the window.

[[nodiscard]] QString sideWord(FootSide side);             ///< Right
[[nodiscard]] QString placeWord(const QString& place);     ///< 2nd metatarsal head
[[nodiscard]] QString aspectWord(const QString& aspect);   ///< sole
[[nodiscard]] QString aetiologyWord(const QString& word);  ///< neuropathic
/// "Right, 2nd metatarsal head"; the aspect is said where it is not the sole.
[[nodiscard]] QString siteShort(FootSide side, const QString& place, const QString& aspect);
/// "right foot, sole, 2nd metatarsal head"
[[nodiscard]] QString siteLong(FootSide side, const QString& place, const QString& aspect);
[[nodiscard]] QString roleWord(Role role);

[[nodiscard]] QString dayMonth(const QDate& date);      ///< 16 Nov
[[nodiscard]] QString dayMonthYear(const QDate& date);  ///< 16 Nov 2026
/// "3.63 cm²" of square millimetres.
[[nodiscard]] QString areaText(double area_mm2);
/// "−54 %" or "+3 %", of a ratio 0.46 or 1.03.
[[nodiscard]] QString changeText(double ratio);
/// What happened and what to do, of an error.
[[nodiscard]] QString sentenceOf(const Error& error);

}  // namespace tarsus
