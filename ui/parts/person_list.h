#pragma once

#include "ui/work/station.h"

#include <QWidget>

#include <vector>

class QVBoxLayout;

namespace tarsus {

class PersonRow;

/// People to sign in as: one of them is chosen; the whole row is the target, Up and Down walk.
class PersonList : public QWidget {
  Q_OBJECT

 public:
  explicit PersonList(QWidget* parent = nullptr);
  void setPeople(const std::vector<Person>& people);
  void setCurrent(int index);
  [[nodiscard]] QString currentName() const;

 signals:
  void chosen();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  std::vector<PersonRow*> rows_;
  QVBoxLayout* column_ = nullptr;
  int current_ = -1;
};

}  // namespace tarsus
