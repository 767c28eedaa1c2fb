#include "reconstruction/texture/color_alignment.h"

#include "reconstruction/base/parallel.h"
#include "reconstruction/texture/picture_fit.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>

namespace tarsus {
namespace {

constexpr std::size_t kChunk = 8192;  // vertices a thread takes at once
constexpr int kHalvings = 5;          // of a step before it is dropped

/// One size of the pyramid: how small, and its share of the rigid iterations.
struct Size {
  int factor;
  double share;
};
constexpr std::array kSizes{Size{4, 0.4}, Size{2, 0.3}, Size{1, 0.3}};

/// What the pictures say together, and how well they agree.
class Agreement {
 public:
  Agreement(std::span<const Eigen::Vector3f> vertices,
            std::span<PictureFit> fits,
            const ColorAlignmentOptions& options)
      : vertices_(vertices),
        fits_(fits),
        huber_(static_cast<float>(options.huber_levels)),
        wanted_(vertices.size(), 0.0F),
        weights_(vertices.size(), 0.0F) {}

  /// After the pictures changed size: where each chunk of vertices begins in each.
  void useSight(std::size_t vertex_limit) {
    chunks_ = (vertex_limit + kChunk - 1) / kChunk;
    begin_.assign(fits_.size() * (chunks_ + 1), 0);
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      const std::span<const SightLine> sight = fits_[k].sight();
      for (std::size_t chunk = 0; chunk <= chunks_; ++chunk) {
        const auto at = std::partition_point(sight.begin(), sight.end(), [&](const SightLine& s) {
          return s.vertex < chunk * kChunk;
        });
        begin_[k * (chunks_ + 1) + chunk] = static_cast<std::size_t>(at - sight.begin());
      }
    }
  }

  /// Samples all pictures and takes their means.
  /// @return robust sum of squares [grey levels^2]
  double update() {
    parallelFor(static_cast<int>(fits_.size()),
                [&](int k) { fits_[static_cast<std::size_t>(k)].sample(vertices_); });
    std::vector<double> energies(chunks_, 0.0);
    parallelFor(static_cast<int>(chunks_), [&](int chunk) {
      energies[static_cast<std::size_t>(chunk)] = average(static_cast<std::size_t>(chunk));
    });
    double energy = 0.0;
    for (const double part : energies) {
      energy += part;
    }
    return energy;
  }

  [[nodiscard]] std::span<const float> wanted() const { return wanted_; }

 private:
  template <typename Use>
  void eachSight(std::size_t chunk, const Use& use) const {
    for (std::size_t k = 0; k < fits_.size(); ++k) {
      const std::span<const SightLine> sight = fits_[k].sight();
      const std::span<const float> values = fits_[k].values();
      const std::size_t end = begin_[k * (chunks_ + 1) + chunk + 1];
      for (std::size_t i = begin_[k * (chunks_ + 1) + chunk]; i < end; ++i) {
        use(sight[i].vertex, sight[i].weight, values[i]);
      }
    }
  }

  /// Mean of each vertex, then once more with those far from it counting less.
  double average(std::size_t chunk) {
    const std::size_t first = chunk * kChunk;
    const std::size_t count = std::min(kChunk, vertices_.size() - first);
    const std::span<float> wanted = std::span(wanted_).subspan(first, count);
    const std::span<float> weights = std::span(weights_).subspan(first, count);
    std::vector<float> sums(count, 0.0F);
    const auto divide = [&] {
      for (std::size_t i = 0; i < count; ++i) {
        wanted[i] = weights[i] > 0.0F ? sums[i] / weights[i] : 0.0F;
      }
    };
    std::ranges::fill(weights, 0.0F);
    eachSight(chunk, [&](std::size_t vertex, float weight, float value) {
      sums[vertex - first] += weight * value;
      weights[vertex - first] += weight;
    });
    divide();
    std::ranges::fill(weights, 0.0F);
    std::ranges::fill(sums, 0.0F);
    eachSight(chunk, [&](std::size_t vertex, float weight, float value) {
      const float size = std::abs(value - wanted[vertex - first]);
      const float counted = size <= huber_ ? weight : weight * huber_ / size;
      sums[vertex - first] += counted * value;
      weights[vertex - first] += counted;
    });
    divide();
    double energy = 0.0;
    eachSight(chunk, [&](std::size_t vertex, float weight, float value) {
      const float size = std::abs(value - wanted[vertex - first]);
      const float loss = size <= huber_ ? size * size : huber_ * (2.0F * size - huber_);
      energy += static_cast<double>(weight * loss);
    });
    return energy;
  }

  std::span<const Eigen::Vector3f> vertices_;
  std::span<PictureFit> fits_;
  float huber_;
  std::size_t chunks_ = 0;
  std::vector<std::size_t> begin_;  ///< of each picture's chunks, in its lines of sight
  std::vector<float> wanted_;
  std::vector<float> weights_;
};

class Alignment {
 public:
  Alignment(std::span<const Eigen::Vector3f> vertices,
            const Intrinsics& camera,
            std::span<AlignedPicture> pictures,
            const ColorAlignmentOptions& options,
            const Job& job)
      : vertices_(vertices),
        options_(options),
        job_(job),
        fits_(makeFits(camera, pictures, options)),
        agreement_(vertices, fits_, options) {}

  ColorAlignment run() {
    int left = options_.rigid_iterations;
    for (const Size& size : kSizes) {
      const bool last = size.factor == 1;
      const int own = last ? left : static_cast<int>(size.share * options_.rigid_iterations);
      left -= own;
      useSize(size.factor);
      measureNoise();
      AlignmentPhase& phase = last ? result_.rigid_full_size : result_.rigid_small_sizes;
      iterate(own, phase, [this](PictureFit& fit) {
        fit.planRigidStep(vertices_, agreement_.wanted(), variance_);
      });
    }
    if (options_.lattice_iterations > 0 && total_weight_ > 0.0) {
      measureNoise();
      for (PictureFit& fit : fits_) {
        fit.useLattice();
      }
      iterate(options_.lattice_iterations, result_.lattice, [this](PictureFit& fit) {
        fit.planLatticeStep(vertices_, agreement_.wanted(), variance_);
      });
    }
    return std::move(result_);
  }

 private:
  static std::vector<PictureFit> makeFits(const Intrinsics& camera,
                                          std::span<AlignedPicture> pictures,
                                          const ColorAlignmentOptions& options) {
    std::vector<PictureFit> fits;
    fits.reserve(pictures.size());
    for (AlignedPicture& picture : pictures) {
      fits.emplace_back(picture, camera, options);
    }
    return fits;
  }

  void useSize(int factor) {
    const auto area = static_cast<std::size_t>(factor) * static_cast<std::size_t>(factor);
    const std::size_t limit = (vertices_.size() + area - 1) / area;
    parallelFor(static_cast<int>(fits_.size()),
                [&](int k) { fits_[static_cast<std::size_t>(k)].useSize(factor, limit); });
    agreement_.useSight(limit);
    total_weight_ = 0.0;
    observations_ = 0;
    for (const PictureFit& fit : fits_) {
      observations_ += fit.sight().size();
      for (const SightLine& line : fit.sight()) {
        total_weight_ += static_cast<double>(line.weight);
      }
    }
    if (factor == 1) {
      result_.vertex_observations = observations_;
    }
  }

  /// The priors count against the disagreement that there is when a phase begins.
  void measureNoise() {
    variance_ = total_weight_ > 0.0 ? agreement_.update() / total_weight_ : 0.0;
  }

  double energy() {
    double sum = agreement_.update();
    for (const PictureFit& fit : fits_) {
      sum += fit.priorEnergy(variance_);
    }
    return sum;
  }

  void moveAll(double share) {
    for (PictureFit& fit : fits_) {
      fit.move(share);
    }
  }

  template <typename Plan>
  void iterate(int iterations, AlignmentPhase& phase, const Plan& plan) {
    if (iterations <= 0 || !(total_weight_ > 0.0)) {
      return;
    }
    const auto start = std::chrono::steady_clock::now();
    const bool full_size = &phase != &result_.rigid_small_sizes;
    double current = energy();
    const auto note = [&] {
      if (full_size) {
        result_.rmse.push_back(std::sqrt(current / total_weight_));
      }
    };
    if (result_.rmse.empty()) {
      note();
    }
    for (int done = 0; done < iterations && !job_.stopped(); ++done) {
      report();
      parallelFor(static_cast<int>(fits_.size()),
                  [&](int k) { plan(fits_[static_cast<std::size_t>(k)]); });
      const double next = step(current);
      const bool slow = current - next < options_.least_relative_drop * current;
      current = next;
      note();
      ++phase.iterations;
      if (slow) {
        break;
      }
    }
    phase.seconds +=
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  /// Takes as much of the planned step as makes the whole better.
  double step(double current) {
    double share = 1.0;
    for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
      moveAll(share);
      const double next = energy();
      if (next <= current) {
        return next;
      }
    }
    moveAll(0.0);
    return energy();
  }

  void report() {
    ++iterations_done_;
    const double all = std::max(1, options_.rigid_iterations + options_.lattice_iterations);
    job_.report("align colours", std::min(1.0, iterations_done_ / all));
  }

  std::span<const Eigen::Vector3f> vertices_;
  const ColorAlignmentOptions& options_;
  const Job& job_;
  std::vector<PictureFit> fits_;
  Agreement agreement_;
  ColorAlignment result_;
  double total_weight_ = 0.0;
  double variance_ = 0.0;
  std::size_t observations_ = 0;
  int iterations_done_ = 0;
};

}  // namespace

ColorAlignment alignPictures(std::span<const Eigen::Vector3f> vertices,
                             const Intrinsics& camera,
                             std::span<AlignedPicture> pictures,
                             const ColorAlignmentOptions& options,
                             const Job& job) {
  return Alignment(vertices, camera, pictures, options, job).run();
}

}  // namespace tarsus
