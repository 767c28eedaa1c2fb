#include "ui/work/patient_list.h"

#include "measurement/records/users.h"
#include "ui/parts/chip.h"
#include "ui/parts/words.h"

#include <QCoreApplication>

#include <algorithm>

namespace tarsus {
namespace {

class Words {
  Q_DECLARE_TR_FUNCTIONS(PatientList)
};

/// The wound that was seen last; one without visits where no other has any.
const WoundSummary* lastSeen(const PatientSummary& summary) {
  const auto key = [](const WoundSummary& wound) {
    return wound.visits.empty() ? QDate(1, 1, 1) : wound.visits.back().date;
  };
  const auto found = std::ranges::max_element(summary.wounds, {}, key);
  return found == summary.wounds.end() ? nullptr : &*found;
}

QString bornAndNumber(const PatientFields& fields) {
  const QDate born = dateOf(fields.birth_date);
  QStringList parts;
  if (born.isValid()) {
    parts << dayMonthYear(born);
  }
  if (!fields.identifier.empty()) {
    parts << Words::tr("No. %1").arg(QString::fromStdString(fields.identifier));
  }
  return parts.join(QStringLiteral("   "));
}

QString siteOf(const PatientSummary& summary, const WoundSummary& wound) {
  const QString site = siteShort(wound.side,
                                 QString::fromStdString(wound.fields.place),
                                 QString::fromStdString(wound.fields.aspect));
  const auto count = static_cast<int>(summary.wounds.size());
  return count > 1 ? Words::tr("%1 (%n wounds)", nullptr, count).arg(site) : site;
}

QString spokenOf(const PatientRow& row) {
  QStringList parts{row.name, row.born_and_number.simplified()};
  if (!row.site.isEmpty()) {
    parts << row.site;
  }
  if (row.last_visit.isValid()) {
    parts << Words::tr("last visit %1").arg(dayMonth(row.last_visit));
  }
  if (row.area_mm2) {
    parts << areaText(*row.area_mm2);
  }
  if (row.state) {
    parts << chipOf(*row.state).text;
  }
  return parts.join(QStringLiteral(", "));
}

/// "S. Lindqvist"
QString shortName(const QString& name) {
  const QStringList words = name.split(QLatin1Char(' '), Qt::SkipEmptyParts);
  return words.size() < 2
             ? name
             : words.at(words.size() - 2).left(1) + QStringLiteral(". ") + words.last();
}

ReviewItem itemOf(Store& store, const PatientSummary& summary, const Visit& visit) {
  ReviewItem item{.visit_id = QString::fromStdString(visit.id),
                  .patient_id = QString::fromStdString(summary.patient.id),
                  .patient = fullName(summary.patient.fields)};
  const auto author = findUser(store, visit.signed_by);
  const QString day = dayMonth(dateAt(visit.content.taken_at_ms));
  item.taken = author ? Words::tr("%1, %2", "date, name")
                            .arg(day, shortName(QString::fromStdString(author->name)))
                      : day;
  for (const WoundSummary& wound : summary.wounds) {
    const auto at = std::ranges::find(wound.visits, visit.id, &VisitSummary::id);
    if (at == wound.visits.end()) {
      continue;
    }
    item.site = siteShort(wound.side,
                          QString::fromStdString(wound.fields.place),
                          QString::fromStdString(wound.fields.aspect));
    item.area_mm2 = at->area_mm2;
    if (at != wound.visits.begin()) {
      item.change = changeInWords(*(at - 1), *at);
    }
  }
  return item;
}

}  // namespace

Expected<std::vector<PatientKey>> patientKeys(Store& store) {
  if (auto who = store.who(Permission::Read); !who) {
    return tl::unexpected(who.error());
  }
  // All of it stands in clear: nothing has to be decrypted to sort ten thousand patients.
  const auto rows = store.database().query(
      "SELECT p.id, MAX(COALESCE(t.at_ms, 0)) AS last_at, "
      "MAX(CASE WHEN v.state = 'draft' THEN 1 ELSE 0 END) AS draft, "
      "MAX(COALESCE(v.entry, p.entry)) AS last_entry "
      "FROM records p "
      "LEFT JOIN records f ON f.parent = p.id AND f.kind = 'foot' AND f.trashed = 0 "
      "LEFT JOIN records w ON w.parent = f.id AND w.kind = 'wound' AND w.trashed = 0 "
      "LEFT JOIN records v ON v.parent = w.id AND v.kind = 'visit' AND v.trashed = 0 "
      "LEFT JOIN revisions t ON t.record = v.id AND t.revision = v.revision "
      "WHERE p.kind = 'patient' AND p.parent = '' AND p.trashed = 0 AND p.state <> 'erased' "
      "GROUP BY p.id ORDER BY last_entry DESC");
  if (!rows) {
    return tl::unexpected(rows.error());
  }
  std::vector<PatientKey> keys;
  keys.reserve(rows->size());
  for (const SqlRow& row : *rows) {
    keys.push_back(
        {.id = row.text(0), .last_at_ms = row.integer(1), .has_draft = row.integer(2) != 0});
  }
  return keys;
}

Expected<std::vector<std::string>> matchingPatients(Store& store, const std::string& query) {
  // One patient only is decrypted: the search is asked to bring the index up to date.
  if (const auto fresh = searchPatients(store, query, 1); !fresh) {
    return tl::unexpected(fresh.error());
  }
  return store.nameIndex().find(query, std::size_t{1} << 30);
}

Expected<PatientRow> patientRow(Store& store, const std::string& id) {
  const auto summary = patientSummary(store, id);
  if (!summary) {
    return tl::unexpected(summary.error());
  }
  PatientRow row{.id = QString::fromStdString(id),
                 .name = fullName(summary->patient.fields),
                 .born_and_number = bornAndNumber(summary->patient.fields)};
  if (const WoundSummary* wound = lastSeen(*summary); wound != nullptr) {
    row.site = siteOf(*summary, *wound);
    row.side = wound->side;
    row.place = QString::fromStdString(wound->fields.place);
    row.healed = wound->healed();
    for (const VisitSummary& visit : wound->visits) {
      if (visit.area_mm2) {
        row.areas_mm2.push_back(*visit.area_mm2);
      }
    }
    if (!wound->visits.empty()) {
      row.last_visit = wound->visits.back().date;
      row.state = wound->visits.back().state;
      row.area_mm2 = wound->visits.back().area_mm2;
    }
  }
  row.spoken = spokenOf(row);
  return row;
}

Expected<std::vector<ReviewItem>> reviewItems(Store& store) {
  const auto visits = visitsToReview(store);
  if (!visits) {
    return tl::unexpected(visits.error());
  }
  std::vector<ReviewItem> items;
  for (const Visit& visit : *visits) {
    const auto patient = patientOf(store, visit);
    if (!patient) {
      return tl::unexpected(patient.error());
    }
    const auto summary = patientSummary(store, *patient);
    if (!summary) {
      return tl::unexpected(summary.error());
    }
    items.push_back(itemOf(store, *summary, visit));
  }
  return items;
}

}  // namespace tarsus
