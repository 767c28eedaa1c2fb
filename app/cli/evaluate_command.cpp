#include "app/cli/command.h"
#include "reconstruction/scene/mesh_distance.h"
#include "reconstruction/scene/ply.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

namespace tarsus {
namespace {

struct Arguments {
  std::filesystem::path model;
  std::filesystem::path reference;
  std::filesystem::path heatmap;
  std::string align = "none";
  std::vector<double> region;
};

nlohmann::json toJson(const DistanceStatistics& s) {
  return {
      {"mean", s.mean_mm}, {"rms", s.rms_mm}, {"p95", s.p95_mm}, {"max", s.max_mm}, {"n", s.count}};
}

/// Blue at 0 over white to red at the 99th percentile; grey outside the region.
std::vector<Rgb8> heatColors(const std::vector<float>& distances_mm) {
  std::vector<float> known;
  std::ranges::copy_if(
      distances_mm, std::back_inserter(known), [](float d) { return std::isfinite(d); });
  std::ranges::sort(known);
  const float full = known.empty() ? 1.0F : std::max(1e-6F, known[known.size() * 99 / 100]);
  std::vector<Rgb8> colors;
  for (const float d : distances_mm) {
    if (!std::isfinite(d)) {
      colors.push_back({.r = 190, .g = 190, .b = 190});
      continue;
    }
    const float t = std::clamp(d / full, 0.0F, 1.0F);
    const auto level = [](float x) { return static_cast<std::uint8_t>(std::lround(255.0F * x)); };
    colors.push_back({.r = level(std::min(1.0F, 2.0F * t)),
                      .g = level(1.0F - std::abs(2.0F * t - 1.0F)),
                      .b = level(std::min(1.0F, 2.0F - 2.0F * t))});
  }
  return colors;
}

void print(const char* name, const DistanceStatistics& s) {
  std::printf("%-20s mean %8.4f  rms %8.4f  95 %% %8.4f  max %8.4f mm  (%d samples)\n",
              name,
              s.mean_mm,
              s.rms_mm,
              s.p95_mm,
              s.max_mm,
              s.count);
}

Expected<nlohmann::json> evaluate(const Arguments& arguments, bool printing) {
  auto model = readPly(arguments.model);
  if (!model) {
    return tl::unexpected(model.error());
  }
  auto reference = readPly(arguments.reference);
  if (!reference) {
    return tl::unexpected(reference.error());
  }
  MeshDistanceOptions options;
  options.align_icp = arguments.align == "icp";
  if (arguments.region.size() == 4) {
    const auto& r = arguments.region;
    const bool usable = std::ranges::all_of(r, [](double x) { return std::isfinite(x); });
    if (!usable || r[3] <= 0.0) {
      return fail(ErrorCode::BadOption, "--region needs a point and a radius greater than 0");
    }
    options.region = Ball{.center_mm = {r[0], r[1], r[2]}, .radius_mm = r[3]};
  }
  auto comparison = compareMeshes(model->mesh, reference->mesh, options);
  if (!comparison) {
    return tl::unexpected(comparison.error());
  }
  if (!arguments.heatmap.empty()) {
    TexturedMesh heat = std::move(*model);
    heat.colors = heatColors(comparison->a_vertex_distance_mm);
    if (auto written = writePly(arguments.heatmap, heat); !written) {
      return tl::unexpected(written.error());
    }
  }
  if (printing) {
    print("model to reference", comparison->a_to_b);
    print("reference to model", comparison->b_to_a);
    std::printf("symmetric rms %.4f mm, Hausdorff %.4f mm, within 1 mm %.2f %%\n",
                comparison->symmetric_rms_mm,
                comparison->hausdorff_mm,
                100.0 * comparison->completeness_1mm);
  }
  return nlohmann::json{{"a_to_b", toJson(comparison->a_to_b)},
                        {"b_to_a", toJson(comparison->b_to_a)},
                        {"symmetric_rms", comparison->symmetric_rms_mm},
                        {"hausdorff", comparison->hausdorff_mm},
                        {"completeness_1mm", comparison->completeness_1mm}};
}

}  // namespace

void addEvaluate(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      app, command, "evaluate", "Distances between a model and a reference surface, both ways");
  sub->add_option("MODEL", arguments->model, "PLY, mm")->required();
  sub->add_option("REFERENCE", arguments->reference, "PLY, mm")->required();
  sub->add_option("--align", arguments->align, "none (as posed) or icp (rigid fit first)")
      ->check(CLI::IsMember({"none", "icp"}))
      ->capture_default_str();
  sub->add_option("--region", arguments->region, "Only inside this ball, mm")
      ->delimiter(',')
      ->expected(4)
      ->type_name("X,Y,Z,RADIUS");
  sub->add_option("--heatmap", arguments->heatmap, "Write the model coloured by distance")
      ->type_name("OUT.ply");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) {
      return evaluate(*arguments, !command.quiet && command.json_file != "-");
    };
  });
}

}  // namespace tarsus
