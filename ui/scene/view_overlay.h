#pragma once

#include "ui/look/look.h"
#include "ui/scene/model_view.h"

#include <QWidget>

class QToolButton;

namespace tarsus {

/// A bar of round length, true to the picture, which has no perspective.
class ScaleBar : public QWidget {
  Q_OBJECT

 public:
  explicit ScaleBar(QWidget* parent = nullptr);
  void setMmPerPixel(double mm_per_px);
  /// The length it shows [mm] and how long it is on the screen [px].
  [[nodiscard]] double lengthMm() const { return length_mm_; }
  [[nodiscard]] double lengthPx() const { return length_mm_ / mm_per_px_; }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  double mm_per_px_ = 1.0;
  double length_mm_ = 10.0;
};

/// Texture or relief.
class ViewTools : public QWidget {
  Q_OBJECT

 public:
  explicit ViewTools(QWidget* parent = nullptr);
  void setTextured(bool textured, bool has_color);

 signals:
  void texturedChosen(bool textured);

 private:
  QToolButton* texture_ = nullptr;
  QToolButton* relief_ = nullptr;
};

/// The standard views and the way back to the whole, each with its key.
class ViewButtons : public QWidget {
  Q_OBJECT

 public:
  explicit ViewButtons(QWidget* parent = nullptr);

 signals:
  void viewChosen(tarsus::StandardView view);
  void fitChosen();
};

}  // namespace tarsus
