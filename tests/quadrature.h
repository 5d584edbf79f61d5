// Quadrature over microfacet normals and over cells of the sphere.
#ifndef MICROLANE_TESTS_QUADRATURE_H_
#define MICROLANE_TESTS_QUADRATURE_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "columns.h"

namespace microlane {

struct Rule {
  std::vector<double> node, weight;
};

// Gauss-Legendre on [-1, 1]; exact for polynomials of degree 2 count - 1.
inline Rule GaussLegendre(int count) {
  Rule rule;
  for (int k = 0; k < count; ++k) {
    double x = -std::cos(kTestPi * (k + 0.75) / (count + 0.5)), slope = 1;
    for (int step = 0; step < 8; ++step) {
      double p = 1, before = 0;
      for (int j = 0; j < count; ++j) {
        const double next = ((2 * j + 1) * x * p - j * before) / (j + 1);
        before = p;
        p = next;
      }
      slope = count * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    rule.node.push_back(x);
    rule.weight.push_back(2 / ((1 - x * x) * slope * slope));
  }
  return rule;
}

// Unit normals of the upper hemisphere and the solid angle that each stands for.
struct NormalNodes {
  DirectionColumns<double> m;
  Column<double> solid_angle;

  std::size_t size() const { return m.size(); }
  // A normal of slope (scale_x u, scale_y w) that stands for `area` of the (u, w) plane.
  void PushBack(double scale_x, double scale_y, double u, double w, double area) {
    const double x = scale_x * u, y = scale_y * w, z = 1 / std::sqrt(1 + x * x + y * y);
    m.PushBack({x * z, y * z, z});
    solid_angle.push_back(scale_x * scale_y * area * z * z * z);
  }
};

// The whole hemisphere. Slopes are stretched by the scales: the trapezoidal rule in the logarithm of the
// stretched slope's length and in its azimuth, where every distribution is smooth, decays at both ends and is
// periodic.
inline NormalNodes AllNormals(double scale_x, double scale_y, int num_azimuths = 48) {
  constexpr double kStep = 0.125, kEnd = 24;
  NormalNodes nodes;
  constexpr int kSteps = static_cast<int>(kEnd / kStep);
  for (int j = -kSteps; j <= kSteps; ++j) {
    const double log_r = j * kStep;
    const double r = std::exp(log_r);
    for (int k = 0; k < num_azimuths; ++k) {
      const double phi = (k + 0.5) * (2 * kTestPi / num_azimuths);
      nodes.PushBack(scale_x, scale_y, r * std::cos(phi), r * std::sin(phi),
                     r * r * kStep * 2 * kTestPi / num_azimuths);
    }
  }
  return nodes;
}

enum class Side { kFacing, kAverted };

// The normals with v.m > 0 (kFacing) or v.m < 0 (kAverted), v.z > 0. With v's azimuth along P, v.m changes
// sign at P = -a, a = v.z / |(scale_x v.x, scale_y v.y)|; so P = -cot(delta) by Gauss-Legendre in delta to or
// from that edge, and Q = tan(psi) / sin(delta) by the trapezoidal rule, in which GGX is a trigonometric
// polynomial.
inline NormalNodes NormalsOnSide(const Direction& v, double scale_x, double scale_y, Side side, int num_delta,
                                 int num_psi) {
  const double sx = scale_x * v.x, sy = scale_y * v.y, s = std::sqrt(sx * sx + sy * sy);
  const double px = s > 0 ? sx / s : 1, py = s > 0 ? sy / s : 0;
  const double edge = std::atan2(s, v.z);
  const double low = side == Side::kFacing ? edge : 0, high = side == Side::kFacing ? kTestPi : edge;
  const Rule rule = GaussLegendre(num_delta);
  NormalNodes nodes;
  for (int j = 0; j < num_delta; ++j) {
    const double delta = low + (high - low) * 0.5 * (1 + rule.node[j]);
    const double p = -1 / std::tan(delta), cosec = 1 / std::sin(delta);
    for (int k = 0; k < num_psi; ++k) {
      const double psi = kTestPi * ((k + 0.5) / num_psi - 0.5), sec = 1 / std::cos(psi);
      const double q = cosec * std::tan(psi);
      const double area =
          (high - low) * 0.5 * rule.weight[j] * (kTestPi / num_psi) * cosec * cosec * cosec * sec * sec;
      nodes.PushBack(scale_x, scale_y, p * px - q * py, p * py + q * px, area);
    }
  }
  return nodes;
}

// A rectangle of spherical coordinates.
struct Cell {
  double theta_low, theta_high, phi_low, phi_high;
};

struct CellIntegrals {
  std::vector<double> value;
  std::size_t num_evaluations = 0;
  double error = 0;  // estimate over all cells
};

// Integrals over solid angle of `density`, called as Column<double>(const DirectionColumns<double>&), over
// each cell. A rectangle is quartered until its quarters, by 5 x 5 Gauss-Legendre nodes each, sum to what it
// gave itself, within `tolerance` halved with each quartering; at most 9 times, which a jump of the density
// asks for.
template <class Density>
CellIntegrals IntegrateCells(const std::vector<Cell>& cells, double tolerance, const Density& density) {
  constexpr int kCount = 5, kMaxDepth = 9;
  static const Rule rule = GaussLegendre(kCount);
  struct Piece {
    std::size_t cell;
    Cell area;
    double value;
  };
  CellIntegrals result;
  result.value.assign(cells.size(), 0.0);

  const auto evaluate = [&](std::vector<Piece>& pieces) {
    DirectionColumns<double> directions;
    Column<double> weights;
    for (const Piece& piece : pieces) {
      const double half_theta = 0.5 * (piece.area.theta_high - piece.area.theta_low);
      const double half_phi = 0.5 * (piece.area.phi_high - piece.area.phi_low);
      double cos_phi[kCount], sin_phi[kCount];
      for (int k = 0; k < kCount; ++k) {
        const double phi = piece.area.phi_low + half_phi * (1 + rule.node[k]);
        cos_phi[k] = std::cos(phi);
        sin_phi[k] = std::sin(phi);
      }
      for (int j = 0; j < kCount; ++j) {
        const double theta = piece.area.theta_low + half_theta * (1 + rule.node[j]);
        const double sin_theta = std::sin(theta), cos_theta = std::cos(theta);
        for (int k = 0; k < kCount; ++k) {
          directions.PushBack({sin_theta * cos_phi[k], sin_theta * sin_phi[k], cos_theta});
          weights.push_back(half_theta * half_phi * rule.weight[j] * rule.weight[k] * sin_theta);
        }
      }
    }
    const Column<double> values = density(directions);
    result.num_evaluations += values.size();
    for (std::size_t p = 0; p < pieces.size(); ++p) {
      pieces[p].value = 0;
      for (std::size_t k = p * kCount * kCount; k < (p + 1) * kCount * kCount; ++k) {
        pieces[p].value += weights[k] * values[k];
      }
    }
  };

  std::vector<Piece> active;
  active.reserve(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) active.push_back({c, cells[c], 0});
  evaluate(active);
  for (int depth = 0; !active.empty(); ++depth, tolerance *= 0.5) {
    std::vector<Piece> quarters;
    for (const Piece& piece : active) {
      const Cell& a = piece.area;
      const double theta = 0.5 * (a.theta_low + a.theta_high), phi = 0.5 * (a.phi_low + a.phi_high);
      quarters.push_back({piece.cell, {a.theta_low, theta, a.phi_low, phi}, 0});
      quarters.push_back({piece.cell, {theta, a.theta_high, a.phi_low, phi}, 0});
      quarters.push_back({piece.cell, {a.theta_low, theta, phi, a.phi_high}, 0});
      quarters.push_back({piece.cell, {theta, a.theta_high, phi, a.phi_high}, 0});
    }
    evaluate(quarters);
    std::vector<Piece> next;
    for (std::size_t p = 0; p < active.size(); ++p) {
      double sum = 0;
      for (std::size_t q = 4 * p; q < 4 * p + 4; ++q) sum += quarters[q].value;
      const double error = std::abs(sum - active[p].value);
      if (error <= tolerance || depth == kMaxDepth) {
        result.value[active[p].cell] += sum;
        result.error += error;
      } else {
        next.insert(next.end(), quarters.begin() + 4 * p, quarters.begin() + 4 * p + 4);
      }
    }
    active = std::move(next);
  }
  return result;
}

}  // namespace microlane

#endif  // MICROLANE_TESTS_QUADRATURE_H_
