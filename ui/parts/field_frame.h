#pragma once

#include <QWidget>

class QLabel;

namespace tarsus {

/// A field with its label above, and a hint or an error below. An error replaces the hint, colours
/// the edge, and is read out with the field.
class FieldFrame : public QWidget {
  Q_OBJECT

 public:
  FieldFrame(const QString& label, QWidget* field, const QString& hint = {});

  void setError(const QString& error);
  void setHint(const QString& hint);
  void clearError() { setError({}); }
  [[nodiscard]] QString error() const { return error_; }
  [[nodiscard]] QWidget* field() const { return field_; }

 private:
  void showBelow();

  QWidget* field_;
  QString hint_;
  QString error_;
  QWidget* below_ = nullptr;
  QWidget* sign_ = nullptr;
  QLabel* text_ = nullptr;
};

}  // namespace tarsus
