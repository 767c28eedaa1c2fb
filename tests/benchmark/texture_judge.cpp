#include "tests/benchmark/texture_judge.h"

#include "reconstruction/capture/image_file.h"
#include "reconstruction/scene/mesh_index.h"
#include "tests/benchmark/bench_support.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace tarsus {
namespace {

Image<float> luminance(const FloatColorImage& image) {
  Image<float> result(image.width(), image.height());
  std::ranges::transform(image.pixels(), result.pixels().begin(), [](const Eigen::Vector3f& c) {
    return c.dot(Eigen::Vector3f(0.299F, 0.587F, 0.114F));  // Rec. 601
  });
  return result;
}

/// Rendered colours with one gain and bias per channel, those that bring them nearest to what they
/// are judged by.
FloatColorImage fitted(const FloatColorImage& rendered,
                       const FloatColorImage& wanted,
                       const Mask& mask) {
  Eigen::Array3d x = Eigen::Array3d::Zero();
  Eigen::Array3d y = x;
  Eigen::Array3d xx = x;
  Eigen::Array3d xy = x;
  double count = 0.0;
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (mask.pixels()[i] != 0) {
      const Eigen::Array3d a = rendered.pixels()[i].cast<double>().array();
      const Eigen::Array3d b = wanted.pixels()[i].cast<double>().array();
      x += a;
      y += b;
      xx += a * a;
      xy += a * b;
      count += 1.0;
    }
  }
  const Eigen::Array3d gain = (count * xy - x * y) / (count * xx - x * x).max(1e-9);
  const Eigen::Array3d bias = (y - gain * x) / std::max(count, 1.0);
  FloatColorImage result(rendered.width(), rendered.height());
  std::ranges::transform(rendered.pixels(), result.pixels().begin(), [&](const Eigen::Vector3f& c) {
    return Eigen::Vector3f((gain * c.cast<double>().array() + bias).cast<float>().matrix());
  });
  return result;
}

double psnr(const FloatColorImage& a, const FloatColorImage& b, const Mask& mask) {
  double squares = 0.0;
  double count = 0.0;
  for (std::size_t i = 0; i < mask.pixels().size(); ++i) {
    if (mask.pixels()[i] != 0) {
      squares += static_cast<double>((a.pixels()[i] - b.pixels()[i]).squaredNorm());
      count += 3.0;
    }
  }
  return 10.0 * std::log10(255.0 * 255.0 * count / std::max(squares, 1e-9));
}

struct Energy {
  double laplacian = 0.0;
  double gradient = 0.0;

  void add(const Energy& other) {
    laplacian += other.laplacian;
    gradient += other.gradient;
  }
};

/// Sums of the squared Laplacian (4 neighbours) and the squared Sobel gradient of the luminance.
Energy energy(const FloatColorImage& image, const Mask& mask) {
  const Image<float> f = luminance(image);
  Energy sum;
  for (int v = 1; v < f.height() - 1; ++v) {
    for (int u = 1; u < f.width() - 1; ++u) {
      if (mask.at(u, v) == 0) {
        continue;
      }
      const auto at = [&](int du, int dv) { return double{f.at(u + du, v + dv)}; };
      const double laplacian = at(-1, 0) + at(1, 0) + at(0, -1) + at(0, 1) - 4.0 * at(0, 0);
      const double du =
          (at(1, -1) + 2.0 * at(1, 0) + at(1, 1) - at(-1, -1) - 2.0 * at(-1, 0) - at(-1, 1)) / 8.0;
      const double dv =
          (at(-1, 1) + 2.0 * at(0, 1) + at(1, 1) - at(-1, -1) - 2.0 * at(0, -1) - at(1, -1)) / 8.0;
      sum.laplacian += laplacian * laplacian;
      sum.gradient += du * du + dv * dv;
    }
  }
  return sum;
}

/// What the rendered views are compared with, summed up over the views.
class Comparison {
 public:
  void add(const FloatColorImage& rendered,
           const FloatColorImage& wanted,
           const LeftOutView& view) {
    const FloatColorImage likened = fitted(rendered, wanted, view.judged);
    const double psnr_db = psnr(likened, wanted, view.judged);
    sum_db_ += psnr_db;
    least_db_ = count_ == 0 ? psnr_db : std::min(least_db_, psnr_db);
    ++count_;
    rendered_.add(energy(likened, view.inner));
    wanted_.add(energy(wanted, view.inner));
  }

  [[nodiscard]] double meanDb() const { return sum_db_ / std::max(count_, 1); }
  [[nodiscard]] double leastDb() const { return least_db_; }
  [[nodiscard]] double laplacian() const {
    return rendered_.laplacian / std::max(wanted_.laplacian, 1e-9);
  }
  [[nodiscard]] double gradient() const {
    return rendered_.gradient / std::max(wanted_.gradient, 1e-9);
  }

 private:
  int count_ = 0;
  double sum_db_ = 0.0;
  double least_db_ = 0.0;
  Energy rendered_;
  Energy wanted_;
};

struct Box {
  int left, top, right, bottom;  ///< inclusive [px]
};

Box boxOf(const Mask& mask) {
  Box box{mask.width(), mask.height(), -1, -1};
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      if (mask.at(u, v) != 0) {
        box = {std::min(box.left, u),
               std::min(box.top, v),
               std::max(box.right, u),
               std::max(box.bottom, v)};
      }
    }
  }
  return box;
}

/// Pictures side by side, cut to the box; what the mask leaves out is dimmed.
void writeSheet(const std::filesystem::path& path,
                std::span<const FloatColorImage> pictures,
                const Box& box,
                const Mask* mask) {
  constexpr int kGap_px = 6;
  const int step = box.right - box.left + 1 + kGap_px;
  ColorImage sheet(step * static_cast<int>(pictures.size()) - kGap_px, box.bottom - box.top + 1);
  std::ranges::fill(sheet.pixels(), Rgb8{255, 255, 255});
  const auto level = [](float x) {
    return static_cast<std::uint8_t>(std::lround(std::clamp(x, 0.0F, 255.0F)));
  };
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    const int first = static_cast<int>(k) * step;
    for (int v = box.top; v <= box.bottom; ++v) {
      for (int u = box.left; u <= box.right; ++u) {
        const float light = mask == nullptr || mask->at(u, v) != 0 ? 1.0F : 0.3F;
        const Eigen::Vector3f c = light * pictures[k].at(u, v);
        sheet.at(first + u - box.left, v - box.top) = {level(c.x()), level(c.y()), level(c.z())};
      }
    }
  }
  orExit(writeColorImage(path, sheet, Flush::Later));
}

/// Rendered, noise-free, sensed; and the wound close up, rendered and noise-free.
void writePictures(const std::filesystem::path& path,
                   const TexturedMesh& model,
                   const MeshIndex& index,
                   const FloatColorImage& rendered,
                   const LeftOutView& view) {
  const bool has_truth = view.clean.width() > 0;
  const FloatColorImage& wanted = has_truth ? view.clean : view.sensed;
  std::vector<FloatColorImage> pictures{fitted(rendered, wanted, view.judged), wanted};
  if (has_truth) {
    pictures.push_back(view.sensed);
  }
  writeSheet(path.string() + ".png", pictures, boxOf(view.judged), &view.judged);
  if (view.close) {
    const Intrinsics& camera = view.close->camera;
    const std::vector<FloatColorImage> close{
        renderModel(model, index, camera, view.scan_from_color).color, view.close->clean};
    writeSheet(
        path.string() + "_close.png", close, {0, 0, camera.width - 1, camera.height - 1}, nullptr);
  }
}

}  // namespace

TextureFigures judge(const TexturedMesh& model,
                     const Intrinsics& color,
                     std::span<const LeftOutView> views,
                     const std::filesystem::path& pictures) {
  const MeshIndex index(model.mesh);
  Comparison clean;
  Comparison sensed;
  for (std::size_t i = 0; i < views.size(); ++i) {
    const LeftOutView& view = views[i];
    const FloatColorImage rendered = renderModel(model, index, color, view.scan_from_color).color;
    sensed.add(rendered, view.sensed, view);
    if (view.clean.width() > 0) {
      clean.add(rendered, view.clean, view);
    }
    if (!pictures.empty()) {
      writePictures(pictures.string() + "_" + std::to_string(i), model, index, rendered, view);
    }
  }
  return {.psnr_clean_db = clean.meanDb(),
          .least_psnr_clean_db = clean.leastDb(),
          .psnr_sensed_db = sensed.meanDb(),
          .laplacian_to_clean = clean.laplacian(),
          .gradient_to_clean = clean.gradient(),
          .gradient_to_sensed = sensed.gradient()};
}

int seenWithoutColor(const TexturedMesh& model) {
  int count = 0;
  for (std::size_t i = 0; i < model.colors.size(); ++i) {
    const Rgb8 c = model.colors[i];
    const bool seen = model.unseen.empty() || model.unseen[i] == 0;
    count += seen && c.r == 0 && c.g == 0 && c.b == 0 ? 1 : 0;
  }
  return count;
}

}  // namespace tarsus
