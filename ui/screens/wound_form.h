#pragma once

#include "measurement/records/feet.h"
#include "measurement/records/wounds.h"

#include <QDate>
#include <QFrame>

class QComboBox;
class QLineEdit;

namespace tarsus {

class FieldFrame;

/// A new wound: the site that was touched, in words that can be mended, its cause and its age.
class WoundForm : public QFrame {
  Q_OBJECT

 public:
  explicit WoundForm(QWidget* parent = nullptr);
  void propose(FootSide side, const QString& place);
  void setLatest(const QDate& today) { today_ = today; }

 signals:
  void accepted(tarsus::FootSide side, const tarsus::WoundFields& fields);
  void givenUp();
  void proposed(tarsus::FootSide side, const QString& place);

 private:
  void accept();

  QComboBox* side_ = nullptr;
  QComboBox* place_ = nullptr;
  QComboBox* aspect_ = nullptr;
  QComboBox* cause_ = nullptr;
  QLineEdit* onset_ = nullptr;
  FieldFrame* onset_frame_ = nullptr;
  QDate today_;
};

}  // namespace tarsus
