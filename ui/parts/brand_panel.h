#pragma once

#include <QWidget>

namespace tarsus {

/// The left of the sign-in page: the mark, a sole with a closing wound, what the program does and
/// what it is not.
class BrandPanel : public QWidget {
  Q_OBJECT

 public:
  explicit BrandPanel(QWidget* parent = nullptr);
};

}  // namespace tarsus
