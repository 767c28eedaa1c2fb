#include "ui/screens/review_model.h"

namespace tarsus {

QVariant ReviewModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= rowCount()) {
    return {};
  }
  const ReviewItem& item = items_[static_cast<std::size_t>(index.row())];
  if (role == ItemRole) {
    return QVariant::fromValue(item);
  }
  if (role == Qt::AccessibleTextRole) {
    return QStringList{item.patient, item.site, item.taken, item.change}.join(QStringLiteral(", "));
  }
  return role == Qt::DisplayRole ? QVariant(item.patient) : QVariant();
}

}  // namespace tarsus
