#include "ui/screens/form_words.h"

#include "measurement/records/visit_fields.h"

#include <QCoreApplication>
#include <QHash>
#include <QLocale>
#include <QStringList>

#include <algorithm>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(VisitForm)
};

using nlohmann::json;

QString numberText(double value) { return QLocale().toString(value, 'g', 6); }

QString rangesText(const json& ranges) {
  QStringList parts;
  for (const json& range : ranges) {
    parts << Words::tr("%1 to %2 o'clock, %3 mm")
                 .arg(numberText(range.value("from_clock", 0.0)),
                      numberText(range.value("to_clock", 0.0)),
                      numberText(range.value("depth_mm", 0.0)));
  }
  return parts.isEmpty() ? Words::tr("none") : parts.join(QStringLiteral("; "));
}

}  // namespace

const std::vector<FormSection>& formSections() {
  static const std::vector<FormSection> sections{
      {"circulation",
       {{"pulse_dorsalis_pedis"},
        {"pulse_tibialis_posterior"},
        {"abi", "toe_pressure_mmhg", "hba1c_percent"}}},
      {"sensation", {{"monofilament_felt_of_10"}}},
      {"infection",
       {{"infection_swelling_or_induration",
         "infection_tenderness_or_pain",
         "infection_warmth",
         "infection_pus"},
        {"infection_erythema_cm"},
        {"probe_to_bone"}}},
      {"bed",
       {{"exudate_amount"},
        {"exudate_type"},
        {"exudate_odour", "debridement"},
        {"edge"},
        {"callus"},
        {"periwound"},
        {"undermining"},
        {"tunnels"}}},
      {"pain", {{"pain_of_10"}}},
      {"offloading", {{"offloading"}, {"offloading_adherence"}}},
      {"dressing", {{"dressing"}}},
      {"hand", {{"ruler_length_mm", "ruler_width_mm", "probe_depth_mm"}}},
      {"notes", {{"notes"}, {"plan"}}}};
  return sections;
}

QString sectionWord(const QString& id) {
  const QHash<QString, QString> words{
      {QStringLiteral("circulation"), Words::tr("Circulation")},
      {QStringLiteral("sensation"), Words::tr("Sensation")},
      {QStringLiteral("infection"), Words::tr("Signs of infection")},
      {QStringLiteral("bed"), Words::tr("Wound bed and edge")},
      {QStringLiteral("pain"), Words::tr("Pain")},
      {QStringLiteral("offloading"), Words::tr("Offloading")},
      {QStringLiteral("dressing"), Words::tr("Dressing")},
      {QStringLiteral("hand"), Words::tr("Ruler and probe")},
      {QStringLiteral("notes"), Words::tr("Notes")}};
  return words.value(id, id);
}

QString fieldWord(const QString& name) {
  const QHash<QString, QString> words{
      {QStringLiteral("pulse_dorsalis_pedis"), Words::tr("Pulse on the top of the foot")},
      {QStringLiteral("pulse_tibialis_posterior"), Words::tr("Pulse behind the inner ankle")},
      {QStringLiteral("abi"), Words::tr("Ankle-brachial index")},
      {QStringLiteral("toe_pressure_mmhg"), Words::tr("Toe pressure")},
      {QStringLiteral("hba1c_percent"), Words::tr("HbA1c")},
      {QStringLiteral("monofilament_felt_of_10"), Words::tr("Monofilament, points felt")},
      {QStringLiteral("probe_to_bone"), Words::tr("Probe to bone")},
      {QStringLiteral("infection_swelling_or_induration"), Words::tr("Swelling or hard skin")},
      {QStringLiteral("infection_erythema_cm"), Words::tr("Redness, width")},
      {QStringLiteral("infection_tenderness_or_pain"), Words::tr("Tenderness or pain")},
      {QStringLiteral("infection_warmth"), Words::tr("Warmth")},
      {QStringLiteral("infection_pus"), Words::tr("Pus")},
      {QStringLiteral("exudate_amount"), Words::tr("Amount of fluid")},
      {QStringLiteral("exudate_type"), Words::tr("Kind of fluid")},
      {QStringLiteral("exudate_odour"), Words::tr("Smell")},
      {QStringLiteral("edge"), Words::tr("Edge")},
      {QStringLiteral("callus"), Words::tr("Callus")},
      {QStringLiteral("periwound"), Words::tr("Skin around the wound")},
      {QStringLiteral("pain_of_10"), Words::tr("Pain now, 0 to 10")},
      {QStringLiteral("debridement"), Words::tr("Debridement")},
      {QStringLiteral("offloading"), Words::tr("Offloading device")},
      {QStringLiteral("offloading_adherence"), Words::tr("Worn")},
      {QStringLiteral("dressing"), Words::tr("Dressing")},
      {QStringLiteral("ruler_length_mm"), Words::tr("Length by ruler")},
      {QStringLiteral("ruler_width_mm"), Words::tr("Width by ruler")},
      {QStringLiteral("probe_depth_mm"), Words::tr("Depth by probe")},
      {QStringLiteral("undermining"), Words::tr("Undermining")},
      {QStringLiteral("tunnels"), Words::tr("Tunnels")},
      {QStringLiteral("notes"), Words::tr("Notes")},
      {QStringLiteral("plan"), Words::tr("Plan")}};
  return words.value(name, name);
}

QString choiceWord(const QString& name, const QString& word) {
  // By field where a word means something of its own there.
  const QHash<QString, QString> words{
      {QStringLiteral("present"), Words::tr("Felt", "pulse")},
      {QStringLiteral("weak"), Words::tr("Weak", "pulse")},
      {QStringLiteral("absent"), Words::tr("Not felt", "pulse")},
      {QStringLiteral("positive"), Words::tr("Bone felt")},
      {QStringLiteral("negative"), Words::tr("Bone not felt")},
      {QStringLiteral("none"), Words::tr("None")},
      {QStringLiteral("light"), Words::tr("Little")},
      {QStringLiteral("moderate"), Words::tr("Moderate")},
      {QStringLiteral("heavy"), Words::tr("Much")},
      {QStringLiteral("serous"), Words::tr("Clear")},
      {QStringLiteral("sanguineous"), Words::tr("Bloody")},
      {QStringLiteral("serosanguineous"), Words::tr("Clear and bloody")},
      {QStringLiteral("purulent"), Words::tr("Pus")},
      {QStringLiteral("faint"), Words::tr("Some", "smell")},
      {QStringLiteral("strong"), Words::tr("Strong", "smell")},
      {QStringLiteral("flat"), Words::tr("Flat")},
      {QStringLiteral("sloping"), Words::tr("Sloping")},
      {QStringLiteral("punched_out"), Words::tr("Punched out")},
      {QStringLiteral("rolled"), Words::tr("Rolled")},
      {QStringLiteral("undermined"), Words::tr("Undermined")},
      {QStringLiteral("thick"), Words::tr("Thick")},
      {QStringLiteral("healthy"), Words::tr("Healthy")},
      {QStringLiteral("red"), Words::tr("Red")},
      {QStringLiteral("macerated"), Words::tr("Soaked")},
      {QStringLiteral("dry"), Words::tr("Dry")},
      {QStringLiteral("eczema"), Words::tr("Eczema")},
      {QStringLiteral("swollen"), Words::tr("Swollen")},
      {QStringLiteral("before_scan"), Words::tr("Before scan")},
      {QStringLiteral("after_scan"), Words::tr("After scan")},
      {QStringLiteral("always"), Words::tr("Always")},
      {QStringLiteral("mostly"), Words::tr("Mostly")},
      {QStringLiteral("sometimes"), Words::tr("Sometimes")},
      {QStringLiteral("never"), Words::tr("Never")}};
  if (name == QLatin1String("callus") && word == QLatin1String("light")) {
    return Words::tr("Thin");
  }
  return words.value(word, word);
}

QString unitWord(const QString& name) {
  const QHash<QString, QString> words{
      {QStringLiteral("toe_pressure_mmhg"), QStringLiteral("mmHg")},
      {QStringLiteral("hba1c_percent"), QStringLiteral("%")},
      {QStringLiteral("monofilament_felt_of_10"), Words::tr("of 10")},
      {QStringLiteral("infection_erythema_cm"), QStringLiteral("cm")},
      {QStringLiteral("pain_of_10"), Words::tr("of 10")},
      {QStringLiteral("ruler_length_mm"), QStringLiteral("mm")},
      {QStringLiteral("ruler_width_mm"), QStringLiteral("mm")},
      {QStringLiteral("probe_depth_mm"), QStringLiteral("mm")}};
  return words.value(name);
}

QString valueWord(const QString& name, const json& value) {
  if (value.is_boolean()) {
    return value.get<bool>() ? Words::tr("yes") : Words::tr("no");
  }
  if (value.is_number()) {
    const QString unit = unitWord(name);
    const QString number = numberText(value.get<double>());
    return unit.isEmpty() ? number : number + QChar(0x00A0) + unit;
  }
  if (value.is_array()) {
    return rangesText(value);
  }
  if (!value.is_string()) {
    return {};
  }
  const QString text = QString::fromStdString(value.get<std::string>());
  for (const VisitField& field : visitFields()) {
    if (name == QLatin1String(field.name.data(), static_cast<int>(field.name.size())) &&
        field.type == FieldType::Words) {
      QString word = choiceWord(name, text);
      return word.isEmpty() ? word : word.at(0).toLower() + word.mid(1);
    }
  }
  return text;
}

bool isAskedAnew(std::string_view name) {
  return name.starts_with("infection_") || name == "probe_to_bone" || name == "pain_of_10";
}

}  // namespace tarsus
