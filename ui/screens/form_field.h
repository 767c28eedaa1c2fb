#pragma once

#include "measurement/records/visit_fields.h"

#include <QDate>
#include <QWidget>

#include <vector>

class QGridLayout;
class QHBoxLayout;
class QLabel;
class QLineEdit;
class QPlainTextEdit;
class QPushButton;
class QVBoxLayout;

namespace tarsus {

class ChoiceRow;
class FieldFrame;

/// One field of the visit's form: its label, the last visit's value beside it in italics, and the
/// control of its kind. What is impossible is refused at the field and never handed on.
class FormField : public QWidget {
  Q_OBJECT

 public:
  [[nodiscard]] static FormField* make(const VisitField& field);
  [[nodiscard]] const QString& name() const { return name_; }
  /// Shows a value without announcing it; null: not known.
  virtual void setValue(const nlohmann::json& value) = 0;
  /// The last visit's value. @param may_keep  a touch takes it over
  void setEarlier(const nlohmann::json& value, const QDate& date, bool may_keep);
  void clearEarlier();
  [[nodiscard]] virtual QString error() const { return {}; }
  /// Its first control takes the focus.
  virtual void focusFirst() = 0;

 signals:
  /// A value that the field may have, or null.
  void changed(const QString& name, const nlohmann::json& value);

 protected:
  explicit FormField(const VisitField& field);
  QVBoxLayout* column_ = nullptr;
  VisitField field_;

 private:
  QString name_;
  QPushButton* earlier_ = nullptr;
  nlohmann::json earlier_value_;
};

/// What an impossible number is told: "34 to 43 °C, please check."
[[nodiscard]] QString rangeError(const VisitField& field);

}  // namespace tarsus

Q_DECLARE_METATYPE(nlohmann::json)
