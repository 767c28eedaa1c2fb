#pragma once

#include "ui/work/patient_list.h"

#include <QAbstractListModel>
#include <QHash>
#include <QSet>
#include <QTimer>

namespace tarsus {

class Session;

enum class PatientFilter { All, Today, Drafts };

/// The patients of the list. It knows all ids in order; a row is read and decrypted only when it
/// comes into view, so that ten thousand patients cost no more than twenty.
class PatientListModel : public QAbstractListModel {
  Q_OBJECT

 public:
  enum Roles { RowRole = Qt::UserRole + 1, IdRole };

  explicit PatientListModel(Session& session, QObject* parent = nullptr);

  /// Reads the order anew, forgets all rows.
  void reload();
  void clear();
  void setQuery(const QString& query);
  void setFilter(PatientFilter filter);
  [[nodiscard]] QString query() const { return query_; }
  [[nodiscard]] int countOf(PatientFilter filter) const;
  [[nodiscard]] bool loaded() const { return loaded_; }
  [[nodiscard]] int loadedRows() const { return rows_.size(); }

  [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override;
  [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;

 signals:
  /// The order or what matches has changed.
  void shown();
  void failed(const tarsus::Error& error);

 private:
  void search();
  void show();
  void fetch();
  [[nodiscard]] bool passes(const PatientKey& key, PatientFilter filter) const;

  Session& session_;
  std::vector<PatientKey> keys_;
  std::vector<std::string> shown_;
  QSet<QString> matching_;
  QString query_;
  QString matched_query_;
  PatientFilter filter_ = PatientFilter::All;
  bool loaded_ = false;
  int round_ = 0;  ///< answers to an older question are passed over
  std::int64_t today_ms_ = 0;
  QHash<QString, PatientRow> rows_;
  mutable QSet<QString> wanted_;
  mutable QTimer fetch_;
};

}  // namespace tarsus

Q_DECLARE_METATYPE(tarsus::PatientRow)
