#pragma once

#include "ui/screens/gate_page.h"
#include "ui/work/session.h"

class QCheckBox;
class QComboBox;
class QLineEdit;

namespace tarsus {

class FieldFrame;
class Note;
class PasswordField;

/// The first start: who works here, and the password.
class FirstRunPage : public GatePage {
  Q_OBJECT

 public:
  explicit FirstRunPage(Session& session);
  void entered() override;
  void primary() override;

 signals:
  void created(const QString& recovery_code);

 private:
  [[nodiscard]] bool check();
  [[nodiscard]] QWidget* makeFields();

  Session& session_;
  QLineEdit* name_ = nullptr;
  QComboBox* role_ = nullptr;
  QLineEdit* clinic_ = nullptr;
  PasswordField* password_ = nullptr;
  PasswordField* again_ = nullptr;
  FieldFrame* name_frame_ = nullptr;
  FieldFrame* role_frame_ = nullptr;
  FieldFrame* password_frame_ = nullptr;
  FieldFrame* again_frame_ = nullptr;
  QCheckBox* demo_ = nullptr;
  Note* problem_ = nullptr;
  QPushButton* go_ = nullptr;
  bool busy_ = false;
};

}  // namespace tarsus
