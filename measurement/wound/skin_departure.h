#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <map>
#include <memory>
#include <span>
#include <vector>

namespace tarsus {

/// Healthy skin averaged over small cells, as the departure from a biconic is estimated from it:
/// value = base * parameters + cosine * departure(uv) + noise.
struct SkinCells {
  Eigen::Matrix2Xd uv;                            ///< 2 x n in the skin's tangent plane [mm]
  Eigen::VectorXd value_mm;                       ///< n distance along the normal
  Eigen::VectorXd cosine;                         ///< n of the skin's normal to the plane's
  Eigen::VectorXd precision;                      ///< n 1 / variance of the noise [1/mm^2]
  Eigen::Matrix<double, Eigen::Dynamic, 6> base;  ///< n x 6 by C11, C12, C22, 1, u, v

  [[nodiscard]] Eigen::Index count() const { return uv.cols(); }
};

/// Standard deviation and correlation length of a departure.
struct DepartureKind {
  double amplitude_mm = 0.0;
  double length_mm = 15.0;
};

/// How skin departs from its biconic: a Gaussian process with the Matern 5/2 covariance. How much
/// it departs is not assumed but weighed: each amplitude by the evidence of the cells, so that
/// skin that is a sphere is treated as one, and a bumpy foot as bumpy.
/// Source: universal kriging with restricted likelihood, Rasmussen and Williams, Gaussian Processes
/// for Machine Learning, MIT Press 2006, sections 2.7 and 5.4; the choice is our benchmark's.
class SkinDeparture {
 public:
  using Parameters = Eigen::Matrix<double, 6, 1>;

  SkinDeparture() = default;
  /// @param kinds  to be weighed against each other
  SkinDeparture(SkinCells cells, std::span<const DepartureKind> kinds);

  /// Expected values over all amplitudes.
  [[nodiscard]] const Parameters& parameters() const { return parameters_; }
  [[nodiscard]] double at(const Eigen::Vector2d& uv) const;
  /// Root mean square amplitude by evidence [mm].
  [[nodiscard]] double amplitude_mm() const;

  /// Covariance of the height at each pair of places [mm^2], from the noise and from what the skin
  /// may do where nothing was fitted.
  /// @param base  q x 6 derivatives of the height by the parameters
  [[nodiscard]] Eigen::MatrixXd covariance(
      const Eigen::Matrix2Xd& uv, const Eigen::Matrix<double, Eigen::Dynamic, 6>& base) const;

 private:
  struct Candidate {
    DepartureKind kind;
    double weight = 0.0;   ///< its share of the evidence
    Eigen::MatrixXd root;  ///< n x n lower Cholesky factor of the cells' covariance
    Eigen::Matrix<double, Eigen::Dynamic, 6> base;         ///< root^-1 base
    Eigen::LDLT<Eigen::Matrix<double, 6, 6>> information;  ///< of the parameters
    Parameters parameters = Parameters::Zero();
    Eigen::VectorXd rest;  ///< n root^-1 (values - base * parameters)
    double log_evidence = 0.0;
  };
  [[nodiscard]] Candidate solve(const Eigen::MatrixXd& alike, const DepartureKind& kind) const;
  [[nodiscard]] Eigen::MatrixXd alikeness(double length_mm) const;
  /// #cells x #places correlation of the cells' departures with those at the places.
  [[nodiscard]] Eigen::MatrixXd across(const Eigen::Matrix2Xd& uv, double length_mm) const;

  SkinCells cells_;
  std::vector<Candidate> candidates_;
  /// n, departure = sum over the lengths of pull times correlation.
  std::map<double, Eigen::VectorXd> pull_by_length_;
  Parameters parameters_ = Parameters::Zero();
};

/// The departure tabulated, so that feet of normals cost little: cubic convolution (Keys 1981).
/// Nodes are costly, so that they are filled where they are needed.
class DepartureTable {
 public:
  DepartureTable() = default;
  /// Spans the box [low, high] of the tangent plane; constant outside. Nothing is filled yet.
  DepartureTable(std::shared_ptr<const SkinDeparture> departure,
                 const Eigen::Vector2d& low_mm,
                 const Eigen::Vector2d& high_mm);

  /// Makes `at` good at these places, or everywhere.
  void fillUnder(const Eigen::Matrix2Xd& uv);
  void fill();

  struct Shape {
    double height = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();
    Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  };
  /// Not a number where nothing was filled; 0 everywhere where nothing was tabulated.
  [[nodiscard]] Shape at(const Eigen::Vector2d& uv) const;

 private:
  using Needed = Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic>;
  /// The cell that holds the place, and where in it, 0 to 1.
  struct Place {
    Eigen::Vector2i cell;
    Eigen::Vector2d inside;
  };
  [[nodiscard]] Place locate(const Eigen::Vector2d& uv) const;
  void fillWhere(const Needed& needed);

  std::shared_ptr<const SkinDeparture> departure_;
  Eigen::Vector2d low_mm_ = Eigen::Vector2d::Zero();
  Eigen::MatrixXd heights_;  ///< one node beyond the box on each side
};

}  // namespace tarsus
