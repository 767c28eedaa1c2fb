#pragma once

#include "measurement/records/visit_states.h"

#include <QWidget>

class QPainter;

namespace tarsus {

enum class ChipTone { Plain, Good, Warning, Danger };

struct ChipLook {
  QString text;
  ChipTone tone = ChipTone::Plain;
  QString icon;  ///< or empty
};

[[nodiscard]] QSize chipSize(const ChipLook& chip);
/// Paints a chip at a place, for delegates; `top_left` in widget coordinates.
void paintChip(QPainter& painter, const QPoint& top_left, const ChipLook& chip);

/// The state of a visit in one word.
[[nodiscard]] ChipLook chipOf(VisitState state);

/// A word on a tinted ground.
class Chip : public QWidget {
  Q_OBJECT

 public:
  explicit Chip(ChipLook chip = {}, QWidget* parent = nullptr);
  void setChip(ChipLook chip);
  [[nodiscard]] const ChipLook& chip() const { return chip_; }
  [[nodiscard]] QSize sizeHint() const override { return chipSize(chip_); }
  [[nodiscard]] QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  ChipLook chip_;
};

}  // namespace tarsus
