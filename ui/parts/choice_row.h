#pragma once

#include <QStringList>
#include <QWidget>

class QButtonGroup;

namespace tarsus {

/// One of a few, side by side, with a tick on the chosen one. Keys 1 to 9 choose; a touch on the
/// chosen one, or Delete, takes the choice back where the row fills its place.
class ChoiceRow : public QWidget {
  Q_OBJECT

 public:
  explicit ChoiceRow(const QStringList& texts, QWidget* parent = nullptr);
  void setCurrent(int index);  ///< -1: none
  [[nodiscard]] int current() const;
  void setTexts(const QStringList& texts);
  /// The choices share the whole width; what they choose is read aloud with each.
  void setFills(const QString& of_what);
  void focusCurrent();
  /// Without ticks: as a filter above a list.
  void setTicks(bool ticks);

 signals:
  void chosen(int index);  ///< -1: taken back

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  void takeBack();
  void showTicks();
  QButtonGroup* group_ = nullptr;
  bool ticks_ = true;
  bool may_be_none_ = false;
  int before_ = -1;  ///< chosen when the mouse went down
};

}  // namespace tarsus
