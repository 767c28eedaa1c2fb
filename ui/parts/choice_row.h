#pragma once

#include <QStringList>
#include <QWidget>

class QButtonGroup;

namespace tarsus {

/// One of a few, side by side, with a tick on the chosen one.
class ChoiceRow : public QWidget {
  Q_OBJECT

 public:
  explicit ChoiceRow(const QStringList& texts, QWidget* parent = nullptr);
  void setCurrent(int index);  ///< -1: none
  [[nodiscard]] int current() const;
  void setTexts(const QStringList& texts);
  /// Without ticks: as a filter above a list.
  void setTicks(bool ticks);

 signals:
  void chosen(int index);

 private:
  void showTicks();
  QButtonGroup* group_ = nullptr;
  bool ticks_ = true;
};

}  // namespace tarsus
