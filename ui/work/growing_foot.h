#pragma once

#include "reconstruction/fusion/preview_mesh.h"
#include "reconstruction/scene/frame.h"

#include <QImage>
#include <QRectF>
#include <QSize>

#include <memory>
#include <optional>
#include <vector>

namespace tarsus {

/// The surface of a scan while it grows, seen as the first camera saw it but without perspective:
/// what was seen well has the foot's own colours, what was seen little is striped.
class GrowingFoot {
 public:
  explicit GrowingFoot(const RgbdCamera& camera) : camera_(camera) {}
  /// A frame whose colours may be laid on the surface; most are passed over.
  void see(const std::shared_ptr<const RgbdFrame>& frame, const RigidTransform& scan_from_camera);
  /// Transparent where there is nothing.
  [[nodiscard]] QImage picture(const PreviewSurface& foot, float well_seen_weight, QSize size);
  /// Where a camera looked at the surface, as a part of the last picture (0 to 1).
  [[nodiscard]] QRectF lookedAt(const RigidTransform& scan_from_camera) const;

 private:
  struct Seen {
    std::shared_ptr<const RgbdFrame> frame;
    RigidTransform camera_from_scan;
  };
  [[nodiscard]] std::vector<Rgb8> colorsOf(const PreviewSurface& foot) const;
  void fit(const PreviewSurface& foot, QSize size);

  RgbdCamera camera_;
  std::vector<Seen> seen_;
  Eigen::Vector2f low_mm_ = Eigen::Vector2f::Zero();  ///< of the picture, in x and y of the scan
  float px_per_mm_ = 1.0F;
  QSize size_{1, 1};
};

}  // namespace tarsus
