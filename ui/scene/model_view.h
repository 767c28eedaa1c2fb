#pragma once

#include "reconstruction/scene/mesh.h"
#include "ui/look/look.h"

#include <QWidget>

#include <memory>

namespace tarsus {

/// Where the model is looked at from, in the scan frame: the camera of the first frame looks along
/// +z with +y down.
enum class StandardView { Front, Back, Left, Right };

/// Shows one model without perspective: left or right drag turns it, the middle button or Shift
/// slides it, the wheel zooms.
class ModelView : public QWidget {
  Q_OBJECT

 public:
  explicit ModelView(QWidget* parent = nullptr);
  ~ModelView() override;

  /// Replaces what is shown, in the first standard view.
  void showModel(std::shared_ptr<const TexturedMesh> model);
  /// false: the shape alone, in grey.
  void setTextured(bool textured);
  [[nodiscard]] bool textured() const;
  void look(StandardView view);
  /// Brings the whole model back into the picture without turning it.
  void fit();
  /// Length of a screen pixel on the model [mm].
  [[nodiscard]] double mmPerPixel() const;

 signals:
  /// The picture was drawn anew, perhaps at another scale.
  void rendered();

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

/// To be called before the QApplication is made: asks Qt for the OpenGL that VTK needs.
void prepareGraphics();

}  // namespace tarsus
