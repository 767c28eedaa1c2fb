#pragma once

#include <QWidget>

namespace tarsus {

/// The product's mark: a foot in a square, teal on surfaces, white on teal.
class Mark : public QWidget {
  Q_OBJECT

 public:
  explicit Mark(bool on_brand = false, QWidget* parent = nullptr);
  [[nodiscard]] QSize sizeHint() const override { return {28, 28}; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  bool on_brand_;
};

}  // namespace tarsus
