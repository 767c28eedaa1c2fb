#pragma once

#include <QStyledItemDelegate>
#include <QWidget>

class QAbstractScrollArea;

namespace tarsus {

/// Paints one patient: name, foot and site, visit, area, its line since the start, state.
class PatientDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  void paint(QPainter* painter,
             const QStyleOptionViewItem& option,
             const QModelIndex& index) const override;
  [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option,
                               const QModelIndex& index) const override;
};

/// The names of the columns, in line with the delegate.
class PatientColumns : public QWidget {
  Q_OBJECT

 public:
  ///  list  whose viewport the columns stand over, beside its scroll bar
  explicit PatientColumns(const QAbstractScrollArea* list);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  const QAbstractScrollArea* list_;
};

/// Paints one visit that waits for a physician.
class ReviewDelegate : public QStyledItemDelegate {
  Q_OBJECT

 public:
  using QStyledItemDelegate::QStyledItemDelegate;
  void paint(QPainter* painter,
             const QStyleOptionViewItem& option,
             const QModelIndex& index) const override;
  [[nodiscard]] QSize sizeHint(const QStyleOptionViewItem& option,
                               const QModelIndex& index) const override;
};

}  // namespace tarsus
