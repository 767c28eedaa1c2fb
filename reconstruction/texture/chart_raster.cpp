#include "reconstruction/texture/chart_raster.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tarsus {
namespace {

/// Values of one chart while its box is filled.
struct Sheet {
  explicit Sheet(const ChartBox& box)
      : value(box.width, box.height), inside(box.width, box.height) {
    std::fill(inside.pixels().begin(), inside.pixels().end(), kNone);
  }

  static constexpr float kNone = -std::numeric_limits<float>::infinity();
  Image<Eigen::Vector3f> value;
  /// How far within the face that gave the value: least barycentric coordinate, kNone: no face.
  Image<float> inside;
};

struct FlatFace {
  std::array<Eigen::Vector2f, 3> corner;  // in texels of the box
  std::array<Eigen::Vector3f, 3> value;
};

float cross(const Eigen::Vector2f& a, const Eigen::Vector2f& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Whether the square of side 1 around `texel` and the face have a point in common: the corner of
/// the square that lies farthest in is within each edge.
bool touches(const FlatFace& face, const Eigen::Vector2f& texel, float orientation) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2f edge = face.corner[(k + 1) % 3] - face.corner[k];
    const float side = orientation * cross(edge, texel - face.corner[k]);
    if (side + 0.5F * (std::abs(edge.x()) + std::abs(edge.y())) < 0.0F) {
      return false;
    }
  }
  return true;
}

/// Coordinates of a texel in the face, moved into it where it lies outside.
struct Inside {
  Eigen::Vector3f barycentric;
  float least = 0.0F;
};

Inside locate(const FlatFace& face, const Eigen::Vector2f& texel, float area) {
  constexpr float kLeastArea = 1e-6F;
  if (std::abs(area) < kLeastArea) {
    return {Eigen::Vector3f::Constant(1.0F / 3.0F), -1.0F};
  }
  Eigen::Vector3f weights;
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Vector2f& a = face.corner[(k + 1) % 3];
    const Eigen::Vector2f& b = face.corner[(k + 2) % 3];
    weights[static_cast<Eigen::Index>(k)] = cross(b - a, texel - a) / area;
  }
  const float least = weights.minCoeff();
  weights = weights.cwiseMax(0.0F);
  return {weights / weights.sum(), least};
}

void drawFace(const FlatFace& face, Sheet& sheet) {
  Eigen::Vector2f low = face.corner[0];
  Eigen::Vector2f high = face.corner[0];
  for (const Eigen::Vector2f& corner : face.corner) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const float area = cross(face.corner[1] - face.corner[0], face.corner[2] - face.corner[0]);
  const float orientation = area < 0.0F ? -1.0F : 1.0F;
  const auto from = [](float x) { return std::max(0, static_cast<int>(std::ceil(x - 0.5F))); };
  const auto to = [](float x, int size) {
    return std::min(size - 1, static_cast<int>(std::floor(x + 0.5F)));
  };
  for (int v = from(low.y()); v <= to(high.y(), sheet.value.height()); ++v) {
    for (int u = from(low.x()); u <= to(high.x(), sheet.value.width()); ++u) {
      const Eigen::Vector2f texel(static_cast<float>(u), static_cast<float>(v));
      if (!touches(face, texel, orientation)) {
        continue;
      }
      const Inside at = locate(face, texel, area);
      if (at.least > sheet.inside.at(u, v)) {
        sheet.inside.at(u, v) = at.least;
        sheet.value.at(u, v) = at.barycentric[0] * face.value[0] +
                               at.barycentric[1] * face.value[1] +
                               at.barycentric[2] * face.value[2];
      }
    }
  }
}

/// Gives texels beside filled ones the mean of those; false where there was none to give.
bool growRing(Sheet& sheet) {
  const Image<float> before = sheet.inside;
  bool grown = false;
  for (int v = 0; v < before.height(); ++v) {
    for (int u = 0; u < before.width(); ++u) {
      if (before.at(u, v) > Sheet::kNone) {
        continue;
      }
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      float count = 0.0F;
      for (int y = std::max(v - 1, 0); y <= std::min(v + 1, before.height() - 1); ++y) {
        for (int x = std::max(u - 1, 0); x <= std::min(u + 1, before.width() - 1); ++x) {
          if (before.at(x, y) > Sheet::kNone) {
            sum += sheet.value.at(x, y);
            count += 1.0F;
          }
        }
      }
      if (count > 0.0F) {
        sheet.value.at(u, v) = sum / count;
        sheet.inside.at(u, v) = std::numeric_limits<float>::lowest();
        grown = true;
      }
    }
  }
  return grown;
}

std::uint8_t level(float value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0F, 255.0F)));
}

}  // namespace

void fillChart(const ChartTexels& texels,
               std::span<const Eigen::Vector3f> offsets,
               const std::function<Eigen::Vector3f(const Eigen::Vector2f& place)>& color,
               ColorImage& atlas) {
  const ChartBox& box = texels.box;
  const Chart& chart = *texels.chart;
  const Eigen::Vector2f corner(static_cast<float>(box.u), static_cast<float>(box.v));
  Sheet sheet(box);
  for (const Eigen::Vector3i& vertices : chart.corners) {
    FlatFace face;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto vertex = static_cast<std::size_t>(vertices[static_cast<Eigen::Index>(k)]);
      face.corner[k] = chart.places[vertex] + texels.shift - corner;
      face.value[k] = offsets[vertex];
    }
    drawFace(face, sheet);
  }
  growRing(sheet);  // what a lookup between texels at the rim reaches
  if (color) {
    for (int v = 0; v < box.height; ++v) {
      for (int u = 0; u < box.width; ++u) {
        if (sheet.inside.at(u, v) > Sheet::kNone) {
          const Eigen::Vector2f texel(static_cast<float>(u), static_cast<float>(v));
          sheet.value.at(u, v) += color(texel + corner - texels.shift);
        }
      }
    }
  }
  for (int ring = 1; ring < texels.padding && growRing(sheet); ++ring) {
  }
  for (int v = 0; v < box.height; ++v) {
    for (int u = 0; u < box.width; ++u) {
      if (sheet.inside.at(u, v) > Sheet::kNone) {
        const Eigen::Vector3f& value = sheet.value.at(u, v);
        atlas.at(box.u + u, box.v + v) = {level(value.x()), level(value.y()), level(value.z())};
      }
    }
  }
}

}  // namespace tarsus
