// Flux linkage of a machine as a table says it: lambda_d, lambda_q over i_d, i_q, from a finite-element program or a
// measurement.
//
// What is interpolated is one co-energy, a bicubic spline, whose gradient fits the table: so the map conserves energy
// exactly whatever the table's errors, and the incremental inductances are continuous. Where the table is no gradient,
// its lambda_d over i_q contradicting its lambda_q over i_d, the spline cannot follow it and says by how much.
//
// Units: A, Vs, H; peak values in rotor coordinates.

#ifndef STILLSPIN_SIM_HOST_PLANT_FLUX_MAP_HPP
#define STILLSPIN_SIM_HOST_PLANT_FLUX_MAP_HPP

#include <memory>
#include <string>
#include <vector>

namespace stillspin::plant {

struct FluxPoint {
  double id, iq;        // A
  double psi_d, psi_q;  // Vs
};

class FluxMap {
 public:
  /// Fits the spline. The points may be in any order and need no grid, but fill a rectangle that holds zero current.
  /// Points of i_q >= 0 alone stand for both signs: lambda_d is even in i_q, lambda_q odd.
  /// Throws std::invalid_argument when they are too few or are no gradient (by more than 2 % of the largest flux).
  explicit FluxMap(std::vector<FluxPoint> points);

  /// From lines `i_d, i_q, psi_d, psi_q` in A and Vs; a first line without numbers and lines from # are left out.
  /// Throws std::invalid_argument naming the file and the line.
  static std::shared_ptr<const FluxMap> read(const std::string& path);

  /// Co-energy by 2/3 above that at zero current (Vs A), its gradient and its second derivatives. Beyond the table
  /// `inside` is false.
  struct Value {
    double co_energy;
    double psi_d, psi_q;   // Vs
    double ldd, ldq, lqq;  // H
    bool inside;
  };
  Value at(double id, double iq) const;

  double misfit() const { return misfit_; }  // largest difference to the table, Vs

 private:
  struct Axis {
    double first = 0.0, step = 1.0;
    int cells = 0;
    int coefficients() const { return cells + 3; }
    double last() const { return first + step * cells; }
  };
  void choose_axes(const std::vector<FluxPoint>& points);
  void fit(const std::vector<FluxPoint>& points);

  Axis d_, q_;
  std::vector<double> coefficient_;  // of d_, then of q_
  double origin_ = 0.0;              // co-energy at zero current
  double misfit_ = 0.0;
};

}  // namespace stillspin::plant

#endif
