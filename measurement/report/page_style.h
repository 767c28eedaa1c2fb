#pragma once

#include <QColor>
#include <QString>

namespace tarsus {

/// A4 upright [mm]: left 18 for punch holes, right 14; the content box ends where the footer
/// begins. US Letter is wider, which is not used, and 17.6 mm less high.
namespace page {
inline constexpr double kWidth = 210.0;
inline constexpr double kHeight = 297.0;
inline constexpr double kLeft = 18.0;
inline constexpr double kRight = 196.0;
inline constexpr double kTop = 11.0;
inline constexpr double kLetterHeight = 279.4;
inline constexpr double kFooter = 19.2;      ///< from its rule to the edge of the paper
inline constexpr double kAboveFooter = 3.3;  ///< free between content and footer
inline constexpr double kContentWidth = kRight - kLeft;
inline constexpr double kSectionGap = 3.6;
}  // namespace page

namespace ink {
inline const QColor kBlack{0x1B, 0x24, 0x30};
inline const QColor kGrey{0x5B, 0x66, 0x75};
inline const QColor kFaint{0x7A, 0x85, 0x92};  ///< the lightest grey that text may take
inline const QColor kRule{0xC9, 0xCF, 0xD6};
inline const QColor kFill{0xF1, 0xF3, 0xF5};
inline const QColor kTeal{0x0B, 0x7A, 0x75};
inline const QColor kOutline{0x00, 0xB8, 0xD9};
inline const QColor kHalo{0x06, 0x14, 0x1C};
inline const QColor kGrid{0xD5, 0xDB, 0xE1};
inline const QColor kAmber{0xB8, 0x6E, 0x14};  ///< published marks alone
inline const QColor kToday{0x87, 0x96, 0xA8};  ///< fill of today's outline and of granulation
}  // namespace ink

/// Noto Sans at a size and line height in points.
struct TextStyle {
  double size_pt = 9.0;
  double line_pt = 11.5;
  bool bold = false;
  QColor color = ink::kBlack;
  bool underlined = false;
  bool struck = false;  ///< an earlier value that an amendment replaced

  [[nodiscard]] TextStyle in(const QColor& other) const {
    TextStyle style = *this;
    style.color = other;
    return style;
  }
  [[nodiscard]] TextStyle asBold() const {
    TextStyle style = *this;
    style.bold = true;
    return style;
  }
  [[nodiscard]] TextStyle asUnderlined() const {
    TextStyle style = *this;
    style.underlined = true;
    return style;
  }
  [[nodiscard]] TextStyle asStruck() const {
    TextStyle style = *this;
    style.struck = true;
    return style;
  }
};

struct TextRun {
  QString text;
  TextStyle style;
};

namespace type {
inline const TextStyle kTitle{13, 16, true, ink::kBlack};
inline const TextStyle kHead{10, 12, true, ink::kBlack};
inline const TextStyle kWound{10.5, 13, true, ink::kBlack};
inline const TextStyle kKeyValue{24, 29, true, ink::kBlack};
inline const TextStyle kKeyUnit{10.5, 29, false, ink::kBlack};
inline const TextStyle kWords{10, 13.5, false, ink::kBlack};
inline const TextStyle kToday{10, 11.5, true, ink::kBlack};
inline const TextStyle kCell{9, 11.5, false, ink::kBlack};
inline const TextStyle kInterval{8, 11.5, false, ink::kGrey};
inline const TextStyle kCaption{7.5, 10, false, ink::kBlack};
inline const TextStyle kSmall{7, 9, false, ink::kGrey};  ///< the smallest allowed
}  // namespace type

}  // namespace tarsus
