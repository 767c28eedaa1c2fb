#include "measurement/report/close_view.h"

#include "measurement/report/depth_colors.h"
#include "measurement/report/depth_contours.h"
#include "measurement/report/section_profile.h"
#include "measurement/wound/wound_view.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/mesh_picture.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

// Printed sizes of report.cpp's pictures at 300 dpi.
constexpr double kDotsPerMm = 300.0 / 25.4;
constexpr double kCloseSide_mm = 62.0;
constexpr double kFootWidth_mm = 32.0;
constexpr double kFootHeight_mm = 66.0;
constexpr double kCloseMargin_mm = 12.0;  ///< of skin beside the wound, both sides together
constexpr double kOverSkin_mm = 0.05;     ///< lifts the coloured bed off the same surface below it
constexpr Rgb8 kPaper{255, 255, 255};
constexpr Rgb8 kSkinGrey{226, 226, 226};

/// Extent of points in the view's plane, around the origin given.
Eigen::AlignedBox2d extentOf(const std::vector<Eigen::Vector3d>& points,
                             const WoundView& d,
                             const Eigen::Vector3d& origin) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& p : points) {
    box.extend(Eigen::Vector2d((p - origin).dot(d.right), (p - origin).dot(d.up)));
  }
  return box;
}

int dots(double printed_mm) { return static_cast<int>(std::lround(printed_mm * kDotsPerMm)); }

ViewFrame closeFrame(const MeasuredWound& wound, const WoundView& d) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : wound.outline_mm) {
    mean += p / static_cast<double>(wound.outline_mm.size());
  }
  const Eigen::AlignedBox2d box = extentOf(wound.outline_mm, d, mean);
  double scale = 0.5;
  for (const double candidate : {1.5, 1.0, 0.75}) {
    if (box.sizes().maxCoeff() + kCloseMargin_mm <= kCloseSide_mm / candidate) {
      scale = candidate;
      break;
    }
  }
  const Eigen::Vector2d middle = box.center();
  return {.center_mm = mean + middle.x() * d.right + middle.y() * d.up,
          .right = d.right,
          .up = d.up,
          .mm_per_px = kCloseSide_mm / scale / dots(kCloseSide_mm)};
}

ViewFrame footFrame(const TexturedMesh& foot, const WoundView& d) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3f& p : foot.mesh.vertices) {
    points.push_back(p.cast<double>());
  }
  const Eigen::AlignedBox2d box = extentOf(points, d, Eigen::Vector3d::Zero());
  double reduction = 1.0;
  for (const double candidate : {1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 15.0, 20.0}) {
    reduction = candidate;
    if (box.sizes().x() <= (kFootWidth_mm - 1.0) * candidate &&
        box.sizes().y() <= (kFootHeight_mm - 1.0) * candidate) {
      break;
    }
  }
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : points) {
    middle += p / static_cast<double>(points.size());
  }
  const double depth = middle.dot(d.toward_viewer);
  return {
      .center_mm = box.center().x() * d.right + box.center().y() * d.up + depth * d.toward_viewer,
      .right = d.right,
      .up = d.up,
      .mm_per_px = kFootWidth_mm * reduction / dots(kFootWidth_mm)};
}

/// Grey skin with the bed laid over it in the colours of its depth.
ColorImage depthPicture(const TexturedMesh& foot,
                        const MeasuredWound& wound,
                        const ViewFrame& view,
                        double end_mm) {
  PictureOptions options;
  options.width_px = dots(kCloseSide_mm);
  options.height_px = options.width_px;
  options.shading = 0.15;
  options.background = kPaper;
  std::vector<Rgb8> colors;
  TriangleMesh bed;
  if (end_mm > 0.0 && wound.bed_depth_mm.size() == wound.bed.vertices.size()) {
    bed = wound.bed;
    for (const float depth : wound.bed_depth_mm) {
      colors.push_back(depthColor(static_cast<double>(depth), end_mm));
    }
  }
  return overlaidPicture(foot.mesh, bed, colors, view, options);
}

std::vector<Eigen::Vector2d> projected(const std::vector<Eigen::Vector3d>& points,
                                       const ViewFrame& view,
                                       const PictureOptions& options) {
  std::vector<Eigen::Vector2d> result;
  for (const Eigen::Vector3d& p : points) {
    result.push_back(view.project(p, options));
  }
  return result;
}

void takeFoot(ReportContent& content,
              const TexturedMesh& foot,
              const MeasuredWound& wound,
              const WoundView& d) {
  PictureOptions options;
  options.width_px = dots(kFootWidth_mm);
  options.height_px = dots(kFootHeight_mm);
  options.background = kPaper;
  options.shading = foot.colors.empty() ? 0.9 : 0.5;
  const ViewFrame view = footFrame(foot, d);
  content.foot = takePicture(foot.mesh, foot.colors, view, options);
  content.foot_mm_per_px = view.mm_per_px;
  content.foot_outline_px = projected(wound.outline_mm, view, options);
}

/// Triangles of the bed, seen from the front, that were filled rather than measured.
void takeUnseen(ReportContent& content,
                const MeasuredWound& wound,
                const ViewFrame& view,
                const PictureOptions& options) {
  if (wound.bed_unseen.size() != wound.bed.vertices.size()) {
    return;
  }
  for (const Eigen::Vector3i& face : wound.bed.faces) {
    float unseen = 0.0F;
    std::array<Eigen::Vector2d, 3> triangle;
    for (int k = 0; k < 3; ++k) {
      const auto v = static_cast<std::size_t>(face[k]);
      unseen += wound.bed_unseen[v];
      triangle[static_cast<std::size_t>(k)] =
          view.project(wound.bed.vertices[v].cast<double>(), options);
    }
    if (unseen > 1.5F) {  // more than half of its corners
      content.unseen_px.push_back(triangle);
    }
  }
}

void takeDepth(ReportContent& content,
               const TexturedMesh& foot,
               const MeasuredWound& wound,
               const ViewFrame& view) {
  PictureOptions options;
  options.width_px = dots(kCloseSide_mm);
  options.height_px = options.width_px;
  double deepest = 0.0;
  for (const float depth : wound.bed_depth_mm) {
    deepest = std::max(deepest, static_cast<double>(depth));
  }
  deepest = std::max(deepest, wound.numbers.max_depth_mm.value_or(0.0));
  const bool measurable = !wound.numbers.not_measurable.contains("max_depth_mm") && deepest > 0.0;
  content.depth_scale_end_mm = measurable ? depthScaleEnd(deepest) : 0.0;
  content.depth_map = depthPicture(foot, wound, view, content.depth_scale_end_mm);
  takeUnseen(content, wound, view, options);
  if (!measurable || wound.bed_depth_mm.size() != wound.bed.vertices.size()) {
    return;
  }
  content.contour_step_mm = deepest < 2.0 ? 0.5 : 1.0;
  for (const auto& segment : depthContours(
           wound.bed, wound.bed_depth_mm, content.contour_step_mm, view.right.cross(view.up))) {
    content.contours_px.push_back(
        {view.project(segment[0], options), view.project(segment[1], options)});
  }
  if (wound.numbers.max_depth_at_mm) {
    content.deepest_px = view.project(*wound.numbers.max_depth_at_mm, options);
  }
  content.section = sectionForReport(foot, wound, view, options);
}

}  // namespace

CloseView closeViewOf(const TexturedMesh& foot,
                      const MeasuredWound& wound,
                      const std::optional<Landmarks>& landmarks) {
  const WoundView d = viewOf(foot.mesh, wound, landmarks);
  return {closeFrame(wound, d), d.oriented};
}

ColorImage overlaidPicture(const TriangleMesh& skin,
                           const TriangleMesh& over,
                           std::span<const Rgb8> colors,
                           const ViewFrame& view,
                           const PictureOptions& options) {
  const Eigen::Vector3f lift = (kOverSkin_mm * view.right.cross(view.up)).cast<float>();
  TriangleMesh scene = skin;
  scene.normals.clear();
  std::vector<Rgb8> all_colors(scene.vertices.size(), kSkinGrey);
  const auto first = static_cast<int>(scene.vertices.size());
  for (const Eigen::Vector3f& vertex : over.vertices) {
    scene.vertices.push_back(vertex + lift);
  }
  all_colors.insert(all_colors.end(), colors.begin(), colors.end());
  for (const Eigen::Vector3i& face : over.faces) {
    scene.faces.emplace_back((face.array() + first).matrix());
  }
  return takePicture(scene, all_colors, view, options);
}

ReportContent illustrate(const TexturedMesh& foot,
                         const MeasuredWound& wound,
                         const std::optional<Landmarks>& landmarks) {
  TARSUS_REQUIRE(wound.outline_mm.size() >= 3, "a measured wound has an outline");
  TARSUS_REQUIRE(!foot.mesh.faces.empty(), "a wound lies on a surface");
  const WoundView d = viewOf(foot.mesh, wound, landmarks);
  const ViewFrame view = closeFrame(wound, d);
  ReportContent content;
  content.measurement = wound.numbers;
  content.model_sha256 = foot.sha256;
  content.oriented = d.oriented;
  content.has_color = !foot.colors.empty();
  content.close_mm_per_px = view.mm_per_px;
  PictureOptions options;
  options.width_px = dots(kCloseSide_mm);
  options.height_px = options.width_px;
  options.background = kPaper;
  options.shading = content.has_color ? 0.25 : 0.9;
  content.texture = takePicture(foot.mesh, foot.colors, view, options);
  content.outline_px = projected(wound.outline_mm, view, options);
  content.skin_curve_px = projected(wound.skin_curve_mm, view, options);
  takeDepth(content, foot, wound, view);
  takeFoot(content, foot, wound, d);
  return content;
}

}  // namespace tarsus
