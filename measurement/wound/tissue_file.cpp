#include "measurement/wound/tissue.h"
#include "reconstruction/base/atomic_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <limits>

namespace tarsus {
namespace {

using nlohmann::json;

/// The vertices of one class into the map, or why they cannot be used.
std::string addVertices(const json& list, Tissue tissue, TissueMap& map) {
  const std::string name(nameOf(tissue));
  if (!list.is_array()) {
    return "\"" + name + "\" must be a list of vertices";
  }
  for (const json& entry : list) {
    const bool whole = entry.is_number_unsigned() &&
                       entry.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
    if (!whole) {
      return "\"" + name + "\" holds what is no vertex number";
    }
    const auto vertex = entry.get<std::uint32_t>();
    if (!map.vertices.emplace(vertex, tissue).second) {
      return "vertex " + std::to_string(vertex) + " stands there twice";
    }
  }
  return {};
}

/// A field of a certain kind, or its default where it is not there.
template <typename T>
bool take(const json& document, const char* key, T& out) {
  const auto it = document.find(key);
  if (it == document.end()) {
    return true;
  }
  if constexpr (std::is_same_v<T, bool>) {
    out = it->is_boolean() && it->template get<bool>();
    return it->is_boolean();
  } else {
    out = it->is_string() ? it->template get<std::string>() : std::string();
    return it->is_string();
  }
}

std::string parse(const json& document, TissueMap& map) {
  if (!document.is_object() || !document.contains("mesh_sha256") ||
      !document.contains("vertices") || !document["vertices"].is_object()) {
    return "an object with \"mesh_sha256\" and \"vertices\" was expected";
  }
  if (!take(document, "mesh_sha256", map.mesh_sha256) || !take(document, "method", map.method) ||
      !take(document, "edited", map.edited) || !take(document, "confirmed", map.confirmed)) {
    return "mesh_sha256 and method must be texts, edited and confirmed true or false";
  }
  std::size_t known = 0;
  for (std::size_t t = 0; t < kTissues; ++t) {
    const auto tissue = static_cast<Tissue>(t);
    const auto list = document["vertices"].find(nameOf(tissue));
    if (list == document["vertices"].end()) {
      continue;
    }
    ++known;
    if (auto wrong = addVertices(*list, tissue, map); !wrong.empty()) {
      return wrong;
    }
  }
  return known == document["vertices"].size()
             ? std::string()
             : "only granulation, slough, necrosis, epithelium and other are tissues";
}

}  // namespace

Expected<TissueMap> readTissue(const std::filesystem::path& path) {
  const auto text = readTextFile(path);
  if (!text) {
    return tl::unexpected(text.error());
  }
  const json document = json::parse(*text, nullptr, false);
  TissueMap map;
  const std::string wrong = document.is_discarded() ? "not a JSON file" : parse(document, map);
  if (!wrong.empty()) {
    return fail(ErrorCode::TissueInvalid, path.string() + ": " + wrong);
  }
  return map;
}

Expected<void> writeTissue(const std::filesystem::path& path, const TissueMap& map) {
  json vertices = json::object();
  for (std::size_t t = 0; t < kTissues; ++t) {
    vertices[std::string(nameOf(static_cast<Tissue>(t)))] = json::array();
  }
  for (const auto& [vertex, tissue] : map.vertices) {
    vertices[std::string(nameOf(tissue))].push_back(vertex);
  }
  const json document{{"mesh_sha256", map.mesh_sha256},
                      {"method", map.method},
                      {"edited", map.edited},
                      {"confirmed", map.confirmed},
                      {"vertices", vertices}};
  return writeTextAtomically(path, document.dump() + "\n");
}

json toJson(const TissueShares& shares) {
  json percent = json::object();
  for (std::size_t t = 0; t < kTissues; ++t) {
    percent[std::string(nameOf(static_cast<Tissue>(t)))] = shares.percent[t];
  }
  return {{"tissue_percent", percent},
          {"tissue_unpainted_percent", shares.unpainted_percent},
          {"tissue_source", shares.source}};
}

}  // namespace tarsus
