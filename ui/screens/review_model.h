#pragma once

#include "ui/work/patient_list.h"

#include <QAbstractListModel>

namespace tarsus {

/// Signed visits that wait for a physician, oldest first.
class ReviewModel : public QAbstractListModel {
  Q_OBJECT

 public:
  enum Roles { ItemRole = Qt::UserRole + 1 };
  using QAbstractListModel::QAbstractListModel;

  void setItems(std::vector<ReviewItem> items) {
    beginResetModel();
    items_ = std::move(items);
    endResetModel();
  }
  [[nodiscard]] const std::vector<ReviewItem>& items() const { return items_; }
  [[nodiscard]] int rowCount(const QModelIndex& parent = {}) const override {
    return parent.isValid() ? 0 : static_cast<int>(items_.size());
  }
  [[nodiscard]] QVariant data(const QModelIndex& index, int role) const override;

 private:
  std::vector<ReviewItem> items_;
};

}  // namespace tarsus

Q_DECLARE_METATYPE(tarsus::ReviewItem)
