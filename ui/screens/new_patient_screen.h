#pragma once

#include "measurement/records/patients.h"
#include "ui/screens/screen.h"

class QLineEdit;
class QPushButton;

namespace tarsus {

class FieldFrame;
class Note;
class Session;

/// A birth date as it is typed: 14.3.1958, 14 Mar 1958, 1958-03-14, or as the locale writes dates.
/// @return an invalid date where it is none
[[nodiscard]] QDate typedDate(const QString& typed);

/// The fields of a patient's record.
class NewPatientScreen : public Screen {
  Q_OBJECT

 public:
  explicit NewPatientScreen(Session& session, QWidget* parent = nullptr);
  void entered() override;
  void primary() override;
  [[nodiscard]] QStringList crumbs() const override { return {tr("Patients"), tr("New patient")}; }

 signals:
  void added(const QString& id);
  void givenUp();

 private:
  [[nodiscard]] bool check();
  void checkBirth();

  Session& session_;
  QLineEdit* given_ = nullptr;
  QLineEdit* family_ = nullptr;
  QLineEdit* birth_ = nullptr;
  QLineEdit* number_ = nullptr;
  FieldFrame* family_frame_ = nullptr;
  FieldFrame* birth_frame_ = nullptr;
  Note* problem_ = nullptr;
  QPushButton* go_ = nullptr;
  bool busy_ = false;
};

}  // namespace tarsus
