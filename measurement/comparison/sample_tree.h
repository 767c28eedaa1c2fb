#pragma once

#include <Eigen/Core>

#include <memory>
#include <optional>
#include <span>

namespace tarsus {

/// Finds the nearest of some points; may be asked by several threads.
class SampleTree {
 public:
  /// @param points_mm  at least one
  explicit SampleTree(std::span<const Eigen::Vector3d> points_mm);
  ~SampleTree();
  SampleTree(SampleTree&&) noexcept;
  SampleTree& operator=(SampleTree&&) noexcept;

  /// Nothing where none lies within `reach_mm`.
  [[nodiscard]] std::optional<std::size_t> nearest(const Eigen::Vector3d& p_mm,
                                                   double reach_mm) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace tarsus
