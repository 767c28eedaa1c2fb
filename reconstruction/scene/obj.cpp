#include "reconstruction/scene/file_bytes.h"
#include "reconstruction/scene/ply.h"
#include "reconstruction/scene/text_scanner.h"

#include <cmath>
#include <limits>

namespace tarsus {
namespace {

std::string atLine(std::size_t line_number, const std::string& text) {
  return "line " + std::to_string(line_number) + ": " + text;
}

Expected<Eigen::Vector3f> parseVertex(TextScanner words) {
  Eigen::Vector3f position;
  for (int k = 0; k < 3; ++k) {
    const std::optional<double> value = words.number();
    const bool usable =
        value && std::abs(*value) <= static_cast<double>(std::numeric_limits<float>::max());
    if (!usable) {
      return fail(ErrorCode::MeshInvalid, "a vertex is not three finite numbers");
    }
    position[k] = static_cast<float>(*value);
  }
  return position;
}

/// "v", "v/vt", "v//vn" or "v/vt/vn"; counted from 1, or backwards from -1.
std::optional<int> parseCorner(std::string_view word, std::size_t vertex_count) {
  const auto index = TextScanner::parsed<std::int64_t>(word.substr(0, word.find('/')));
  if (!index) {
    return std::nullopt;
  }
  const auto count = static_cast<std::int64_t>(vertex_count);
  const std::int64_t from_zero = *index > 0 ? *index - 1 : *index + count;
  const bool known = *index != 0 && from_zero >= 0 && from_zero <= std::numeric_limits<int>::max();
  return known ? std::optional<int>(static_cast<int>(from_zero)) : std::nullopt;
}

/// Fans a polygon into triangles.
Expected<void> parseFace(TextScanner words, TriangleMesh& mesh) {
  Eigen::Vector3i corner = Eigen::Vector3i::Zero();
  int count = 0;
  for (std::string_view word = words.word(); !word.empty(); word = words.word(), ++count) {
    const std::optional<int> index = parseCorner(word, mesh.vertices.size());
    if (!index) {
      return fail(ErrorCode::MeshInvalid, "a face names no vertex of this file");
    }
    if (count < 3) {
      corner[count] = *index;
    } else {
      corner = {corner[0], corner[2], *index};
    }
    if (count >= 2) {
      mesh.faces.push_back(corner);
    }
  }
  return {};
}

Expected<void> parseLine(std::string_view line, TriangleMesh& mesh) {
  TextScanner words(line);
  const std::string_view keyword = words.word();
  if (keyword == "v") {
    const auto vertex = parseVertex(words);
    if (!vertex) {
      return tl::unexpected(vertex.error());
    }
    mesh.vertices.push_back(*vertex);
  } else if (keyword == "f") {
    return parseFace(words, mesh);
  }
  return {};
}

Expected<TriangleMesh> parseObj(std::string_view bytes) {
  TriangleMesh mesh;
  TextScanner text(bytes);
  for (std::size_t line_number = 1; !text.atEnd(); ++line_number) {
    if (auto read = parseLine(text.line(), mesh); !read) {
      return fail(read.error().code, atLine(line_number, read.error().detail));
    }
  }
  if (mesh.faces.empty()) {
    return fail(ErrorCode::MeshInvalid, "the file holds no faces");
  }
  // A face may name a vertex that only follows it, so the ends are checked at the end.
  for (const Eigen::Vector3i& face : mesh.faces) {
    if (static_cast<std::size_t>(face.maxCoeff()) >= mesh.vertices.size()) {
      return fail(ErrorCode::MeshInvalid, "a face names a vertex that the file does not hold");
    }
  }
  return mesh;
}

}  // namespace

Expected<TriangleMesh> readObj(const std::filesystem::path& path) {
  const auto bytes = readFileBytes(path);
  if (!bytes) {
    return tl::unexpected(bytes.error());
  }
  auto mesh = parseObj(*bytes);
  if (!mesh) {
    return fail(mesh.error().code, path.string() + ": " + mesh.error().detail);
  }
  return mesh;
}

}  // namespace tarsus
