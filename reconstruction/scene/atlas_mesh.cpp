#include "reconstruction/scene/atlas_mesh.h"

#include "reconstruction/base/atomic_file.h"
#include "reconstruction/base/require.h"

#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <string>

namespace tarsus {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie");

void requireWhole(const AtlasMesh& model, std::string_view picture) {
  TARSUS_REQUIRE(model.uv_faces.size() == model.mesh.faces.size(),
                 "each face has a place in the picture");
  TARSUS_REQUIRE(
      model.mesh.normals.empty() || model.mesh.normals.size() == model.mesh.vertices.size(),
      "each vertex has a normal, or none has");
  TARSUS_REQUIRE(picture.find_first_of("\r\n/") == std::string_view::npos && !picture.empty(),
                 "the picture is a plain file name");
}

/// Shortest text that reads back as the same number, whatever the locale.
template <typename Number>
void print(std::string& text, Number number) {
  std::array<char, 32> digits{};
  const auto end = std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr;
  text.append(digits.data(), end);
}

template <typename Vector>
void printLine(std::string& text, std::string_view keyword, const Vector& values) {
  text += keyword;
  for (const auto value : values) {
    text += ' ';
    print(text, value);
  }
  text += '\n';
}

std::string objText(const AtlasMesh& model, std::string_view material_file) {
  const TriangleMesh& mesh = model.mesh;
  std::string text = "# Tarsus; millimetres\nmtllib " + std::string(material_file) + "\n";
  for (const Eigen::Vector3f& vertex : mesh.vertices) {
    printLine(text, "v", vertex);
  }
  for (const Eigen::Vector2f& place : model.uv) {
    printLine(text, "vt", place);
  }
  for (const Eigen::Vector3f& normal : mesh.normals) {
    printLine(text, "vn", normal);
  }
  text += "usemtl skin\n";
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    text += 'f';
    for (int k = 0; k < 3; ++k) {
      text += ' ';
      print(text, mesh.faces[f][k] + 1);
      text += '/';
      print(text, model.uv_faces[f][k] + 1);
      if (!mesh.normals.empty()) {
        text += '/';
        print(text, mesh.faces[f][k] + 1);
      }
    }
    text += '\n';
  }
  return text;
}

template <typename T>
void append(std::string& bytes, const T& value) {
  const std::size_t size = bytes.size();
  bytes.resize(size + sizeof(T));
  std::memcpy(bytes.data() + size, &value, sizeof(T));
}

}  // namespace

Expected<void> writeTexturedObj(const std::filesystem::path& path,
                                const AtlasMesh& model,
                                std::string_view picture) {
  requireWhole(model, picture);
  const std::filesystem::path material = std::filesystem::path(path).replace_extension(".mtl");
  // White under the picture and no highlight: the colours are the skin's own.
  auto written =
      writeTextAtomically(material,
                          "newmtl skin\nKa 1 1 1\nKd 1 1 1\nKs 0 0 0\nd 1\nillum 1\nmap_Kd " +
                              std::string(picture) + "\n");
  return written ? writeTextAtomically(path, objText(model, material.filename().string()))
                 : written;
}

Expected<void> writeTexturedPly(const std::filesystem::path& path,
                                const AtlasMesh& model,
                                std::string_view picture) {
  requireWhole(model, picture);
  const TriangleMesh& mesh = model.mesh;
  std::string bytes = "ply\nformat binary_little_endian 1.0\ncomment TextureFile " +
                      std::string(picture) + "\nelement vertex " +
                      std::to_string(mesh.vertices.size()) +
                      "\nproperty float x\nproperty float y\nproperty float z\n";
  if (!mesh.normals.empty()) {
    bytes += "property float nx\nproperty float ny\nproperty float nz\n";
  }
  bytes += "element face " + std::to_string(mesh.faces.size()) +
           "\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
           "end_header\n";
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    append(bytes, std::array{mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z()});
    if (!mesh.normals.empty()) {
      append(bytes, std::array{mesh.normals[i].x(), mesh.normals[i].y(), mesh.normals[i].z()});
    }
  }
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    append(bytes, std::uint8_t{3});
    append(bytes, std::array{mesh.faces[f][0], mesh.faces[f][1], mesh.faces[f][2]});
    append(bytes, std::uint8_t{6});
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector2f& place = model.uv[static_cast<std::size_t>(model.uv_faces[f][k])];
      append(bytes, std::array{place.x(), place.y()});
    }
  }
  return writeFileAtomically(path, std::as_bytes(std::span(bytes)));
}

}  // namespace tarsus
