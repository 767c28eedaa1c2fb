#include "app/cli/checks.h"
#include "app/cli/command.h"
#include "app/cli/print_comparison.h"
#include "app/cli/wound_arguments.h"
#include "app/version.h"
#include "measurement/comparison/comparison.h"
#include "measurement/outline/outline.h"
#include "reconstruction/scene/mesh_index.h"

#include <CLI/CLI.hpp>

#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <span>

namespace tarsus {
namespace {

struct Arguments {
  WoundArguments a;
  WoundArguments b;
  std::optional<double> days;
  std::filesystem::path map;
  std::filesystem::path pairs;
  std::vector<std::filesystem::path> callus_a;
  std::vector<std::filesystem::path> callus_b;
};

Expected<Eigen::Vector3d> pointOf(const nlohmann::json& values) {
  if (values.is_array() && values.size() == 3 && values[0].is_number() && values[1].is_number() &&
      values[2].is_number()) {
    const Eigen::Vector3d point(
        values[0].get<double>(), values[1].get<double>(), values[2].get<double>());
    if (point.allFinite()) {
      return point;
    }
  }
  return fail(ErrorCode::BadOption, "a pair needs \"a\" and \"b\", each [x, y, z] in mm");
}

/// {"pairs":[{"a":[x,y,z],"b":[x,y,z]},...]}, mm, each in its own scan frame.
/// @errors FileMissing, BadOption
Expected<std::vector<PointPair>> readPairs(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) {
    return fail(ErrorCode::FileMissing, path.string());
  }
  const auto json = nlohmann::json::parse(file, nullptr, false);
  if (!json.is_object() || !json.contains("pairs") || !json.at("pairs").is_array()) {
    return fail(ErrorCode::BadOption,
                path.string() + R"(: expected {"pairs":[{"a":[x,y,z],"b":[x,y,z]},...]})");
  }
  std::vector<PointPair> pairs;
  for (const auto& entry : json.at("pairs")) {
    const auto a = pointOf(entry.is_object() ? entry.value("a", nlohmann::json()) : entry);
    const auto b = pointOf(entry.is_object() ? entry.value("b", nlohmann::json()) : entry);
    if (!a || !b) {
      return fail(ErrorCode::BadOption, path.string() + ": " + (a ? b : a).error().detail);
    }
    pairs.push_back({.a_mm = *a, .b_mm = *b});
  }
  return pairs;
}

/// Curves around callus and whatever else does not stay as it is.
Expected<std::vector<WoundOutline>> readLeftOut(const std::vector<std::filesystem::path>& files,
                                                const TexturedMesh& foot) {
  std::vector<WoundOutline> curves;
  if (files.empty()) {
    return curves;
  }
  const MeshIndex index(foot.mesh);
  for (const auto& path : files) {
    const auto file = readOutlineFile(path);
    auto curve = file ? outlineOn(foot, index, *file) : tl::unexpected(file.error());
    if (!curve) {
      return fail(curve.error().code, path.string() + ": " + curve.error().detail);
    }
    curves.push_back(std::move(*curve));
  }
  return curves;
}

MeasuredVisit visitOf(const MeasuredModel& model, std::span<const WoundOutline> left_out) {
  return {.surface = {.foot = model.foot,
                      .outline = model.outline,
                      .landmarks = model.landmarks,
                      .left_out = left_out},
          .numbers = model.wound.numbers};
}

/// Warnings of both visits, told apart.
nlohmann::json warningsOf(const MeasuredModel& a, const MeasuredModel& b) {
  nlohmann::json list = nlohmann::json::array();
  for (const auto& [visit, model] : {std::pair("earlier", &a), std::pair("later", &b)}) {
    for (const Warning& warning : model->wound.numbers.warnings) {
      list.push_back({{"code", warning.code}, {"text", warning.text}, {"visit", visit}});
    }
  }
  return list;
}

Expected<nlohmann::json> compare(const Arguments& arguments, bool printing) {
  ComparisonOptions options;
  if (!arguments.pairs.empty()) {
    auto pairs = readPairs(arguments.pairs);
    if (!pairs) {
      return tl::unexpected(pairs.error());
    }
    options.pairs = std::move(*pairs);
    if (options.pairs.size() < 3) {
      return fail(ErrorCode::BadOption, arguments.pairs.string() + ": at least 3 pairs are needed");
    }
  }
  const auto a = measureFiles(arguments.a);
  if (!a) {
    return fail(a.error().code, "earlier visit: " + a.error().detail);
  }
  const auto b = measureFiles(arguments.b);
  if (!b) {
    return fail(b.error().code, "later visit: " + b.error().detail);
  }
  const auto callus_a = readLeftOut(arguments.callus_a, a->foot);
  const auto callus_b = readLeftOut(arguments.callus_b, b->foot);
  if (!callus_a || !callus_b) {
    return tl::unexpected(!callus_a ? callus_a.error() : callus_b.error());
  }
  const auto comparison =
      compareVisits(visitOf(*a, *callus_a), visitOf(*b, *callus_b), arguments.days, options);
  if (!comparison) {
    return tl::unexpected(comparison.error());
  }
  if (!arguments.map.empty() && comparison->map) {
    if (auto written = writeChangeMap(arguments.map, *comparison->map); !written) {
      return tl::unexpected(written.error());
    }
  }
  if (printing) {
    printComparison(*comparison, a->wound.numbers, b->wound.numbers);
    if (!arguments.map.empty()) {
      std::printf("%s\n",
                  comparison->map ? ("Wrote " + arguments.map.string()).c_str()
                                  : ("No map: " + comparison->why_no_map).c_str());
    }
  }
  nlohmann::json result = toJson(*comparison);
  result["days"] = arguments.days ? nlohmann::json(*arguments.days) : nlohmann::json(nullptr);
  result["version"] = TARSUS_VERSION;
  result["model_a_sha256"] = a->foot.sha256;
  result["model_b_sha256"] = b->foot.sha256;
  result["warnings"] = warningsOf(*a, *b);
  return result;
}

/// The options of one visit, with its letter at their end.
void addVisit(CLI::App& sub, const std::string& letter, WoundArguments& visit) {
  const std::string which = letter == "a" ? "earlier" : "later";
  const std::string capital = letter == "a" ? "A" : "B";
  sub.add_option("MODEL_" + capital, visit.model, "model.ply of the " + which + " visit, mm")
      ->required();
  sub.add_option("OUTLINE_" + capital, visit.outline, "its wound outline (JSON, scan frame, mm)")
      ->required();
  sub.add_option("--skin-" + letter, visit.skin_curve, "Skin curve of the " + which + " visit")
      ->type_name("FILE");
  auto* heel = sub.add_option("--heel-" + letter, visit.heel_mm, "Heel landmark of that visit")
                   ->delimiter(',')
                   ->expected(3)
                   ->type_name("X,Y,Z");
  auto* toe = sub.add_option("--toe-" + letter, visit.toe_mm, "Toe landmark of that visit")
                  ->delimiter(',')
                  ->expected(3)
                  ->type_name("X,Y,Z")
                  ->needs(heel);
  heel->needs(toe);
}

}  // namespace

void addCompare(CLI::App& app, Command& command) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* sub = addCommand(
      app, command, "compare", "Compare two visits of one wound: change, rates, change map");
  addVisit(*sub, "a", arguments->a);
  addVisit(*sub, "b", arguments->b);
  sub->add_option("--callus-a",
                  arguments->callus_a,
                  "Curves around callus of the earlier visit: left out when the skin is laid over")
      ->type_name("FILE");
  sub->add_option("--callus-b", arguments->callus_b, "The same of the later visit")
      ->type_name("FILE");
  sub->add_option("--days", arguments->days, "Days between the visits, for rates by week")
      ->check(inRange(1e-6, 1e9));
  sub->add_option("--map", arguments->map, "Write the signed change map here")
      ->type_name("OUT.ply");
  sub->add_option(
         "--pairs", arguments->pairs, "Three or more pairs of points set by hand, to start from")
      ->type_name("FILE");
  sub->callback([&command, arguments] {
    command.run = [&command, arguments](const Job& /*job*/) {
      return compare(*arguments, !command.quiet && command.json_file != "-");
    };
  });
}

}  // namespace tarsus
