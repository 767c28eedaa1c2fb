#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/require.h"
#include "reconstruction/scene/ply.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstring>
#include <string>

namespace tarsus {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie");

/// A header is lines; a comment must not begin a new one.
std::string oneLine(std::string text) {
  for (char& c : text) {
    if (c == '\n' || c == '\r') {
      c = ' ';
    }
  }
  return text;
}

std::string headerOf(const TexturedMesh& model, std::span<const VertexField> fields) {
  std::string header = "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : model.comments) {
    header += "comment " + oneLine(comment) + '\n';
  }
  header += "element vertex " + std::to_string(model.mesh.vertices.size()) + '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    header += "property float " + std::string(name) + '\n';
  }
  if (!model.colors.empty()) {
    header += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  if (!model.sigma_mm.empty()) {
    header += "property float sigma_mm\n";
  }
  if (!model.observations.empty()) {
    header += "property ushort observations\n";
  }
  if (!model.unseen.empty()) {
    header += "property uchar unseen\n";
  }
  for (const VertexField& field : fields) {
    header += "property float " + field.name + '\n';
  }
  header += "element face " + std::to_string(model.mesh.faces.size()) + '\n';
  return header + "property list uchar int vertex_indices\nend_header\n";
}

template <typename T>
void append(std::string& bytes, const T& value) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(T));
  std::memcpy(bytes.data() + size, &value, sizeof(T));
}

void append3(std::string& bytes, const Eigen::Vector3f& v) {
  append(bytes, v.x());
  append(bytes, v.y());
  append(bytes, v.z());
}

void requireWhole(const TexturedMesh& model, std::span<const VertexField> fields) {
  const std::size_t count = model.mesh.vertices.size();
  const auto whole = [count](const auto& values) {
    return values.empty() || values.size() == count;
  };
  TARSUS_REQUIRE(whole(model.mesh.normals) && whole(model.colors) && whole(model.sigma_mm) &&
                     whole(model.observations) && whole(model.unseen),
                 "each quantity has one value for each vertex, or none at all");
  for (const VertexField& field : fields) {
    TARSUS_REQUIRE(field.values.size() == count && !field.name.empty() &&
                       std::ranges::all_of(
                           field.name,
                           [](char c) {
                             return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
                           }),
                   "a field has a name and one value for each vertex");
  }
}

}  // namespace

Expected<void> writePly(const std::filesystem::path& path,
                        const TexturedMesh& model,
                        std::span<const VertexField> fields) {
  requireWhole(model, fields);
  const TriangleMesh& mesh = model.mesh;
  const auto computed = mesh.normals.empty() ? vertexNormals(mesh) : std::vector<Eigen::Vector3f>();
  const auto& normals = mesh.normals.empty() ? computed : mesh.normals;
  std::string bytes = headerOf(model, fields);
  constexpr std::size_t kMostVertexBytes = 34;
  constexpr std::size_t kFaceBytes = 13;
  const std::size_t vertex_bytes = kMostVertexBytes + sizeof(float) * fields.size();
  bytes.reserve(bytes.size() + vertex_bytes * mesh.vertices.size() +
                kFaceBytes * mesh.faces.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    append3(bytes, mesh.vertices[i]);
    append3(bytes, normals[i]);
    if (!model.colors.empty()) {
      append(bytes, model.colors[i].r);
      append(bytes, model.colors[i].g);
      append(bytes, model.colors[i].b);
    }
    if (!model.sigma_mm.empty()) {
      append(bytes, model.sigma_mm[i]);
    }
    if (!model.observations.empty()) {
      append(bytes, model.observations[i]);
    }
    if (!model.unseen.empty()) {
      append(bytes, model.unseen[i]);
    }
    for (const VertexField& field : fields) {
      append(bytes, field.values[i]);
    }
  }
  for (const Eigen::Vector3i& face : mesh.faces) {
    append(bytes, std::uint8_t{3});
    append(bytes, face[0]);
    append(bytes, face[1]);
    append(bytes, face[2]);
  }
  return writeFileAtomically(path, std::as_bytes(std::span(bytes)));
}

}  // namespace tarsus
