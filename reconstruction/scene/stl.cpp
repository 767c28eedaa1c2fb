#include "reconstruction/scene/stl.h"

#include "reconstruction/scene/file_bytes.h"

#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <tuple>

namespace tarsus {
namespace {

static_assert(std::endian::native == std::endian::little, "STL is little endian");

constexpr std::size_t kHeaderBytes = 80;
constexpr std::size_t kFaceBytes = 50;

template <typename T>
void append(std::string& bytes, const T& value) {
  std::array<char, sizeof(T)> raw{};
  std::memcpy(raw.data(), &value, sizeof(T));
  bytes.append(raw.data(), raw.size());
}

template <typename T>
T valueAt(std::string_view bytes, std::size_t offset) {
  T value{};
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

}  // namespace

std::string stlBytes(const TriangleMesh& mesh) {
  // A header that begins with "solid" would be taken for the text form.
  std::string bytes = "binary STL, mm, by tarsus";
  bytes.resize(kHeaderBytes, ' ');
  append(bytes, static_cast<std::uint32_t>(mesh.faces.size()));
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const Eigen::Vector3f normal = faceNormal(mesh, static_cast<int>(f)).cast<float>();
    for (int k = 0; k < 3; ++k) {
      append(bytes, normal[k]);
    }
    for (int corner = 0; corner < 3; ++corner) {
      for (int k = 0; k < 3; ++k) {
        append(bytes, mesh.vertices[static_cast<std::size_t>(mesh.faces[f][corner])][k]);
      }
    }
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

Expected<TriangleMesh> parseStl(std::string_view bytes, const std::string& file) {
  const auto refuse = [&](const std::string& why) {
    return fail(ErrorCode::MeshInvalid, file + ": " + why);
  };
  if (bytes.size() < kHeaderBytes + sizeof(std::uint32_t)) {
    return refuse("too short for a binary STL");
  }
  const auto count = valueAt<std::uint32_t>(bytes, kHeaderBytes);
  const std::size_t first = kHeaderBytes + sizeof(std::uint32_t);
  if ((bytes.size() - first) / kFaceBytes < count) {
    return refuse("not a whole binary STL");
  }
  if (count == 0) {
    return refuse("no faces");
  }
  TriangleMesh mesh;
  std::map<std::tuple<float, float, float>, int> known;
  for (std::uint32_t f = 0; f < count; ++f) {
    Eigen::Vector3i face;
    for (int corner = 0; corner < 3; ++corner) {
      Eigen::Vector3f p;
      for (int k = 0; k < 3; ++k) {
        p[k] = valueAt<float>(
            bytes, first + f * kFaceBytes + 4U * static_cast<std::size_t>(3 + 3 * corner + k));
      }
      if (!p.allFinite()) {
        return refuse("a corner is not finite");
      }
      const auto [place, is_new] = known.try_emplace(std::tuple(p.x(), p.y(), p.z()),
                                                     static_cast<int>(mesh.vertices.size()));
      if (is_new) {
        mesh.vertices.push_back(p);
      }
      face[corner] = place->second;
    }
    mesh.faces.push_back(face);
  }
  return mesh;
}

Expected<TriangleMesh> readStl(const std::filesystem::path& path) {
  const auto bytes = readFileBytes(path);
  return bytes ? parseStl(*bytes, path.string()) : tl::unexpected(bytes.error());
}

}  // namespace tarsus
