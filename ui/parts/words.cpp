#include "ui/parts/words.h"

#include <QCoreApplication>
#include <QLocale>

#include <cmath>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(Words)
};

constexpr QChar kThinSpace(0x202F);
constexpr QChar kMinus(0x2212);

}  // namespace

QString sideWord(FootSide side) {
  return side == FootSide::Right ? Words::tr("Right") : Words::tr("Left");
}

QString placeWord(const QString& place) {
  const QString number = place.right(1);
  if (place.startsWith(QLatin1String("toe_"))) {
    const QString names[] = {Words::tr("great toe"),
                             Words::tr("2nd toe"),
                             Words::tr("3rd toe"),
                             Words::tr("4th toe"),
                             Words::tr("5th toe")};
    return names[qBound(1, number.toInt(), 5) - 1];
  }
  if (place.startsWith(QLatin1String("mth_"))) {
    const QString names[] = {Words::tr("1st metatarsal head"),
                             Words::tr("2nd metatarsal head"),
                             Words::tr("3rd metatarsal head"),
                             Words::tr("4th metatarsal head"),
                             Words::tr("5th metatarsal head")};
    return names[qBound(1, number.toInt(), 5) - 1];
  }
  return place == QLatin1String("heel") ? Words::tr("heel") : Words::tr("midfoot");
}

QString aspectWord(const QString& aspect) {
  if (aspect == QLatin1String("dorsal")) {
    return Words::tr("top");
  }
  if (aspect == QLatin1String("medial")) {
    return Words::tr("inner side");
  }
  if (aspect == QLatin1String("lateral")) {
    return Words::tr("outer side");
  }
  return aspect == QLatin1String("interdigital") ? Words::tr("between toes") : Words::tr("sole");
}

QString aetiologyWord(const QString& word) {
  const std::pair<const char*, QString> words[] = {
      {"neuropathic", Words::tr("neuropathic")},
      {"ischaemic", Words::tr("ischaemic")},
      {"neuroischaemic", Words::tr("neuroischaemic")},
      {"traumatic", Words::tr("traumatic")},
      {"pressure", Words::tr("pressure")},
      {"postoperative", Words::tr("after surgery")},
  };
  for (const auto& [key, text] : words) {
    if (word == QLatin1String(key)) {
      return text;
    }
  }
  return Words::tr("cause unknown");
}

QString siteShort(FootSide side, const QString& place, const QString& aspect) {
  const QString site =
      Words::tr("%1, %2", "side of body, place").arg(sideWord(side), placeWord(place));
  return aspect == QLatin1String("plantar")
             ? site
             : Words::tr("%1, %2", "site, aspect").arg(site, aspectWord(aspect));
}

QString siteLong(FootSide side, const QString& place, const QString& aspect) {
  return Words::tr("%1, %2, %3", "foot, aspect, place")
      .arg(side == FootSide::Right ? Words::tr("right foot") : Words::tr("left foot"),
           aspectWord(aspect),
           placeWord(place));
}

QString roleWord(Role role) {
  switch (role) {
    case Role::Nurse:
      return Words::tr("Wound nurse");
    case Role::Physician:
      return Words::tr("Physician");
    case Role::Administrator:
      return Words::tr("Administrator");
    case Role::ReadOnly:
      break;
  }
  return Words::tr("May look, not change");
}

QString dayMonth(const QDate& date) {
  return QLocale().toString(date, Words::tr("d MMM", "day and month as a word"));
}

QString dayMonthYear(const QDate& date) {
  return QLocale().toString(date, Words::tr("d MMM yyyy", "day, month as a word, year"));
}

QString areaText(double area_mm2) {
  return QLocale().toString(area_mm2 / 100.0, 'f', 2) + QChar(0x00A0) + QStringLiteral(u"cm²");
}

QString changeText(double ratio) {
  const long percent = std::lround(100.0 * (ratio - 1.0));
  const QString digits = QLocale().toString(static_cast<int>(std::labs(percent)));
  const QString sign = percent < 0   ? QString(kMinus)
                       : percent > 0 ? QStringLiteral("+")
                                     : QString();
  return sign + digits + kThinSpace + QLatin1Char('%');
}

QString sentenceOf(const Error& error) {
  const std::string text(codeSentence(error.code));
  return QCoreApplication::translate("Error", text.c_str());
}

}  // namespace tarsus
