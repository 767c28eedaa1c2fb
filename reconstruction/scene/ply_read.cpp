#include "reconstruction/scene/file_bytes.h"
#include "reconstruction/scene/ply.h"
#include "reconstruction/scene/ply_header.h"
#include "reconstruction/scene/text_scanner.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace tarsus {
namespace {

static_assert(std::endian::native == std::endian::little, "values are copied as they lie");

template <typename T>
double decode(const char* bytes, bool swap) {
  std::array<char, sizeof(T)> raw{};
  std::copy_n(bytes, sizeof(T), raw.begin());
  if (swap) {
    std::reverse(raw.begin(), raw.end());
  }
  return static_cast<double>(std::bit_cast<T>(raw));
}

/// Reads one value after another, of whichever format; empty past the end or where text is no
/// number.
class PlyValues {
 public:
  PlyValues(std::string_view body, PlyFormat format)
      : body_(body), text_(body), format_(format), swap_(format == PlyFormat::BigEndian) {}

  [[nodiscard]] std::size_t bytesLeft() const {
    return body_.size() - (format_ == PlyFormat::Ascii ? text_.position() : position_);
  }

  std::optional<double> next(PlyType type) {
    if (format_ == PlyFormat::Ascii) {
      return text_.number();
    }
    const std::size_t size = sizeOf(type);
    if (body_.size() - position_ < size) {
      return std::nullopt;
    }
    const char* bytes = body_.data() + position_;
    position_ += size;
    switch (type) {
      case PlyType::Int8:
        return decode<std::int8_t>(bytes, false);
      case PlyType::UInt8:
        return decode<std::uint8_t>(bytes, false);
      case PlyType::Int16:
        return decode<std::int16_t>(bytes, swap_);
      case PlyType::UInt16:
        return decode<std::uint16_t>(bytes, swap_);
      case PlyType::Int32:
        return decode<std::int32_t>(bytes, swap_);
      case PlyType::UInt32:
        return decode<std::uint32_t>(bytes, swap_);
      case PlyType::Float32:
        return decode<float>(bytes, swap_);
      case PlyType::Float64:
        return decode<double>(bytes, swap_);
    }
    return std::nullopt;
  }

  /// Length of a list that fits into what is left of the file.
  std::optional<std::size_t> nextLength(const PlyProperty& list) {
    const std::optional<double> length = next(*list.list_length);
    const std::size_t entry = format_ == PlyFormat::Ascii ? 1 : sizeOf(list.type);
    const std::size_t entries_left = bytesLeft() / entry;
    const bool fits = length && *length >= 0.0 && std::floor(*length) == *length &&
                      *length <= static_cast<double>(entries_left);
    return fits ? std::optional<std::size_t>(static_cast<std::size_t>(*length)) : std::nullopt;
  }

  /// Reads a property and forgets it.
  bool skip(const PlyProperty& property) {
    std::size_t count = 1;
    if (property.list_length) {
      const auto length = nextLength(property);
      if (!length) {
        return false;
      }
      count = *length;
    }
    for (std::size_t i = 0; i < count; ++i) {
      if (!next(property.type)) {
        return false;
      }
    }
    return true;
  }

 private:
  std::string_view body_;
  TextScanner text_;
  PlyFormat format_;
  bool swap_;
  std::size_t position_ = 0;
};

tl::unexpected<Error> cutOff(const PlyElement& element) {
  return fail(ErrorCode::FileUnreadable,
              "the file ends, or holds no number, where element \"" + element.name +
                  "\" should have " + std::to_string(element.count) + " rows");
}

tl::unexpected<Error> invalid(std::string text) {
  return fail(ErrorCode::MeshInvalid, std::move(text));
}

/// What a vertex property means to us.
enum class Role { Skip, X, Y, Z, Nx, Ny, Nz, Red, Green, Blue, Sigma, Observations, Unseen };
constexpr std::size_t kRoleCount = 13;
using Row = std::array<double, kRoleCount>;

double& at(Row& row, Role role) { return row[static_cast<std::size_t>(role)]; }

Role roleNamed(std::string_view name) {
  using enum Role;
  static constexpr std::array<std::pair<std::string_view, Role>, 15> kRoles{
      {{"x", X},
       {"y", Y},
       {"z", Z},
       {"nx", Nx},
       {"ny", Ny},
       {"nz", Nz},
       {"red", Red},
       {"green", Green},
       {"blue", Blue},
       {"diffuse_red", Red},
       {"diffuse_green", Green},
       {"diffuse_blue", Blue},
       {"sigma_mm", Sigma},
       {"observations", Observations},
       {"unseen", Unseen}}};
  for (const auto& [role_name, role] : kRoles) {
    if (role_name == name) {
      return role;
    }
  }
  return Skip;
}

/// Which properties a file has, and how its colours become 0..255.
struct VertexLayout {
  std::vector<Role> roles;  ///< one for each property
  std::array<bool, kRoleCount> present{};
  double color_scale = 1.0;

  explicit VertexLayout(const PlyElement& element) {
    for (const PlyProperty& property : element.properties) {
      Role role = property.list_length ? Role::Skip : roleNamed(property.name);
      if (has(role)) {
        role = Role::Skip;  // the first of two of one name counts
      }
      roles.push_back(role);
      present[static_cast<std::size_t>(role)] = role != Role::Skip;
      if (role == Role::Red) {
        const bool real = property.type == PlyType::Float32 || property.type == PlyType::Float64;
        color_scale = real ? 255.0 : property.type == PlyType::UInt16 ? 1.0 / 257.0 : 1.0;
      }
    }
  }
  [[nodiscard]] bool has(Role role) const { return present[static_cast<std::size_t>(role)]; }
  [[nodiscard]] bool has(Role a, Role b, Role c) const { return has(a) && has(b) && has(c); }
};

template <typename Integer>
Integer rounded(double value) {
  constexpr double kGreatest = std::numeric_limits<Integer>::max();
  return std::isnan(value) ? Integer{0}
                           : static_cast<Integer>(std::lround(std::clamp(value, 0.0, kGreatest)));
}

bool fitsFloat(double value) {
  return std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());  // NaN: false
}

/// @return false where the row holds no place in space
bool addVertex(TexturedMesh& model, const VertexLayout& layout, Row& row) {
  const Eigen::Vector3d position(at(row, Role::X), at(row, Role::Y), at(row, Role::Z));
  if (!fitsFloat(position.x()) || !fitsFloat(position.y()) || !fitsFloat(position.z())) {
    return false;
  }
  model.mesh.vertices.push_back(position.cast<float>());
  if (layout.has(Role::Nx, Role::Ny, Role::Nz)) {
    const Eigen::Vector3d normal(at(row, Role::Nx), at(row, Role::Ny), at(row, Role::Nz));
    const bool usable = normal.allFinite() && normal.cwiseAbs().maxCoeff() <= 2.0;
    model.mesh.normals.push_back(usable ? normal.cast<float>() : Eigen::Vector3f::Zero().eval());
  }
  if (layout.has(Role::Red, Role::Green, Role::Blue)) {
    const double scale = layout.color_scale;
    model.colors.push_back({rounded<std::uint8_t>(scale * at(row, Role::Red)),
                            rounded<std::uint8_t>(scale * at(row, Role::Green)),
                            rounded<std::uint8_t>(scale * at(row, Role::Blue))});
  }
  if (layout.has(Role::Sigma)) {
    if (!fitsFloat(at(row, Role::Sigma)) || at(row, Role::Sigma) < 0.0) {
      return false;
    }
    model.sigma_mm.push_back(static_cast<float>(at(row, Role::Sigma)));
  }
  if (layout.has(Role::Observations)) {
    model.observations.push_back(rounded<std::uint16_t>(at(row, Role::Observations)));
  }
  if (layout.has(Role::Unseen)) {
    model.unseen.push_back(at(row, Role::Unseen) != 0.0 ? 1 : 0);
  }
  return true;
}

Expected<void> readVertices(const PlyElement& element, PlyValues& values, TexturedMesh& model) {
  const VertexLayout layout(element);
  if (!layout.has(Role::X, Role::Y, Role::Z)) {
    return invalid("the vertices have no x, y and z");
  }
  if (!model.mesh.vertices.empty()) {
    return invalid("the file has vertices twice");
  }
  model.mesh.vertices.reserve(element.count);
  Row row{};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (layout.roles[k] == Role::Skip) {
        if (!values.skip(property)) {
          return cutOff(element);
        }
        continue;
      }
      const std::optional<double> value = values.next(property.type);
      if (!value) {
        return cutOff(element);
      }
      at(row, layout.roles[k]) = *value;
    }
    if (!addVertex(model, layout, row)) {
      return invalid("vertex " + std::to_string(i) +
                     " has a position or sigma_mm that is not a finite number");
    }
  }
  return {};
}

/// Reads one polygon and fans it into triangles.
Expected<void> readPolygon(const PlyProperty& list,
                           PlyValues& values,
                           std::vector<Eigen::Vector3i>& faces) {
  const std::optional<std::size_t> length = values.nextLength(list);
  if (!length) {
    return fail(ErrorCode::FileUnreadable, "the file ends, or has no sense, inside its faces");
  }
  Eigen::Vector3i corner = Eigen::Vector3i::Zero();
  for (std::size_t i = 0; i < *length; ++i) {
    const std::optional<double> index = values.next(list.type);
    if (!index) {
      return fail(ErrorCode::FileUnreadable, "the file ends inside its faces");
    }
    if (!(*index >= 0.0 && *index <= std::numeric_limits<int>::max())) {
      return invalid("face " + std::to_string(faces.size()) + " names no vertex of this file");
    }
    if (i < 3) {
      corner[static_cast<int>(i)] = static_cast<int>(*index);
    } else {
      corner = {corner[0], corner[2], static_cast<int>(*index)};
    }
    if (i >= 2) {
      faces.push_back(corner);
    }
  }
  return {};
}

Expected<void> readFaces(const PlyElement& element, PlyValues& values, TexturedMesh& model) {
  const auto corners =
      std::find_if(element.properties.begin(), element.properties.end(), [](const PlyProperty& p) {
        return p.list_length && (p.name == "vertex_indices" || p.name == "vertex_index");
      });
  if (corners == element.properties.end()) {
    return invalid("the faces have no list \"vertex_indices\"");
  }
  const auto wanted = corners - element.properties.begin();
  model.mesh.faces.reserve(model.mesh.faces.size() + element.count);
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      if (k != static_cast<std::size_t>(wanted)) {
        if (!values.skip(property)) {
          return cutOff(element);
        }
      } else if (auto read = readPolygon(property, values, model.mesh.faces); !read) {
        return read;
      }
    }
  }
  return {};
}

Expected<void> readElement(const PlyElement& element,
                           PlyFormat format,
                           PlyValues& values,
                           TexturedMesh& model) {
  // Asked before any memory is: a damaged count must not look like a lack of memory.
  const std::size_t row_bytes = element.leastRowBytes(format);
  if (row_bytes > 0 && element.count > (values.bytesLeft() + 1) / row_bytes) {
    return cutOff(element);
  }
  if (element.name == "vertex") {
    return readVertices(element, values, model);
  }
  if (element.name == "face") {
    return readFaces(element, values, model);
  }
  for (std::uint64_t i = 0; i < element.count && row_bytes > 0; ++i) {
    for (const PlyProperty& property : element.properties) {
      if (!values.skip(property)) {
        return cutOff(element);
      }
    }
  }
  return {};
}

Expected<TexturedMesh> parsePly(std::string_view bytes) {
  auto header = parsePlyHeader(bytes);
  if (!header) {
    return tl::unexpected(header.error());
  }
  TexturedMesh model;
  model.comments = std::move(header->comments);
  PlyValues values(bytes.substr(header->body_offset), header->format);
  for (const PlyElement& element : header->elements) {
    if (auto read = readElement(element, header->format, values, model); !read) {
      return tl::unexpected(read.error());
    }
  }
  if (model.mesh.faces.empty()) {
    return invalid("the file holds no faces");
  }
  const auto count = model.mesh.vertices.size();
  for (std::size_t i = 0; i < model.mesh.faces.size(); ++i) {
    if (static_cast<std::size_t>(model.mesh.faces[i].maxCoeff()) >= count) {
      return invalid("face " + std::to_string(i) + " names a vertex beyond the " +
                     std::to_string(count) + " of this file");
    }
  }
  return withHash(std::move(model));
}

}  // namespace

Expected<TexturedMesh> readPly(const std::filesystem::path& path) {
  const auto bytes = readFileBytes(path);
  if (!bytes) {
    return tl::unexpected(bytes.error());
  }
  auto model = parsePly(*bytes);
  if (!model) {
    return fail(model.error().code, path.string() + ": " + model.error().detail);
  }
  return model;
}

}  // namespace tarsus
