#include "reconstruction/scene/mesh_picture.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/mesh_index.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

// Our own choices, by eye: a calm grey close to skin in lightness, light that comes from the
// viewer and, for relief, from above on the left, as maps and radiographs have it.
constexpr Rgb8 kGreySkin{196, 192, 188};
constexpr double kAmbient = 0.25;
constexpr double kHeadlight = 0.45;
constexpr double kKeyLight = 0.40;
constexpr double kBackFace = 0.45;  ///< the inside of a surface is drawn this much darker
constexpr double kWholeMargin = 1.06;

/// What all rays of a picture share.
struct Studio {
  const TriangleMesh& mesh;
  std::span<const Eigen::Vector3f> normals;
  std::span<const Rgb8> colors;  ///< empty: grey
  const MeshIndex& index;
  Eigen::Vector3d toward_viewer;
  Eigen::Vector3d key_light;
  double shading;
  Rgb8 background;
};

Eigen::Vector3d vectorOf(const Rgb8& color) {
  return {static_cast<double>(color.r), static_cast<double>(color.g), static_cast<double>(color.b)};
}

template <typename Value>
auto mixed(const MeshIndex::RayHit& hit, const Eigen::Vector3i& face, const Value& value) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) {
    sum += static_cast<double>(hit.barycentric[k]) * value(static_cast<std::size_t>(face[k]));
  }
  return sum;
}

Eigen::Vector3d shade(const Studio& studio, const MeshIndex::RayHit& hit) {
  if (hit.face < 0) {
    return vectorOf(studio.background);
  }
  const Eigen::Vector3i& face = studio.mesh.faces[static_cast<std::size_t>(hit.face)];
  const Eigen::Vector3d flat = faceNormal(studio.mesh, hit.face);
  Eigen::Vector3d normal =
      mixed(hit, face, [&](std::size_t i) { return studio.normals[i].cast<double>().eval(); });
  normal = normal.squaredNorm() > 1e-12 ? normal.normalized().eval() : flat;
  const bool from_behind = flat.dot(studio.toward_viewer) < 0.0;
  if (from_behind) {
    normal = -normal;
  }
  const double headlight = std::max(0.0, normal.dot(studio.toward_viewer));
  const double key = std::max(0.0, normal.dot(studio.key_light));
  const double light = kAmbient + kHeadlight * headlight + kKeyLight * key;
  const Eigen::Vector3d color =
      studio.colors.empty()
          ? vectorOf(kGreySkin)
          : mixed(hit, face, [&](std::size_t i) { return vectorOf(studio.colors[i]); });
  const double side = from_behind ? kBackFace : 1.0;
  return side * (1.0 - studio.shading + studio.shading * light) * color;
}

std::uint8_t toByte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// How far the mesh reaches towards the viewer from the view's middle [mm].
double reachToViewer(const TriangleMesh& mesh,
                     const Eigen::Vector3d& center,
                     const Eigen::Vector3d& toward_viewer) {
  double reach = 0.0;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    reach = std::max(reach, (vertex.cast<double>() - center).dot(toward_viewer));
  }
  return reach;
}

/// The faces that lie before the picture, or partly: no ray meets the others.
TriangleMesh facesInView(const TriangleMesh& mesh,
                         const ViewFrame& view,
                         const PictureOptions& options) {
  const double half_x_mm = 0.5 * view.mm_per_px * (options.width_px + 1);
  const double half_y_mm = 0.5 * view.mm_per_px * (options.height_px + 1);
  std::vector<Eigen::Vector2d> places;
  places.reserve(mesh.vertices.size());
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    const Eigen::Vector3d offset_mm = vertex.cast<double>() - view.center_mm;
    places.emplace_back(offset_mm.dot(view.right), offset_mm.dot(view.up));
  }
  TriangleMesh seen{.vertices = mesh.vertices};
  for (const Eigen::Vector3i& face : mesh.faces) {
    Eigen::AlignedBox2d box;
    for (const int v : face) {
      box.extend(places[static_cast<std::size_t>(v)]);
    }
    if (box.min().x() < half_x_mm && box.max().x() > -half_x_mm && box.min().y() < half_y_mm &&
        box.max().y() > -half_y_mm) {
      seen.faces.push_back(face);
    }
  }
  return seen;
}

/// Mean colour of samples x samples rays in each pixel of row v.
/// @param eye  the view, with its centre moved to where the rays start
void takeRow(const Studio& studio,
             const ViewFrame& eye,
             const PictureOptions& options,
             int v,
             ColorImage& picture) {
  const int samples = options.samples_per_axis;
  const auto across = static_cast<std::size_t>(options.width_px) * samples;
  std::vector<Eigen::Vector3f> origins(across);
  std::vector<MeshIndex::RayHit> hits(across);
  std::vector<Eigen::Vector3d> sums(static_cast<std::size_t>(options.width_px),
                                    Eigen::Vector3d::Zero());
  const auto offset = [samples](int i) { return (i + 0.5) / samples - 0.5; };
  for (int sub_row = 0; sub_row < samples; ++sub_row) {
    const double y_px = 0.5 * (options.height_px - 1) - (v + offset(sub_row));
    for (std::size_t i = 0; i < across; ++i) {
      const int u = static_cast<int>(i) / samples;
      const double x_px = u + offset(static_cast<int>(i) % samples) - 0.5 * (options.width_px - 1);
      origins[i] =
          (eye.center_mm + eye.mm_per_px * (x_px * eye.right + y_px * eye.up)).cast<float>();
    }
    studio.index.castParallelRays(origins, (-studio.toward_viewer).cast<float>(), hits);
    for (std::size_t i = 0; i < across; ++i) {
      sums[i / static_cast<std::size_t>(samples)] += shade(studio, hits[i]);
    }
  }
  for (int u = 0; u < options.width_px; ++u) {
    const Eigen::Vector3d mean = sums[static_cast<std::size_t>(u)] / (samples * samples);
    picture.at(u, v) = {toByte(mean.x()), toByte(mean.y()), toByte(mean.z())};
  }
}

}  // namespace

Eigen::Vector2d ViewFrame::project(const Eigen::Vector3d& p_mm,
                                   const PictureOptions& options) const {
  const Eigen::Vector3d offset_mm = p_mm - center_mm;
  return {0.5 * (options.width_px - 1) + offset_mm.dot(right) / mm_per_px,
          0.5 * (options.height_px - 1) - offset_mm.dot(up) / mm_per_px};
}

ViewFrame viewOfWhole(const TriangleMesh& mesh,
                      const Eigen::Vector3d& toward_viewer,
                      const Eigen::Vector3d& up_hint,
                      const PictureOptions& options) {
  TARSUS_REQUIRE(toward_viewer.norm() > 0.0, "the viewer stands somewhere");
  const Eigen::Vector3d toward = toward_viewer.normalized();
  ViewFrame view;
  view.up = up_hint - up_hint.dot(toward) * toward;
  if (view.up.norm() < 1e-6 * (up_hint.norm() + 1e-300)) {
    view.up = toward.unitOrthogonal();  // the hint points at the viewer and says nothing
  }
  view.up.normalize();
  view.right = view.up.cross(toward);
  Eigen::Matrix3d axes;
  axes << view.right.transpose(), view.up.transpose(), toward.transpose();
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    box.extend((axes * vertex.cast<double>()).eval());
  }
  if (box.isEmpty()) {
    return view;
  }
  view.center_mm = axes.transpose() * box.center();
  const Eigen::Vector3d size_mm = box.sizes();
  const double fitting = std::max(size_mm.x() / std::max(1, options.width_px),
                                  size_mm.y() / std::max(1, options.height_px));
  view.mm_per_px = fitting > 0.0 ? kWholeMargin * fitting : view.mm_per_px;
  return view;
}

ColorImage takePicture(const TriangleMesh& mesh,
                       std::span<const Rgb8> colors,
                       const ViewFrame& view,
                       const PictureOptions& options) {
  TARSUS_REQUIRE(options.width_px > 0 && options.height_px > 0, "a picture has pixels");
  TARSUS_REQUIRE(options.samples_per_axis > 0 && view.mm_per_px > 0.0, "a picture has a scale");
  TARSUS_REQUIRE(colors.empty() || colors.size() == mesh.vertices.size(),
                 "a colour for each vertex, or none");
  const TriangleMesh seen = facesInView(mesh, view, options);
  const MeshIndex index(seen);
  const auto computed = mesh.normals.empty() ? vertexNormals(mesh) : std::vector<Eigen::Vector3f>();
  const bool colored = options.textured && !colors.empty();
  const Eigen::Vector3d toward = view.right.cross(view.up);
  const Studio studio{.mesh = seen,
                      .normals = mesh.normals.empty() ? computed : mesh.normals,
                      .colors = colored ? colors : std::span<const Rgb8>(),
                      .index = index,
                      .toward_viewer = toward,
                      .key_light = (-0.55 * view.right + 0.6 * view.up + 0.6 * toward).normalized(),
                      .shading = colored ? std::clamp(options.shading, 0.0, 1.0) : 1.0,
                      .background = options.background};
  constexpr double kClearMm = 1.0;
  ViewFrame eye = view;
  eye.center_mm += (reachToViewer(mesh, view.center_mm, toward) + kClearMm) * toward;
  ColorImage picture(options.width_px, options.height_px);
  parallelFor(options.height_px, [&](int v) { takeRow(studio, eye, options, v, picture); });
  return picture;
}

}  // namespace tarsus
