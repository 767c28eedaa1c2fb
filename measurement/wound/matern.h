#pragma once

#include <Eigen/Core>

namespace tarsus {

/// The Matern 5/2 correlation of p with each place, (1 + x + x^2 / 3) exp(-x), x = sqrt(5) distance
/// / length; to 1e-15. Nearly all of a skin's fit goes into these, hence a loop of its own that
/// gives the same bits on every processor.
/// @param places  n x 2 [mm]
/// @param result  n
void matern(const Eigen::Vector2d& p,
            const Eigen::ArrayX2d& places,
            double length_mm,
            Eigen::Ref<Eigen::VectorXd> result);

}  // namespace tarsus
