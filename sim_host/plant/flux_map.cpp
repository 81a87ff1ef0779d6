#include "sim_host/plant/flux_map.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace stillspin::plant {
namespace {

constexpr int kFewestPoints = 25;
constexpr int kMostCells = 40;  // to an axis
constexpr double kLargestMisfit = 0.02;
// Weight of third differences beside the table. It has to be there: a co-energy that alternates from knot to knot has
// no gradient at any knot. Where inductances change by half over ten cells it costs 1e-6 of the flux.
constexpr double kStiffness = 1e-3;

struct Basis {
  std::array<double, 4> value, slope, bend;  // by cell, cell^-1, cell^-2
};

// Uniform cubic B-splines, x in 0..1 of a cell.
Basis basis(double x) {
  const double y = 1.0 - x;
  return {{y * y * y / 6.0, (3.0 * x * x * x - 6.0 * x * x + 4.0) / 6.0, (3.0 * y * y * y - 6.0 * y * y + 4.0) / 6.0,
           x * x * x / 6.0},
          {-0.5 * y * y, 1.5 * x * x - 2.0 * x, -1.5 * y * y + 2.0 * y, 0.5 * x * x},
          {y, 3.0 * x - 2.0, 3.0 * y - 2.0, x}};
}

int cell_of(double at, double first, double step, int cells) {
  return std::clamp(static_cast<int>(std::floor((at - first) / step)), 0, cells - 1);
}

[[noreturn]] void refuse(const std::string& words) { throw std::invalid_argument("flux map: " + words); }

void mirror(std::vector<FluxPoint>& points) {
  const bool half = std::none_of(points.begin(), points.end(), [](const FluxPoint& p) { return p.iq < 0.0; });
  if (!half) return;
  const std::size_t given = points.size();
  for (std::size_t n = 0; n < given; ++n) {
    const FluxPoint p = points[n];
    if (p.iq > 0.0) points.push_back({p.id, -p.iq, p.psi_d, -p.psi_q});
  }
}

// How many numbers a line has, -1 when something in it is none.
int numbers_of(const std::string& line, std::array<double, 4>& row) {
  std::string text = line;
  std::replace_if(text.begin(), text.end(), [](char c) { return c == ',' || c == ';' || c == '\t'; }, ' ');
  std::istringstream words(text);
  int count = 0;
  for (double x; words >> x; ++count) {
    if (count < 4) row[static_cast<std::size_t>(count)] = x;
  }
  return words.eof() ? count : -1;
}

}  // namespace

std::shared_ptr<const FluxMap> FluxMap::read(const std::string& path) {
  std::ifstream file(path);
  if (!file) refuse(path + ": cannot be read");
  std::vector<FluxPoint> points;
  int number = 0;
  bool begun = false;
  for (std::string line; std::getline(file, line);) {
    ++number;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.find_first_not_of(" \t") == std::string::npos || line[0] == '#') continue;
    std::array<double, 4> row{};
    const int count = numbers_of(line, row);
    if (count == 4) {
      points.push_back({row[0], row[1], row[2], row[3]});
    } else if (begun || count >= 0) {  // the first may be words
      refuse(path + ": line " + std::to_string(number) +
             ": must be four numbers, i_d, i_q in A and psi_d, psi_q in Vs");
    }
    begun = true;
  }
  try {
    return std::make_shared<const FluxMap>(std::move(points));
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + " (" + path + ")");
  }
}

FluxMap::FluxMap(std::vector<FluxPoint> points) {
  for (const FluxPoint& p : points) {
    if (!std::isfinite(p.id + p.iq + p.psi_d + p.psi_q)) refuse("a number is not finite");
  }
  mirror(points);
  if (points.size() < kFewestPoints) {
    refuse(std::to_string(points.size()) + " points are too few; " + std::to_string(kFewestPoints) + " are the least");
  }
  choose_axes(points);
  fit(points);
  origin_ = at(0.0, 0.0).co_energy;
  double largest = 0.0;
  const FluxPoint* worst = &points.front();
  for (const FluxPoint& p : points) {
    const Value v = at(p.id, p.iq);
    const double off = std::hypot(v.psi_d - p.psi_d, v.psi_q - p.psi_q);
    largest = std::max(largest, std::hypot(p.psi_d, p.psi_q));
    if (off > misfit_) worst = &p;
    misfit_ = std::max(misfit_, off);
  }
  if (!(misfit_ <= kLargestMisfit * largest)) {
    std::ostringstream words;
    words << "lambda_d over i_q and lambda_q over i_d contradict each other: at i_d = " << worst->id
          << " A, i_q = " << worst->iq << " A no energy has these fluxes; the nearest is " << misfit_
          << " Vs off, at most " << kLargestMisfit * largest << " Vs may be";
    refuse(words.str());
  }
  const Value zero = at(0.0, 0.0);
  if (!(zero.ldd > 0.0 && zero.ldd * zero.lqq > zero.ldq * zero.ldq)) {
    refuse("the inductances at zero current are not positive; are the columns i_d, i_q, psi_d, psi_q?");
  }
}

void FluxMap::choose_axes(const std::vector<FluxPoint>& points) {
  const auto axis = [&](double FluxPoint::* current, const char* name) {
    std::vector<double> values;
    for (const FluxPoint& p : points) values.push_back(p.*current);
    std::sort(values.begin(), values.end());
    const double first = values.front(), last = values.back();
    if (!(first <= 0.0 && last >= 0.0 && last > first)) {
      std::ostringstream words;
      words << name << " goes from " << first << " to " << last << " A; zero current must be within";
      refuse(words.str());
    }
    // As many cells as there are different currents, less one.
    const double least = 1e-6 * (last - first);
    int different = 1;
    for (std::size_t n = 1; n < values.size(); ++n) different += values[n] - values[n - 1] > least;
    const int cells = std::clamp(different - 1, 2, kMostCells);
    return Axis{first, (last - first) / cells, cells};
  };
  d_ = axis(&FluxPoint::id, "i_d");
  q_ = axis(&FluxPoint::iq, "i_q");
}

void FluxMap::fit(const std::vector<FluxPoint>& points) {
  const int rows = d_.coefficients(), columns = q_.coefficients();
  using Triplet = Eigen::Triplet<double>;
  std::vector<Triplet> triplets;
  std::vector<double> wanted;
  const auto index = [&](int m, int n) { return m * columns + n; };
  for (const FluxPoint& p : points) {
    const int md = cell_of(p.id, d_.first, d_.step, d_.cells), mq = cell_of(p.iq, q_.first, q_.step, q_.cells);
    const Basis d = basis((p.id - d_.first) / d_.step - md), q = basis((p.iq - q_.first) / q_.step - mq);
    const int row = static_cast<int>(wanted.size());
    for (int m = 0; m < 4; ++m) {
      for (int n = 0; n < 4; ++n) {
        const auto a = static_cast<std::size_t>(m), b = static_cast<std::size_t>(n);
        triplets.emplace_back(row, index(md + m, mq + n), d.slope[a] * q.value[b] / d_.step);
        triplets.emplace_back(row + 1, index(md + m, mq + n), d.value[a] * q.slope[b] / q_.step);
      }
    }
    wanted.push_back(p.psi_d);
    wanted.push_back(p.psi_q);
  }
  constexpr std::array<double, 4> kThird{-1.0, 3.0, -3.0, 1.0};
  const auto stiffen = [&](int m, int n, int dm, int dn, double step) {
    const int row = static_cast<int>(wanted.size());
    for (int k = 0; k < 4; ++k) {
      triplets.emplace_back(row, index(m + k * dm, n + k * dn),
                            kThird[static_cast<std::size_t>(k)] * kStiffness / step);
    }
    wanted.push_back(0.0);
  };
  for (int m = 0; m < rows; ++m) {
    for (int n = 0; n < columns; ++n) {
      if (m + 3 < rows) stiffen(m, n, 1, 0, d_.step);
      if (n + 3 < columns) stiffen(m, n, 0, 1, q_.step);
    }
  }
  // A constant has no gradient: the sum of all is zero.
  const int anchor = static_cast<int>(wanted.size());
  triplets.emplace_back(anchor, 0, 1.0 / d_.step);
  wanted.push_back(0.0);
  Eigen::SparseMatrix<double> matrix(anchor + 1, rows * columns);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  const Eigen::Map<const Eigen::VectorXd> right(wanted.data(), anchor + 1);
  const Eigen::SparseMatrix<double> normal = matrix.transpose() * matrix;
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(normal);
  if (solver.info() != Eigen::Success) refuse("the points do not say what is between them");
  const Eigen::VectorXd found = solver.solve(matrix.transpose() * right);
  coefficient_.assign(found.data(), found.data() + found.size());
}

FluxMap::Value FluxMap::at(double id, double iq) const {
  const int md = cell_of(id, d_.first, d_.step, d_.cells), mq = cell_of(iq, q_.first, q_.step, q_.cells);
  const Basis d = basis((id - d_.first) / d_.step - md), q = basis((iq - q_.first) / q_.step - mq);
  const double per_d = 1.0 / d_.step, per_q = 1.0 / q_.step;
  Value v{-origin_, 0.0, 0.0, 0.0, 0.0, 0.0, true};
  for (std::size_t m = 0; m < 4; ++m) {
    const double* const c =
        &coefficient_[(static_cast<std::size_t>(md) + m) * static_cast<std::size_t>(q_.coefficients()) +
                      static_cast<std::size_t>(mq)];
    const double value = c[0] * q.value[0] + c[1] * q.value[1] + c[2] * q.value[2] + c[3] * q.value[3];
    const double slope = (c[0] * q.slope[0] + c[1] * q.slope[1] + c[2] * q.slope[2] + c[3] * q.slope[3]) * per_q;
    const double bend = (c[0] * q.bend[0] + c[1] * q.bend[1] + c[2] * q.bend[2] + c[3] * q.bend[3]) * per_q * per_q;
    v.co_energy += d.value[m] * value;
    v.psi_d += d.slope[m] * per_d * value;
    v.psi_q += d.value[m] * slope;
    v.ldd += d.bend[m] * per_d * per_d * value;
    v.ldq += d.slope[m] * per_d * slope;
    v.lqq += d.value[m] * bend;
  }
  v.inside = id >= d_.first && id <= d_.last() && iq >= q_.first && iq <= q_.last();
  return v;
}

}  // namespace stillspin::plant
