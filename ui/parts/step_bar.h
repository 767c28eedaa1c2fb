#pragma once

#include <QWidget>

#include <vector>

class QButtonGroup;
class QLabel;
class QToolButton;

namespace tarsus {

/// The five steps of a visit. Steps that were reached can be gone back to at any time; where there
/// is no room it reads "3 of 5: Outline".
class StepBar : public QWidget {
  Q_OBJECT

 public:
  explicit StepBar(QWidget* parent = nullptr);
  /// @param current  0 to 4; @param reached  the furthest step that may be clicked
  void setStep(int current, int reached);
  [[nodiscard]] int current() const { return current_; }
  /// Shows the short form.
  void setShort(bool is_short);

 signals:
  void stepChosen(int step);

 private:
  std::vector<QToolButton*> buttons_;
  QLabel* short_ = nullptr;
  int current_ = 0;
  bool is_short_ = false;
};

}  // namespace tarsus
