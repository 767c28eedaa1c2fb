/// Decides which reference skin is the default: error of the volume under the rebuilt skin, in
/// per cent of a bowl wound's volume, mean and standard deviation over seeds.
/// Run: tarsus-bench-reference-skin [seeds]

#include "measurement/wound/reference_skin.h"
#include "tests/measurement/outline/wound_surface.h"
#include "tests/measurement/wound/foot_skin_bench.h"
#include "tests/measurement/wound/thin_plate.h"
#include "tests/support/shared_data.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <string>

namespace {

using namespace tarsus;

struct Case {
  std::string name;
  test::Skin skin;
  double radius_mm;
  double depth_mm;
};

/// Height of the rebuilt skin over a true skin point, along the normal [mm].
using Miss = std::function<double(const test::SkinPoint&)>;
using Method = std::function<Miss(const std::vector<SkinSample>&)>;

Method annulusFit(const ReferenceSkinOptions& options) {
  return [options](const std::vector<SkinSample>& samples) -> Miss {
    const auto skin = fitReferenceSkin(samples, Eigen::Vector3d::Zero(), options);
    if (!skin) {
      return [](const auto&) { return std::nan(""); };
    }
    return [skin = *skin](const test::SkinPoint& p) { return skin.footOf(p.position).depth_mm; };
  };
}

Method plate(double length_mm) {
  return [length_mm](const std::vector<SkinSample>& samples) -> Miss {
    const auto height = test::thinPlate(samples, length_mm);
    return [height](const test::SkinPoint& p) {
      return (height(p.position.head<2>()) - p.position.z()) * p.normal.z();
    };
  };
}

/// Skin around the wound: vertices of a jittered 1 mm grid between skin curve and annulus' end.
std::vector<SkinSample> annulus(const Case& c, double noise_mm, std::uint64_t seed) {
  constexpr double kOffset_mm = 2.0;
  constexpr double kAnnulus_mm = 8.0;
  const test::CorrelatedNoise noise(noise_mm, 1.5, seed);
  test::Dice dice(seed);
  std::vector<SkinSample> samples;
  const int reach = static_cast<int>(c.radius_mm + kOffset_mm + kAnnulus_mm) + 1;
  for (int j = -reach; j <= reach; ++j) {
    for (int i = -reach; i <= reach; ++i) {
      const double s = i + dice.uniform(-0.3, 0.3);
      const double t = j + dice.uniform(-0.3, 0.3);
      const double outside = std::hypot(s, t) - c.radius_mm - kOffset_mm;
      if (outside < 0.0 || outside > kAnnulus_mm) {
        continue;
      }
      const test::SkinPoint p = c.skin(s, t);
      samples.push_back({.position_mm = p.position + noise.at(p.position) * p.normal,
                         .normal = p.normal,
                         .area_mm2 = 1.0,
                         .sigma_mm = 0.2,
                         .outside_mm = outside});
    }
  }
  return samples;
}

double volumeError_percent(const Case& c, const Miss& miss) {
  constexpr int kRings = 24;
  constexpr int kSpokes = 48;
  double error = 0.0;
  double opening = 0.0;
  for (int ring = 0; ring < kRings; ++ring) {
    for (int spoke = 0; spoke < kSpokes; ++spoke) {
      const double r = c.radius_mm * (ring + 0.5) / kRings;
      const double a = 2.0 * std::numbers::pi * spoke / kSpokes;
      error += r * miss(c.skin(r * std::cos(a), r * std::sin(a)));
      opening += r;
    }
  }
  const double area = std::numbers::pi * c.radius_mm * c.radius_mm;
  return 100.0 * (error / opening) * area / (0.5 * area * c.depth_mm);
}

void printRow(const Case& c, double noise_mm, const std::vector<Method>& methods, int seeds) {
  std::printf("| %s a%g d%g | %.1f |", c.name.c_str(), c.radius_mm, c.depth_mm, noise_mm);
  for (const Method& method : methods) {
    double sum = 0.0;
    double squares = 0.0;
    const int runs = noise_mm > 0.0 ? seeds : 1;
    for (int seed = 1; seed <= runs; ++seed) {
      const double e =
          volumeError_percent(c, method(annulus(c, noise_mm, static_cast<std::uint64_t>(seed))));
      sum += e;
      squares += e * e;
    }
    const double mean = sum / runs;
    const double variance = runs > 1 ? (squares - runs * mean * mean) / (runs - 1) : 0.0;
    std::printf(" %+.1f ± %.1f |", mean, std::sqrt(std::max(0.0, variance)));
  }
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  if (const auto foot = tarsus::sharedData("foot")) {
    tarsus::test::benchFoot(*foot / "template.obj");
  }
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 20;
  std::vector<Case> cases;
  for (const double a : {5.0, 10.0, 15.0}) {
    cases.push_back({"plane", test::planeSkin(), a, 3.0});
    cases.push_back({"cylinder R44", test::cylinderSkin(44.0), a, 3.0});
    cases.push_back({"sphere R44", test::sphereSkin(44.0), a, 3.0});
    cases.push_back({"sphere R30", test::sphereSkin(30.0), a, 3.0});
    cases.push_back({"saddle R40", test::saddleSkin(40.0), a, 3.0});
  }
  cases.push_back({"toe R15", test::cylinderSkin(15.0), 5.0, 2.0});
  constexpr double kNoTaper_mm = 1e9;
  const std::vector<std::pair<std::string, Method>> methods{
      {"quadratic",
       annulusFit({.taper_mm = kNoTaper_mm, .departure_mm = 0.0, .degree = 2, .biconic = false})},
      {"quartic",
       annulusFit({.taper_mm = kNoTaper_mm, .departure_mm = 0.0, .degree = 4, .biconic = false})},
      {"soft plate 2 mm", plate(2.0)},
      {"biconic alone", annulusFit({.taper_mm = kNoTaper_mm, .degree = 1})},
      {"biconic, no taper", annulusFit({.taper_mm = kNoTaper_mm})},
      {"biconic (default)", annulusFit({})}};
  std::printf("| skin, wound | noise mm |");
  for (const auto& [name, method] : methods) {
    std::printf(" %s |", name.c_str());
  }
  std::printf("\n|---|---|");
  std::vector<Method> in_order;
  for (const auto& [name, method] : methods) {
    std::printf("---|");
    in_order.push_back(method);
  }
  std::printf("\n");
  for (const Case& c : cases) {
    for (const double noise_mm : {0.0, 0.1, 0.2, 0.3}) {
      printRow(c, noise_mm, in_order, seeds);
    }
  }
}
