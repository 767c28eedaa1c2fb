#include "measurement/phantom/phantom_kit.h"

#include "measurement/phantom/phantom_guide.h"
#include "measurement/phantom/phantom_mesh.h"
#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/sha256.h"
#include "reconstruction/scene/stl.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <numbers>
#include <span>

namespace tarsus {
namespace {

using Eigen::Vector3d;
using nlohmann::json;
namespace fs = std::filesystem;

constexpr const char* kFormat = "tarsus phantom";
constexpr int kFormatVersion = 1;
constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kCurveStep_mm = 0.5;

std::string sha256Of(std::string_view bytes) {
  Sha256 sum;
  sum.update(std::as_bytes(std::span(bytes)));
  return sum.hex();
}

/// The skin's circle at `r` around a wound.
struct SkinCircle {
  std::vector<Vector3d> points;
  std::vector<Vector3d> normals;
};
SkinCircle circleOn(const PhantomWound& wound, double r_mm) {
  const int count = static_cast<int>(std::ceil(kTurn * r_mm / kCurveStep_mm));
  SkinCircle circle;
  for (int i = 0; i < count; ++i) {
    const double angle = kTurn * i / count;
    circle.points.emplace_back(wound.phantom_from_wound *
                               skinPoint(wound.crater.skin, r_mm, angle));
    circle.normals.emplace_back(wound.phantom_from_wound.linear() *
                                skinNormal(wound.crater.skin, r_mm, angle));
  }
  return circle;
}

TrueValues truthOf(const Crater& crater) {
  const CraterValues v = exactValues(crater);
  return {{"opening_area_mm2", v.opening_area_mm2},
          {"bed_area_mm2", v.bed_area_mm2},
          {"perimeter_mm", v.perimeter_mm},
          {"volume_mm3", v.volume_mm3},
          {"mean_depth_mm", v.mean_depth_mm},
          {"max_depth_mm", v.max_depth_mm},
          {"p99_depth_mm", v.max_depth_mm}};
}

json toJson(const std::vector<Vector3d>& vectors) {
  json list = json::array();
  for (const Vector3d& v : vectors) {
    list.push_back({v.x(), v.y(), v.z()});
  }
  return list;
}

json curveJson(const std::vector<Vector3d>& curve) {
  return {{"frame", "phantom"}, {"unit", "mm"}, {"closed", true}, {"points", toJson(curve)}};
}

const char* nameOf(SkinForm form) {
  switch (form) {
    case SkinForm::Plane:
      return "plane";
    case SkinForm::Cylinder:
      return "cylinder";
    case SkinForm::Sphere:
      return "sphere";
  }
  return "";
}

json woundJson(const PhantomWound& design, const KnownWound& wound) {
  const Crater& crater = design.crater;
  json outline = curveJson(wound.outline_mm);
  outline["normals"] = toJson(wound.outline_normals);
  json skin{{"form", nameOf(crater.skin.form)}};
  if (crater.skin.form != SkinForm::Plane) {
    skin["radius_mm"] = crater.skin.radius_mm;
  }
  return {{"name", wound.name},
          {"site", wound.site},
          {"skin", skin},
          {"crater",
           {{"radius_mm", crater.radius_mm},
            {"floor_radius_mm", crater.floor_radius_mm},
            {"depth_mm", crater.depth_mm},
            {"wall_angle_degrees", wallAngle(crater) * 360.0 / kTurn}}},
          {"outline", outline},
          {"skin_curve", curveJson(wound.skin_curve_mm)},
          {"true", wound.truth}};
}

json phantomJson(const PhantomDesign& design, const Phantom& phantom, std::string_view version) {
  json wounds = json::array();
  for (std::size_t i = 0; i < phantom.wounds.size(); ++i) {
    wounds.push_back(woundJson(design.wounds[i], phantom.wounds[i]));
  }
  json distances = json::array();
  for (const ControlDistance& distance : design.control_distances) {
    distances.push_back({{"what", distance.what},
                         {"mm", distance.mm},
                         {"tolerance_mm", controlTolerance_mm(distance.mm)}});
  }
  return {{"format", kFormat},
          {"format_version", kFormatVersion},
          {"name", design.name},
          {"title", design.title},
          {"unit", "mm"},
          {"frame", "z up from the printed base at z = 0"},
          {"stl", design.name + ".stl"},
          {"stl_sha256", phantom.stl_sha256},
          {"wounds", wounds},
          {"printing",
           {{"base", "flat side down, no support"},
            {"layer_height_mm", kLayerHeight_mm},
            {"surface", "matt, light, one colour"},
            {"control_distances", distances}}},
          {"version", version}};
}

std::vector<Vector3d> vectorsFrom(const json& list) {
  std::vector<Vector3d> vectors;
  for (const json& v : list) {
    vectors.emplace_back(v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>());
  }
  return vectors;
}

/// @throws json::exception
Phantom phantomFrom(const json& document) {
  Phantom phantom;
  document.at("name").get_to(phantom.name);
  document.at("stl_sha256").get_to(phantom.stl_sha256);
  for (const json& entry : document.at("wounds")) {
    KnownWound wound{.name = entry.at("name").get<std::string>(),
                     .site = entry.at("site").get<std::string>(),
                     .outline_mm = vectorsFrom(entry.at("outline").at("points")),
                     .outline_normals = vectorsFrom(entry.at("outline").at("normals")),
                     .skin_curve_mm = vectorsFrom(entry.at("skin_curve").at("points")),
                     .truth = entry.at("true").get<TrueValues>()};
    for (const char* key : {"opening_area_mm2", "volume_mm3", "p99_depth_mm", "perimeter_mm"}) {
      if (!(wound.truth.at(key) > 0.0)) {
        throw std::out_of_range(key);
      }
    }
    if (wound.outline_normals.size() != wound.outline_mm.size()) {
      throw std::out_of_range("normals");
    }
    phantom.wounds.push_back(std::move(wound));
  }
  return phantom;
}

}  // namespace

Phantom phantomOf(const PhantomDesign& design) {
  Phantom phantom;
  phantom.name = design.name;
  phantom.mesh = meshOf(design);
  phantom.stl_sha256 = sha256Of(stlBytes(phantom.mesh));
  for (const PhantomWound& wound : design.wounds) {
    SkinCircle rim = circleOn(wound, wound.crater.radius_mm);
    phantom.wounds.push_back(
        {.name = wound.name,
         .site = wound.site,
         .outline_mm = std::move(rim.points),
         .outline_normals = std::move(rim.normals),
         .skin_curve_mm = circleOn(wound, wound.crater.radius_mm + kSkinCurveOffset_mm).points,
         .truth = truthOf(wound.crater)});
  }
  return phantom;
}

Expected<std::vector<fs::path>> writePhantomKit(const fs::path& folder, std::string_view version) {
  const std::vector<PhantomDesign> designs = phantomDesigns();
  std::vector<fs::path> written;
  for (const PhantomDesign& design : designs) {
    const Phantom phantom = phantomOf(design);
    const fs::path stl = folder / (design.name + ".stl");
    const std::string bytes = stlBytes(phantom.mesh);
    const json facts = phantomJson(design, phantom, version);
    auto done = writeFileAtomically(stl, std::as_bytes(std::span(bytes)));
    if (done) {
      done = writeTextAtomically(folder / (design.name + ".phantom.json"), facts.dump(1) + '\n');
    }
    if (!done) {
      return tl::unexpected(done.error());
    }
    written.push_back(stl);
  }
  if (auto done = writeTextAtomically(folder / "PHANTOM.txt", phantomGuide(designs)); !done) {
    return tl::unexpected(done.error());
  }
  return written;
}

Expected<Phantom> readPhantom(const fs::path& path) {
  const auto refuse = [&](const std::string& why) {
    return fail(ErrorCode::FileUnreadable, path.string() + ": " + why);
  };
  const auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const json document = json::parse(*text, nullptr, false);
  if (!document.is_object() || document.value("format", json()) != kFormat) {
    return refuse("not a NAME.phantom.json as the command phantom writes them");
  }
  if (document.value("format_version", json()) != kFormatVersion) {
    return refuse("written by another version of the program; make the phantom's files again");
  }
  try {
    Phantom phantom = phantomFrom(document);
    const fs::path stl =
        path.parent_path() / fs::path(document.at("stl").get<std::string>()).filename();
    const auto bytes = readTextFile(stl);
    if (!bytes) {
      return tl::unexpected(bytes.error());
    }
    if (sha256Of(*bytes) != phantom.stl_sha256) {
      return refuse(stl.string() + " is not the surface that it describes; make both again");
    }
    auto mesh = parseStl(*bytes, stl.string());
    if (!mesh) {
      return tl::unexpected(mesh.error());
    }
    phantom.mesh = std::move(*mesh);
    return phantom.wounds.empty() ? Expected<Phantom>(refuse("it has no wounds")) : phantom;
  } catch (const std::exception& missing) {
    return refuse(std::string("damaged (") + missing.what() + ")");
  }
}

}  // namespace tarsus
