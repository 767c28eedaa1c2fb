#include "ui/screens/patient_list_model.h"

#include "ui/work/session.h"

#include <QDateTime>

#include <algorithm>

namespace tarsus {

PatientListModel::PatientListModel(Session& session, QObject* parent)
    : QAbstractListModel(parent), session_(session) {
  fetch_.setSingleShot(true);
  fetch_.setInterval(0);
  connect(&fetch_, &QTimer::timeout, this, &PatientListModel::fetch);
}

void PatientListModel::reload() {
  today_ms_ =
      QDateTime::fromMSecsSinceEpoch(session_.nowMs()).date().startOfDay().toMSecsSinceEpoch();
  session_.ask<std::vector<PatientKey>>(
      Session::Kind::Read, this, patientKeys, [this](Expected<std::vector<PatientKey>> keys) {
        if (!keys) {
          emit failed(keys.error());
          return;
        }
        keys_ = std::move(*keys);
        rows_.clear();
        wanted_.clear();
        loaded_ = true;
        search();
      });
}

void PatientListModel::clear() {
  ++round_;
  beginResetModel();
  keys_.clear();
  shown_.clear();
  rows_.clear();
  wanted_.clear();
  matching_.clear();
  matched_query_.clear();
  query_.clear();
  loaded_ = false;
  endResetModel();
}

void PatientListModel::setQuery(const QString& query) {
  query_ = query.simplified();
  search();
}

void PatientListModel::setFilter(PatientFilter filter) {
  filter_ = filter;
  show();
}

void PatientListModel::search() {
  const int round = ++round_;
  if (query_.isEmpty()) {
    matched_query_.clear();
    show();
    return;
  }
  session_.ask<std::vector<std::string>>(
      Session::Kind::Read,
      this,
      [query = query_.toStdString()](Store& store) { return matchingPatients(store, query); },
      [this, round, query = query_](const Expected<std::vector<std::string>>& ids) {
        if (round != round_) {
          return;
        }
        if (!ids) {
          emit failed(ids.error());
          return;
        }
        matching_.clear();
        for (const std::string& id : *ids) {
          matching_.insert(QString::fromStdString(id));
        }
        matched_query_ = query;
        show();
      });
}

bool PatientListModel::passes(const PatientKey& key, PatientFilter filter) const {
  switch (filter) {
    case PatientFilter::Today:
      return key.last_at_ms >= today_ms_ && key.last_at_ms > 0;
    case PatientFilter::Drafts:
      return key.has_draft;
    case PatientFilter::All:
      break;
  }
  return true;
}

int PatientListModel::countOf(PatientFilter filter) const {
  return static_cast<int>(
      std::ranges::count_if(keys_, [&](const PatientKey& key) { return passes(key, filter); }));
}

void PatientListModel::show() {
  beginResetModel();
  shown_.clear();
  for (const PatientKey& key : keys_) {
    const bool matches =
        matched_query_.isEmpty() || matching_.contains(QString::fromStdString(key.id));
    if (matches && passes(key, filter_)) {
      shown_.push_back(key.id);
    }
  }
  endResetModel();
  emit shown();
}

int PatientListModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : static_cast<int>(shown_.size());
}

QVariant PatientListModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) {
    return {};
  }
  const QString id = QString::fromStdString(shown_[static_cast<std::size_t>(index.row())]);
  if (role == IdRole) {
    return id;
  }
  const bool asks_for_row =
      role == RowRole || role == Qt::DisplayRole || role == Qt::AccessibleTextRole;
  if (!asks_for_row) {
    return {};
  }
  const auto row = rows_.constFind(id);
  if (row == rows_.constEnd()) {
    wanted_.insert(id);
    fetch_.start();
    return role == RowRole ? QVariant() : QVariant(QString());
  }
  if (role == RowRole) {
    return QVariant::fromValue(*row);
  }
  return role == Qt::AccessibleTextRole ? row->spoken : row->name;
}

void PatientListModel::fetch() {
  std::vector<std::string> ids;
  for (const QString& id : wanted_) {
    ids.push_back(id.toStdString());
  }
  session_.ask<std::vector<PatientRow>>(
      Session::Kind::Read,
      this,
      [ids](Store& store) -> Expected<std::vector<PatientRow>> {
        std::vector<PatientRow> rows;
        for (const std::string& id : ids) {
          auto row = patientRow(store, id);
          if (!row) {
            return tl::unexpected(row.error());
          }
          rows.push_back(std::move(*row));
        }
        return rows;
      },
      [this](const Expected<std::vector<PatientRow>>& rows) {
        if (!rows) {
          emit failed(rows.error());
          return;
        }
        for (const PatientRow& row : *rows) {
          rows_.insert(row.id, row);
          wanted_.remove(row.id);
        }
        if (!shown_.empty()) {
          emit dataChanged(index(0), index(rowCount() - 1));
        }
      });
}

}  // namespace tarsus
