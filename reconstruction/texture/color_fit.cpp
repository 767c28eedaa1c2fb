#include "reconstruction/texture/color_fit.h"

#include "reconstruction/texture/color_blend.h"
#include "reconstruction/texture/vertex_chunks.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace tarsus {
namespace {

/// Sums over pixels are split into so many parts, whatever the number of threads.
constexpr std::size_t kParts = 4;
/// Of the best view's weight at a place: views below the first do not count there (blurred,
/// slanting or far), views above the second count fully.
constexpr float kLeastRelative = 0.15F;
constexpr float kFullRelative = 0.5F;
/// A vertex that pixels hardly touch must not take all that they miss: so much weight holds it [a
/// best view's pixel].
constexpr float kHold = 0.5F;
constexpr float kOddColor = 20.0F;  ///< so far from the blend, a pixel counts half [grey levels]

/// What one pixel says: the mean of a face's corners by their shares is of this colour.
struct PixelEquation {
  std::array<std::uint32_t, 3> vertex;
  std::array<float, 3> share;
  float weight;
  Eigen::Vector3f color;
};
using Equations = std::vector<PixelEquation>;  // of one view

std::array<float, 3> barycentric(const Eigen::Vector3f& p,
                                 const Eigen::Vector3f& a,
                                 const Eigen::Vector3f& b,
                                 const Eigen::Vector3f& c) {
  const Eigen::Vector3f normal = (b - a).cross(c - a);
  const float scale = 1.0F / normal.squaredNorm();
  const float at_a = std::clamp((b - p).cross(c - p).dot(normal) * scale, 0.0F, 1.0F);
  const float at_b = std::clamp((c - p).cross(a - p).dot(normal) * scale, 0.0F, 1.0F - at_a);
  return {at_a, at_b, 1.0F - at_a - at_b};
}

class ColorFit {
 public:
  ColorFit(const TriangleMesh& mesh,
           std::span<const KeyframeView> views,
           std::span<const ColorGain> gains,
           const ColorFitOptions& options,
           SeenColors& colors)
      : mesh_(mesh),
        views_(views),
        gains_(gains),
        options_(options),
        colors_(colors),
        equations_(views.size()) {}

  void run() {
    parallelFor(static_cast<int>(views_.size()),
                [this](int k) { readPixels(static_cast<std::size_t>(k)); });
    preferBestViews();
    mistrustOddColors();
    sumWeights();
    for (int sweep = 0; sweep < options_.sweeps; ++sweep) {
      correct();
    }
  }

 private:
  void readPixels(std::size_t k) {
    const KeyframeView& view = views_[k];
    const SurfaceImage image = rasterize(mesh_, view.pinhole(), view.colorFromScan());
    const Eigen::Isometry3f scan_from_color = view.colorFromScan().inverse();
    for (int v = 0; v < image.face.height(); ++v) {
      for (int u = 0; u < image.face.width(); ++u) {
        const int face = image.face.at(u, v);
        if (face >= 0) {
          const Eigen::Vector3f ray = view.pinhole().ray(u, v).cast<float>();
          readPixel(k, face, scan_from_color * (image.depth_mm.at(u, v) * ray));
        }
      }
    }
  }

  void readPixel(std::size_t k, int face, const Eigen::Vector3f& p) {
    const Eigen::Vector3i& f = mesh_.faces[static_cast<std::size_t>(face)];
    PixelEquation equation;
    for (std::size_t i = 0; i < 3; ++i) {
      equation.vertex[i] = static_cast<std::uint32_t>(f[static_cast<int>(i)]);
      if (colors_.seen[equation.vertex[i]] == 0) {
        return;
      }
    }
    const auto& [a, b, c] = equation.vertex;
    equation.share = barycentric(p, mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c]);
    const Eigen::Vector3f normal = equation.share[0] * mesh_.normals[a] +
                                   equation.share[1] * mesh_.normals[b] +
                                   equation.share[2] * mesh_.normals[c];
    const auto seen = views_[k].observe(p, normal.normalized());
    if (!seen) {
      return;
    }
    const Eigen::Vector3f raw = views_[k].sharpColor(*seen);
    equation.weight = seen->weight * (raw.maxCoeff() >= kClippedLevel ? kClippedWeight : 1.0F);
    equation.color = gains_[k].leveled(raw);
    equations_[k].push_back(equation);
  }

  /// Calls use(part, equation) for all equations, the parts side by side.
  template <typename Use>
  void eachPart(const Use& use) {
    parallelFor(static_cast<int>(kParts), [&](int i) {
      const auto part = static_cast<std::size_t>(i);
      for (std::size_t k = part; k < equations_.size(); k += kParts) {
        for (PixelEquation& equation : equations_[k]) {
          use(part, equation);
        }
      }
    });
  }
  template <typename Use>
  void eachView(const Use& use) {
    parallelFor(static_cast<int>(equations_.size()), [&](int k) {
      for (PixelEquation& equation : equations_[static_cast<std::size_t>(k)]) {
        use(equation);
      }
    });
  }

  /// Weights become relative to the best view's at the place, so that all places count alike.
  void preferBestViews() {
    std::vector<std::vector<float>> best(kParts, std::vector<float>(mesh_.vertices.size(), 0.0F));
    eachPart([&](std::size_t part, const PixelEquation& equation) {
      for (const std::uint32_t vertex : equation.vertex) {
        best[part][vertex] = std::max(best[part][vertex], equation.weight);
      }
    });
    parallelChunks(mesh_.vertices.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        for (std::size_t part = 1; part < kParts; ++part) {
          best[0][i] = std::max(best[0][i], best[part][i]);
        }
      }
    });
    eachView([&](PixelEquation& equation) {
      const float most = std::max(
          {best[0][equation.vertex[0]], best[0][equation.vertex[1]], best[0][equation.vertex[2]]});
      const float relative = equation.weight / most;
      equation.weight =
          relative *
          std::clamp((relative - kLeastRelative) / (kFullRelative - kLeastRelative), 0.0F, 1.0F);
    });
  }

  void mistrustOddColors() {
    eachView([&](PixelEquation& equation) {
      const float odd = (equation.color - shown(equation)).norm() / kOddColor;
      equation.weight /= 1.0F + odd * odd;
    });
  }

  void sumWeights() {
    std::vector<std::vector<float>> sums(kParts, std::vector<float>(mesh_.vertices.size(), 0.0F));
    eachPart([&](std::size_t part, const PixelEquation& equation) {
      for (std::size_t i = 0; i < 3; ++i) {
        sums[part][equation.vertex[i]] += equation.weight * equation.share[i];
      }
    });
    weights_ = std::move(sums[0]);
    for (std::size_t part = 1; part < kParts; ++part) {
      for (std::size_t i = 0; i < weights_.size(); ++i) {
        weights_[i] += sums[part][i];
      }
    }
    pulls_.assign(kParts, std::vector<Eigen::Vector3f>(mesh_.vertices.size()));
  }

  [[nodiscard]] Eigen::Vector3f shown(const PixelEquation& equation) const {
    return equation.share[0] * colors_.color[equation.vertex[0]] +
           equation.share[1] * colors_.color[equation.vertex[1]] +
           equation.share[2] * colors_.color[equation.vertex[2]];
  }

  void correct() {
    for (std::vector<Eigen::Vector3f>& pull : pulls_) {
      std::ranges::fill(pull, Eigen::Vector3f::Zero());
    }
    eachPart([&](std::size_t part, const PixelEquation& equation) {
      const Eigen::Vector3f rest = equation.weight * (equation.color - shown(equation));
      for (std::size_t i = 0; i < 3; ++i) {
        pulls_[part][equation.vertex[i]] += equation.share[i] * rest;
      }
    });
    parallelChunks(mesh_.vertices.size(), [&](std::size_t first, std::size_t last) {
      for (std::size_t i = first; i < last; ++i) {
        if (weights_[i] > 0.0F) {
          Eigen::Vector3f sum = pulls_[0][i];
          for (std::size_t part = 1; part < kParts; ++part) {
            sum += pulls_[part][i];
          }
          colors_.color[i] += sum / (weights_[i] + kHold);
        }
      }
    });
  }

  const TriangleMesh& mesh_;
  std::span<const KeyframeView> views_;
  std::span<const ColorGain> gains_;
  const ColorFitOptions& options_;
  SeenColors& colors_;
  std::vector<Equations> equations_;
  std::vector<float> weights_;
  std::vector<std::vector<Eigen::Vector3f>> pulls_;
};

}  // namespace

void fitColors(const TriangleMesh& mesh,
               std::span<const KeyframeView> views,
               std::span<const ColorGain> gains,
               const ColorFitOptions& options,
               SeenColors& colors) {
  if (options.sweeps > 0) {
    ColorFit(mesh, views, gains, options, colors).run();
  }
}

}  // namespace tarsus
