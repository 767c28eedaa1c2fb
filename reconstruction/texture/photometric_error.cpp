#include "reconstruction/texture/color_map.h"
#include "reconstruction/texture/color_sampling.h"
#include "reconstruction/texture/keyframe_view.h"
#include "reconstruction/texture/vertex_chunks.h"

#include <algorithm>
#include <cmath>

namespace tarsus {
namespace {

/// Fit of one factor from the model's luminance to an image's: exposure is no error of alignment.
struct GainFit {
  double model_squares = 0.0;
  double image_squares = 0.0;
  double products = 0.0;
  double count = 0.0;

  void add(double model, double image) { add({model * model, image * image, model * image, 1.0}); }
  void add(const GainFit& other) {
    model_squares += other.model_squares;
    image_squares += other.image_squares;
    products += other.products;
    count += other.count;
  }
  [[nodiscard]] double squaredError() const {
    return model_squares > 0.0 ? std::max(0.0, image_squares - products * products / model_squares)
                               : image_squares;
  }
};

}  // namespace

double photometricRmse(const TexturedMesh& model,
                       const RgbdCamera& camera,
                       std::span<const Keyframe> keyframes,
                       std::span<const PicturePlacement> placements,
                       const ColorMapOptions& options) {
  if (model.mesh.faces.empty() || model.colors.empty() || keyframes.empty()) {
    return 0.0;
  }
  const auto views = renderViews(model.mesh, camera, keyframes, placements, options);
  if (!views) {
    return 0.0;
  }
  const std::vector<Eigen::Vector3f> normals =
      model.mesh.normals.empty() ? vertexNormals(model.mesh) : model.mesh.normals;
  const std::size_t chunks = (model.colors.size() + kVertexChunk - 1) / kVertexChunk;
  std::vector<GainFit> fits(chunks * views->size());
  parallelChunks(model.colors.size(), [&](std::size_t first, std::size_t last) {
    const auto own_fits =
        std::span(fits).subspan(first / kVertexChunk * views->size(), views->size());
    for (std::size_t i = first; i < last; ++i) {
      const auto own = static_cast<double>(intensityOf(colorVector(model.colors[i])));
      for (std::size_t k = 0; k < views->size(); ++k) {
        const KeyframeView& view = (*views)[k];
        if (const auto seen = view.observe(model.mesh.vertices[i], normals[i])) {
          own_fits[k].add(own, static_cast<double>(intensityOf(view.color(*seen))));
        }
      }
    }
  });
  GainFit total;
  double squared_error = 0.0;
  for (std::size_t k = 0; k < views->size(); ++k) {
    GainFit image;
    for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
      image.add(fits[chunk * views->size() + k]);
    }
    squared_error += image.squaredError();
    total.add(image);
  }
  return total.count > 0.0 ? std::sqrt(squared_error / total.count) : 0.0;
}

}  // namespace tarsus
