#include "tests/measurement/wound/bench_wounds.h"

#include "measurement/outline/curve_distance.h"
#include "measurement/wound/wound_site.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "tests/measurement/wound/measured.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace tarsus::test {
namespace {

double weightedPercentile(std::vector<std::pair<double, double>> depth_area) {
  std::sort(depth_area.rbegin(), depth_area.rend());
  double all = 0.0;
  for (const auto& [depth, area] : depth_area) {
    all += area;
  }
  double above = 0.0;
  for (const auto& [depth, area] : depth_area) {
    above += area;
    if (above >= 0.01 * all) {
      return depth;
    }
  }
  return 0.0;
}

/// Depth and area of the bed in fine polar cells.
double percentileOf(const Skin& skin, const Relief& relief, double radius_mm) {
  constexpr int kRings = 400;
  constexpr int kSpokes = 90;
  std::vector<std::pair<double, double>> cells;
  const auto bed = [&](double r, double a) {
    const SkinPoint p = skin(r * std::cos(a), r * std::sin(a));
    return Eigen::Vector3d(p.position - relief(r * std::cos(a), r * std::sin(a)) * p.normal);
  };
  for (int ring = 0; ring < kRings; ++ring) {
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double r = radius_mm * (ring + 0.5) / kRings;
      const double a = 2.0 * std::numbers::pi * (spoke + 0.5) / kSpokes;
      const double dr = 0.5 * radius_mm / kRings;
      const double da = std::numbers::pi / kSpokes;
      const Eigen::Vector3d across = bed(r + dr, a) - bed(r - dr, a);
      const Eigen::Vector3d along = bed(r, a + da) - bed(r, a - da);
      cells.emplace_back(relief(r * std::cos(a), r * std::sin(a)), across.cross(along).norm());
    }
  }
  return weightedPercentile(std::move(cells));
}

TexturedMesh withSigma(TexturedMesh foot, double sigma_mm) {
  foot = withQuality(std::move(foot));
  foot.sigma_mm.assign(foot.mesh.vertices.size(), static_cast<float>(std::max(0.02, sigma_mm)));
  return foot;
}

BenchWound idealWound(
    const std::string& name, const Skin& skin, double radius_mm, double depth_mm, double edge_mm) {
  const Relief relief = bowl(radius_mm, depth_mm);
  const WoundTruth t = truthInside(skin, relief, radius_mm);
  BenchWound wound;
  wound.name = name;
  wound.truth = {{"opening_area_mm2", t.opening_mm2},
                 {"bed_area_mm2", t.bed_mm2},
                 {"perimeter_mm", t.perimeter_mm},
                 {"volume_mm3", t.volume_mm3},
                 {"volume_above_mm3", 0.0},
                 {"mean_depth_mm", t.volume_mm3 / t.opening_mm2},
                 {"max_depth_mm", depth_mm},
                 {"p99_depth_mm", percentileOf(skin, relief, radius_mm)}};
  wound.model = [=](double noise_mm, std::uint64_t seed) {
    return withSigma(woundMesh(skin,
                               relief,
                               {.half_size_mm = radius_mm + 26.0,
                                .edge_mm = edge_mm,
                                .seed = seed,
                                .noise_mm = noise_mm}),
                     noise_mm);
  };
  wound.outline = [=](double outward_mm) {
    return circleOn(skin, relief, radius_mm + outward_mm, 180);
  };
  return wound;
}

/// The faces with a vertex in the ball.
TriangleMesh around(const TriangleMesh& mesh, const Eigen::Vector3d& center, double radius_mm) {
  const SurfacePatch patch = extractPatch(mesh, center, radius_mm);
  TriangleMesh part;
  for (const auto& v : patch.vertices) {
    part.vertices.push_back(v.cast<float>());
  }
  for (const auto& f : patch.faces) {
    part.faces.emplace_back(f[0], f[1], f[2]);
  }
  part.normals = vertexNormals(part);
  return part;
}

BenchWound simulatedWound(const std::string& name, const SimulatedScene& scene, int which) {
  constexpr double kAround_mm = 60.0;
  const tarsus::WoundTruth& t = scene.wounds[static_cast<std::size_t>(which)];
  const auto part =
      std::make_shared<TriangleMesh>(around(scene.foot.mesh, t.center_mm, kAround_mm));
  const auto calm = std::make_shared<TexturedMesh>();
  calm->mesh = *part;
  *calm = withHash(std::move(*calm));
  BenchWound wound;
  wound.name = name;
  wound.truth = {{"opening_area_mm2", t.opening_area_mm2},
                 {"bed_area_mm2", t.bed_area_mm2},
                 {"projected_area_mm2", t.projected_area_mm2},
                 {"perimeter_mm", t.perimeter_mm},
                 {"volume_mm3", t.volume_mm3},
                 {"volume_above_mm3", 0.0},
                 {"mean_depth_mm", t.mean_depth_mm},
                 {"max_depth_mm", t.max_depth_mm},
                 {"p99_depth_mm", t.p99_depth_mm},
                 {"length_mm", t.length_mm},
                 {"width_mm", t.width_mm}};
  wound.model = [part](double noise_mm, std::uint64_t seed) {
    const CorrelatedNoise noise(noise_mm, 1.5, seed);
    TexturedMesh foot;
    foot.mesh = *part;
    for (std::size_t i = 0; noise_mm > 0.0 && i < foot.mesh.vertices.size(); ++i) {
      foot.mesh.vertices[i] +=
          static_cast<float>(noise.at(part->vertices[i].cast<double>())) * part->normals[i];
    }
    foot.mesh.normals = vertexNormals(foot.mesh);
    return withSigma(withHash(std::move(foot)), noise_mm);
  };
  wound.outline = [calm, outline = t.outline_mm](double outward_mm) {
    if (outward_mm == 0.0) {
      return outline;
    }
    const auto traced = traceOutline(*calm, MeshIndex(calm->mesh), outline);
    const auto site = openSite(*calm, *traced, std::nullopt, {});
    const auto level = levelCurve(site->patch, site->outline_distance_mm, outward_mm);
    return positionsOf(site->patch, level->curve);
  };
  return wound;
}

}  // namespace

std::vector<BenchWound> idealWounds(double edge_mm, double radius_mm) {
  std::vector<BenchWound> wounds;
  const double toe_mm = std::min(radius_mm, 5.0);
  wounds.push_back(idealWound("plane", planeSkin(), radius_mm, 3.0, edge_mm));
  wounds.push_back(idealWound("cylinder R44", cylinderSkin(44.0), radius_mm, 3.0, edge_mm));
  wounds.push_back(idealWound("sphere R44", sphereSkin(44.0), radius_mm, 3.0, edge_mm));
  wounds.push_back(idealWound("sphere R30", sphereSkin(30.0), radius_mm, 3.0, edge_mm));
  wounds.push_back(idealWound("toe R15", cylinderSkin(15.0), toe_mm, 2.0, edge_mm));
  return wounds;
}

std::vector<BenchWound> simulatedWounds() {
  std::vector<BenchWound> wounds;
  for (const FootCase foot :
       {FootCase::Forefoot, FootCase::Heel, FootCase::Lateral, FootCase::Two}) {
    SimulatorOptions options;
    options.foot = foot;
    const auto scene = buildScene(options);
    for (int i = 0; scene && i < static_cast<int>((*scene)->wounds.size()); ++i) {
      wounds.push_back(
          simulatedWound(std::string(nameOf(foot)) + (i > 0 ? ", second" : ""), **scene, i));
    }
  }
  return wounds;
}

Expected<MeasuredWound> measureBench(const BenchWound& wound,
                                     const TexturedMesh& model,
                                     double outline_mm,
                                     double skin_curve_mm) {
  MeasureOptions options;
  options.skin_curve_offset_mm = std::max(0.0, options.skin_curve_offset_mm + skin_curve_mm);
  return measured(model, wound.outline(outline_mm), {}, {}, options);
}

double valueOf(const WoundMeasurement& numbers, const std::string& name) {
  return toJson(numbers).at(name).get<double>();
}

}  // namespace tarsus::test
