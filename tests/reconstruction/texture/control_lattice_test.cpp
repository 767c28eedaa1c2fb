#include "reconstruction/texture/control_lattice.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace tarsus {
namespace {

/// Single precision on places up to 640 px.
constexpr float kRounding_px = 2e-4F;

float spacing(int width_px, int columns) {
  return static_cast<float>(width_px - 1) / static_cast<float>(columns - 1);
}

Eigen::Vector2f nodePlace(const ControlLattice& lattice, int node, float spacing_px) {
  return {spacing_px * static_cast<float>(node % lattice.columns()),
          spacing_px * static_cast<float>(node / lattice.columns())};
}

Eigen::Vector2f affineOffset(const Eigen::Vector2f& place) {
  return {1.5F + 0.004F * place.x() - 0.007F * place.y(),
          -0.5F + 0.002F * place.x() + 0.005F * place.y()};
}

ControlLattice affineLattice(int width_px, int height_px, int columns) {
  ControlLattice lattice(width_px, height_px, columns);
  for (int i = 0; i < lattice.columns() * lattice.rows(); ++i) {
    lattice.offsets_px()[static_cast<std::size_t>(i)] =
        affineOffset(nodePlace(lattice, i, spacing(width_px, columns)));
  }
  return lattice;
}

TEST(ControlLattice, EmptyMovesNothing) {
  const ControlLattice lattice;
  EXPECT_TRUE(lattice.empty());
  EXPECT_EQ(lattice.columns(), 0);
  const Eigen::Vector2f place(-3.25F, 700.5F);
  EXPECT_EQ(lattice.warped(place), place);
}

TEST(ControlLattice, BeginsWithoutWarp) {
  const ControlLattice lattice(320, 240, 20);
  EXPECT_FALSE(lattice.empty());
  const Eigen::Vector2f place(17.3F, 211.9F);
  EXPECT_EQ(lattice.warped(place), place);
}

TEST(ControlLattice, HasSquareCellsThatCoverTheImage) {
  struct Size {
    int width_px, height_px, columns;
  };
  for (const Size& size : {Size{320, 240, 20},
                           Size{640, 480, 16},
                           Size{640, 480, 21},
                           Size{1280, 720, 20},
                           Size{480, 640, 16},
                           Size{33, 33, 9},
                           Size{100, 3, 2}}) {
    const ControlLattice lattice(size.width_px, size.height_px, size.columns);
    const float spacing_px = spacing(size.width_px, size.columns);
    EXPECT_EQ(lattice.columns(), size.columns);
    EXPECT_EQ(lattice.offsets_px().size(),
              static_cast<std::size_t>(lattice.columns() * lattice.rows()));
    // As many rows as reach the last line of the image, and not one more; two at least.
    const float reach_px = spacing_px * static_cast<float>(lattice.rows() - 1);
    EXPECT_GE(reach_px, 0.998F * static_cast<float>(size.height_px - 1));
    if (lattice.rows() > 2) {
      EXPECT_LT(reach_px - spacing_px, static_cast<float>(size.height_px - 1));
    }
  }
}

TEST(ControlLattice, TakesUpANodesOffsetAtTheNodeAlone) {
  ControlLattice lattice(320, 240, 20);
  const float spacing_px = spacing(320, 20);
  const int node = 7 * lattice.columns() + 11;
  const Eigen::Vector2f offset(2.0F, -1.0F);
  lattice.offsets_px()[static_cast<std::size_t>(node)] = offset;
  const Eigen::Vector2f place = nodePlace(lattice, node, spacing_px);
  EXPECT_LT((lattice.warped(place) - place - offset).norm(), kRounding_px);
  // Half way to a neighbour half of it, at the neighbours and beyond nothing.
  const Eigen::Vector2f half = place + Eigen::Vector2f(0.5F * spacing_px, 0.0F);
  EXPECT_LT((lattice.warped(half) - half - 0.5F * offset).norm(), kRounding_px);
  for (const int step : {1, -1, lattice.columns(), -lattice.columns()}) {
    const Eigen::Vector2f beside = nodePlace(lattice, node + step, spacing_px);
    EXPECT_LT((lattice.warped(beside) - beside).norm(), kRounding_px);
  }
}

TEST(ControlLattice, GivesAffineOffsetsBackExactly) {
  for (const int columns : {2, 16, 20}) {
    const ControlLattice lattice = affineLattice(320, 240, columns);
    for (float v = 0.0F; v <= 239.0F; v += 7.3F) {
      for (float u = 0.0F; u <= 319.0F; u += 9.7F) {
        const Eigen::Vector2f place(u, v);
        EXPECT_LT((lattice.warped(place) - place - affineOffset(place)).norm(), kRounding_px)
            << place.transpose();
      }
    }
  }
}

TEST(ControlLattice, SharesSumToOneAndAreNeverNegative) {
  const ControlLattice lattice(320, 240, 20);
  for (float v = -30.0F; v <= 280.0F; v += 5.3F) {
    for (float u = -30.0F; u <= 350.0F; u += 5.9F) {
      const ControlLattice::Cell cell = lattice.cellAt({u, v});
      EXPECT_NEAR(std::accumulate(cell.share.begin(), cell.share.end(), 0.0F), 1.0F, 1e-5F);
      for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_GE(cell.share[k], 0.0F);
        EXPECT_GE(cell.node[k], 0);
        EXPECT_LT(cell.node[k], static_cast<int>(lattice.offsets_px().size()));
      }
    }
  }
}

TEST(ControlLattice, CarriesTheRimsOffsetOutsideTheImage) {
  const ControlLattice lattice = affineLattice(320, 240, 20);
  const auto offsetAt = [&](const Eigen::Vector2f& place) {
    return Eigen::Vector2f(lattice.warped(place) - place);
  };
  EXPECT_LT((offsetAt({-40.0F, 100.0F}) - affineOffset({0.0F, 100.0F})).norm(), kRounding_px);
  EXPECT_LT((offsetAt({500.0F, 100.0F}) - affineOffset({319.0F, 100.0F})).norm(), kRounding_px);
  EXPECT_LT((offsetAt({50.0F, -90.0F}) - affineOffset({50.0F, 0.0F})).norm(), kRounding_px);
  EXPECT_LT((offsetAt({-70.0F, 900.0F}) - offsetAt({0.0F, 260.0F})).norm(), kRounding_px);
}

}  // namespace
}  // namespace tarsus
