#include "tests/measurement/report/sample_wound.h"

#include <cmath>
#include <functional>
#include <numbers>

namespace tarsus::sample {
namespace {

constexpr double kStep_mm = 0.75;
constexpr double kHalfLength_mm = 118.0;
constexpr int kRays = 96;
constexpr int kRings = 24;

/// Half the width of the sole at y: narrow heel, wide forefoot.
double halfWidth(double y) { return 36.0 + 9.0 * std::sin(y / 55.0); }

/// Height of the healthy sole, towards the viewer; a shallow dome.
double skinHeight(double x, double y) { return -x * x / 90.0 - y * y / 900.0; }

double depthAt(double x, double y) {
  const double dx = x - kWoundAt.x();
  const double dy = y - kWoundAt.y();
  const double share = std::hypot(dx, dy) / outlineRadius(std::atan2(dy, dx));
  if (share >= 1.0) {
    return 0.0;
  }
  const double rim = 1.0 - std::pow(share, 6.0);
  const double off_center = std::hypot(dx + 3.0, dy - 2.0) / 9.0;
  return rim * (0.55 + 0.45 * std::exp(-off_center * off_center * 2.0)) * kBowlDepth_mm;
}

/// Cheap repeatable speckle in [0, 1].
double speckle(double x, double y) {
  const double s = std::sin(x * 12.9898 + y * 78.233) * 43758.5453;
  return s - std::floor(s);
}

std::uint8_t level(double value) {
  return static_cast<std::uint8_t>(std::lround(std::min(255.0, std::max(0.0, value))));
}

Rgb8 colorAt(double x, double y) {
  const double grain = 14.0 * (speckle(x, y) - 0.5);
  if (depthAt(x, y) > 0.02) {
    const bool slough = std::sin(x * 0.7) * std::cos(y * 0.55) > 0.45;
    return slough ? Rgb8{level(204 + grain), level(178 + grain), level(104 + grain)}
                  : Rgb8{level(150 + grain), level(30 + grain), level(38 + grain)};
  }
  const double away = std::hypot(x - kWoundAt.x(), y - kWoundAt.y());
  const double pink = std::exp(-away * away / 300.0);
  return {level(222 + grain), level(176 - 40 * pink + grain), level(150 - 30 * pink + grain)};
}

Eigen::Vector3f point(double x, double y, double depth) {
  return {
      static_cast<float>(x), static_cast<float>(y), static_cast<float>(skinHeight(x, y) - depth)};
}

void appendGridFaces(TriangleMesh& mesh, int columns, int rows) {
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      const int a = j * columns + i;
      mesh.faces.emplace_back(a, a + 1, a + columns + 1);
      mesh.faces.emplace_back(a, a + columns + 1, a + columns);
    }
  }
}

TexturedMesh makeFoot() {
  TexturedMesh foot;
  const int rows = static_cast<int>(2.0 * kHalfLength_mm / kStep_mm) + 1;
  const int columns = 121;
  for (int j = 0; j < rows; ++j) {
    const double y = -kHalfLength_mm + j * kStep_mm;
    const double round = std::sqrt(std::max(0.02, 1.0 - std::pow(y / (kHalfLength_mm + 1.0), 8.0)));
    for (int i = 0; i < columns; ++i) {
      const double x = halfWidth(y) * round * (2.0 * i / (columns - 1) - 1.0);
      foot.mesh.vertices.push_back(point(x, y, depthAt(x, y)));
      foot.colors.push_back(colorAt(x, y));
    }
  }
  appendGridFaces(foot.mesh, columns, rows);
  foot.mesh.normals = vertexNormals(foot.mesh);
  return withHash(std::move(foot));
}

/// The wound as rings from its middle to the outline: bounded by it exactly.
TriangleMesh makeDisc(const std::function<double(double, double)>& depth) {
  TriangleMesh disc;
  disc.vertices.push_back(point(kWoundAt.x(), kWoundAt.y(), depth(kWoundAt.x(), kWoundAt.y())));
  for (int ring = 1; ring <= kRings; ++ring) {
    for (int ray = 0; ray < kRays; ++ray) {
      const double angle = 2.0 * std::numbers::pi * ray / kRays;
      const double r = outlineRadius(angle) * ring / kRings;
      const double x = kWoundAt.x() + r * std::cos(angle);
      const double y = kWoundAt.y() + r * std::sin(angle);
      disc.vertices.push_back(point(x, y, depth(x, y)));
    }
  }
  for (int ray = 0; ray < kRays; ++ray) {
    const int next = (ray + 1) % kRays;
    disc.faces.emplace_back(0, 1 + ray, 1 + next);
    for (int ring = 0; ring + 1 < kRings; ++ring) {
      const int a = 1 + ring * kRays;
      disc.faces.emplace_back(a + ray, a + kRays + ray, a + kRays + next);
      disc.faces.emplace_back(a + ray, a + kRays + next, a + next);
    }
  }
  return disc;
}

std::vector<Eigen::Vector3d> ringAt(double beyond_mm) {
  std::vector<Eigen::Vector3d> ring;
  for (int ray = 0; ray < kRays; ++ray) {
    const double angle = 2.0 * std::numbers::pi * ray / kRays;
    const double r = outlineRadius(angle) + beyond_mm;
    const double x = kWoundAt.x() + r * std::cos(angle);
    const double y = kWoundAt.y() + r * std::sin(angle);
    ring.push_back(point(x, y, depthAt(x, y)).cast<double>());
  }
  return ring;
}

WoundMeasurement makeNumbers() {
  WoundMeasurement m;
  m.opening_area_mm2 = 363.2;
  m.bed_area_mm2 = 401.7;
  m.projected_area_mm2 = 358.4;
  m.perimeter_mm = 69.94;
  m.volume_mm3 = 812.0;
  m.volume_above_mm3 = 1.0;
  m.mean_depth_mm = 812.0 / 363.2;
  m.max_depth_mm = 3.37;
  m.p99_depth_mm = 3.21;
  m.length_mm = 22.94;
  m.width_mm = 19.38;
  m.length_clock_mm = 21.61;
  m.width_clock_mm = 20.06;
  m.unseen_bed_fraction = 0.023;
  m.intervals = {{"opening_area_mm2", {327.0, 400.0}},
                 {"bed_area_mm2", {360.0, 443.0}},
                 {"projected_area_mm2", {322.0, 395.0}},
                 {"perimeter_mm", {66.9, 73.0}},
                 {"volume_mm3", {700.0, 930.0}},
                 {"mean_depth_mm", {1.98, 2.44}},
                 {"max_depth_mm", {3.05, 3.71}},
                 {"p99_depth_mm", {2.9, 3.5}},
                 {"length_mm", {21.9, 24.0}},
                 {"width_mm", {18.4, 20.4}},
                 {"length_clock_mm", {20.6, 22.6}},
                 {"width_clock_mm", {19.1, 21.1}}};
  m.method = "smooth skin 1.0";
  m.warnings = {
      {"shallow_wound", "Volume / area is 2.2 mm; below 4 mm a volume is less precise than 5 %."}};
  return m;
}

}  // namespace

double outlineRadius(double angle) {
  return 10.6 + 1.2 * std::cos(2.0 * angle + 1.1) + 0.7 * std::sin(3.0 * angle);
}

namespace {

Case buildCase() {
  Case result;
  result.foot = makeFoot();
  result.wound.numbers = makeNumbers();
  result.wound.bed = makeDisc(depthAt);
  result.wound.reference = makeDisc([](double, double) { return 0.0; });
  for (const Eigen::Vector3f& p : result.wound.bed.vertices) {
    const auto x = static_cast<double>(p.x());
    const auto y = static_cast<double>(p.y());
    result.wound.bed_depth_mm.push_back(static_cast<float>(depthAt(x, y)));
  }
  const Eigen::Vector3f deepest = point(
      kWoundAt.x() - 3.0, kWoundAt.y() + 2.0, depthAt(kWoundAt.x() - 3.0, kWoundAt.y() + 2.0));
  result.wound.numbers.max_depth_at_mm = deepest.cast<double>();
  result.wound.outline_mm = ringAt(0.0);
  result.wound.skin_curve_mm = ringAt(2.0);
  result.landmarks = {.heel_mm = {0.0, -110.0, -14.0}, .toe_mm = {0.0, 110.0, -14.0}};
  return result;
}

}  // namespace

const Case& makeCase() {
  static const Case made = buildCase();
  return made;
}

ReportContent makeContent() {
  const Case& sample = makeCase();
  static const ReportContent pictures = illustrate(sample.foot, sample.wound, sample.landmarks);
  ReportContent content = pictures;
  content.title_line = "Simulated foot · forefoot wound 1 · scan of 5 Oct 2026";
  content.quality = {{"Frames tracked", "600 of 600"},
                     {"Tracking residual", "0.34 mm RMS"},
                     {"Keyframes", "22"},
                     {"Surface not seen", "3 %"},
                     {"Voxel", "1.0 mm"},
                     {"Camera", "simulated, 640 × 480"}};
  content.version = "0.1.0";
  content.created = "2026-10-05T16:24:00Z";
  return content;
}

}  // namespace tarsus::sample
