// How well tissue proposed by colour agrees with what the simulator painted, on reconstructed
// models, in other light and on other skin.
// Usage: tarsus-bench-tissue [--pictures DIR] FOLDER...   FOLDER holds model/model.ply and truth/
#include "measurement/wound/tissue_color.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/capture/image_file.h"
#include "reconstruction/capture/simulator/simulator.h"
#include "reconstruction/scene/mesh_index.h"
#include "reconstruction/scene/mesh_picture.h"
#include "reconstruction/scene/ply.h"
#include "tests/measurement/wound/relit.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>
#include <optional>

namespace tarsus {
namespace {

namespace fs = std::filesystem;

struct Wound {
  std::string name;
  TexturedMesh foot;
  TissueBed bed;
  std::vector<std::optional<Tissue>> truth;  ///< #V of the bed
  nlohmann::json fractions;
};

std::optional<Tissue> asTissue(BedTissue tissue) {
  switch (tissue) {
    case BedTissue::Granulation:
      return Tissue::Granulation;
    case BedTissue::Slough:
      return Tissue::Slough;
    case BedTissue::Necrosis:
      return Tissue::Necrosis;
    case BedTissue::Epithelium:
      return Tissue::Epithelium;
    case BedTissue::None:
      break;
  }
  return std::nullopt;
}

/// What was painted at the true vertex nearest to each vertex of the bed.
std::vector<std::optional<Tissue>> truthOn(const TissueBed& bed,
                                           const SimulatedScene& scene,
                                           const MeshIndex& index) {
  std::vector<std::optional<Tissue>> truth;
  for (const Eigen::Vector3d& p : bed.positions_mm) {
    truth.emplace_back();
    if (const auto nearest = index.nearest(p, 3.0)) {
      const Eigen::Vector3i& face = scene.foot.mesh.faces[nearest->point.face];
      int corner = 0;
      nearest->point.barycentric.maxCoeff(&corner);
      truth.back() = asTissue(scene.tissue[static_cast<std::size_t>(face[corner])]);
    }
  }
  return truth;
}

template <typename T>
T orStop(Expected<T> value) {
  if (!value) {
    std::cerr << describe(value.error()) << '\n';
    std::exit(1);
  }
  return std::move(*value);
}

std::vector<Wound> woundsIn(const fs::path& folder) {
  const auto facts = nlohmann::json::parse(orStop(readTextFile(folder / "truth/truth.json")));
  const auto& said = facts.at("options");
  SimulatorOptions options;
  options.foot = footCaseNamed(said.at("foot").get<std::string>()).value();
  options.path = cameraPathNamed(said.at("path").get<std::string>()).value();
  options.layout = cameraLayoutNamed(said.at("camera").get<std::string>()).value();
  options.frames = said.at("frames");
  options.seed = said.at("seed");
  options.jitter_mm = said.at("jitter_mm");
  const auto scene = orStop(buildScene(options));
  const MeshIndex truth_index(scene->foot.mesh);
  const TexturedMesh foot = orStop(readPly(folder / "model/model.ply"));
  const MeshIndex index(foot.mesh);
  std::vector<Wound> wounds;
  for (std::size_t i = 0; i < scene->wounds.size(); ++i) {
    const auto points =
        orStop(readOutlinePoints(folder / ("truth/outline_" + std::to_string(i + 1) + ".json")));
    Wound wound;
    wound.name = folder.filename().string() + " " + std::to_string(i + 1);
    const auto outline = traceOutline(foot, index, points);
    if (!outline) {
      std::printf("| %s | %s |\n", wound.name.c_str(), outline.error().detail.c_str());
      continue;
    }
    wound.foot = foot;
    wound.bed = orStop(openTissueBed(foot, *outline));
    wound.truth = truthOn(wound.bed, *scene, truth_index);
    wound.fractions = scene->wounds[i].tissue_fraction;
    wounds.push_back(std::move(wound));
  }
  return wounds;
}

/// Area of the bed on which proposal and truth agree, of that which was seen.
double agreement(const Wound& wound, const TissueMap& map) {
  double same = 0.0;
  double all = 0.0;
  for (std::size_t v = 0; v < wound.bed.mesh_vertex.size(); ++v) {
    if (wound.truth[v] && wound.bed.unseen[v] == 0) {
      all += wound.bed.area_mm2[v];
      same += map.vertices.at(wound.bed.mesh_vertex[v]) == *wound.truth[v] ? wound.bed.area_mm2[v]
                                                                           : 0.0;
    }
  }
  return same / all;
}

void printRow(const Wound& wound, const test::Light& light) {
  TexturedMesh foot = test::relit(wound.foot, wound.bed, light);
  TissueBed bed = wound.bed;
  bed.mesh_sha256 = foot.sha256;
  const auto map = proposeTissue(foot, bed);
  std::printf("| %s | %s |", wound.name.c_str(), light.name);
  if (!map) {
    std::printf(" %s |\n", map.error().detail.c_str());
    return;
  }
  const TissueShares shares = orStop(sharesOf(bed, *map));
  for (std::size_t t = 0; t < kTissues; ++t) {
    const std::string name(nameOf(static_cast<Tissue>(t)));
    if (wound.fractions.contains(name)) {
      std::printf(" %.1f / %d |", 100.0 * wound.fractions[name].get<double>(), shares.percent[t]);
    } else {
      std::printf(" - / %d |", shares.percent[t]);
    }
  }
  std::printf(" %.1f |\n", 100.0 * agreement(wound, *map));
}

Rgb8 colorOf(const std::optional<Tissue>& tissue) {
  constexpr std::array<Rgb8, kTissues> kColors{{{.r = 213, .g = 94, .b = 0},
                                                {.r = 240, .g = 228, .b = 66},
                                                {.r = 0, .g = 0, .b = 0},
                                                {.r = 204, .g = 121, .b = 167},
                                                {.r = 86, .g = 180, .b = 233}}};
  return tissue ? kColors[static_cast<std::size_t>(*tissue)] : Rgb8{.r = 128, .g = 128, .b = 128};
}

/// Three pictures side by side: colours, truth, proposal.
void writePictures(const Wound& wound, const fs::path& folder) {
  const TissueMap map = orStop(proposeTissue(wound.foot, wound.bed));
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  Eigen::Vector3d outward = Eigen::Vector3d::Zero();
  for (std::size_t v = 0; v < wound.bed.mesh_vertex.size(); ++v) {
    middle += wound.bed.positions_mm[v] / static_cast<double>(wound.bed.mesh_vertex.size());
    outward += wound.foot.mesh.normals[wound.bed.mesh_vertex[v]].cast<double>();
  }
  PictureOptions options{.width_px = 600, .height_px = 600, .shading = 0.15};
  ViewFrame view;
  view.center_mm = middle;
  view.right = outward.unitOrthogonal();
  view.up = outward.normalized().cross(view.right);
  view.mm_per_px = 0.065;
  std::array<std::vector<Rgb8>, 3> colors{wound.foot.colors, wound.foot.colors, wound.foot.colors};
  for (std::size_t v = 0; v < wound.bed.mesh_vertex.size(); ++v) {
    const std::uint32_t at = wound.bed.mesh_vertex[v];
    colors[1][at] = colorOf(wound.truth[v]);
    colors[2][at] = colorOf(map.vertices.at(at));
  }
  ColorImage all(3 * options.width_px, options.height_px);
  for (int k = 0; k < 3; ++k) {
    const ColorImage one = takePicture(wound.foot.mesh, colors[k], view, options);
    for (int v = 0; v < options.height_px; ++v) {
      for (int u = 0; u < options.width_px; ++u) {
        all.at(k * options.width_px + u, v) = one.at(u, v);
      }
    }
  }
  if (auto written = writeColorImage(folder / (wound.name + ".png"), all); !written) {
    std::cerr << describe(written.error()) << '\n';
  }
}

int run(const std::vector<std::string>& arguments) {
  fs::path pictures;
  std::printf(
      "| wound | light | granulation | slough | necrosis | epithelium | other | agree %% |\n");
  std::printf("|---|---|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i] == "--pictures" && i + 1 < arguments.size()) {
      pictures = arguments[++i];
      continue;
    }
    for (const Wound& wound : woundsIn(arguments[i])) {
      for (const test::Light& light : test::lights()) {
        printRow(wound, light);
      }
      if (!pictures.empty()) {
        writePictures(wound, pictures);
      }
    }
  }
  return 0;
}

}  // namespace
}  // namespace tarsus

int main(int argc, char** argv) { return tarsus::run({argv + 1, argv + argc}); }
