#pragma once

#include <QByteArray>
#include <QString>

#include <string>

namespace tarsus {

/// The metadata packet of PDF/A-1b, with the same facts as the document's own information.
/// @param created  ISO 8601; without a time in it the packet states none
[[nodiscard]] QByteArray xmpMetadata(const QString& title,
                                     const QString& creator,
                                     const std::string& created);

/// Makes a PDF that Qt wrote depend on its content alone, whatever the clock, time zone or user:
/// its creation date becomes `created` (or is left out where that is not ISO 8601), its identifier
/// a hash of the rest, and the table of offsets is mended.
[[nodiscard]] QByteArray withFixedDates(QByteArray pdf, const std::string& created);

}  // namespace tarsus
