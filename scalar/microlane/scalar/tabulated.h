// Slopes by a table of kernels/microlane/radial_table.h: Heitz 2014 section 5.
#ifndef MICROLANE_SCALAR_TABULATED_H_
#define MICROLANE_SCALAR_TABULATED_H_

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "microlane/radial_entries.h"
#include "microlane/scalar/direction.h"
#include "microlane/scalar/math.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

// The cell of x >= 0, 2^bits to an octave of 1 + x, and how far along.
struct TablePlace {
  TablePlace(std::size_t cell_at, double part_of_it) : cell(cell_at), part(part_of_it) {}
  TablePlace(double x, std::size_t bits) {
    x = x >= 0 ? std::min(x, 0x1p300) : 0;  // NaN, which infinite inputs make, as 0
    const int octave = std::ilogb(1 + x);
    const double cells = std::ldexp(std::ldexp(1 + x, -octave) - 1, static_cast<int>(bits));
    part = cells - std::floor(cells);
    cell = (static_cast<std::size_t>(octave) << bits) + static_cast<std::size_t>(cells);
  }

  std::size_t cell;
  double part;
};

inline double Cubic(const double* c, double p) { return c[0] + p * (c[1] + p * (c[2] + p * c[3])); }

// g(x) of a curve, x >= 0.
inline double CurveAt(const RadialCurve& curve, double x) {
  if (!(1 + x < 1 + curve.end)) return curve.tail_value + curve.tail_slope * std::log(x / curve.end);
  const TablePlace place(x, RadialCurve::kCellBits);
  return Cubic(curve.cells + 4 * place.cell, place.part);
}

// g(x, y) of a surface: the cubic through the rows at 0, 1/4, 3/4 and 1 of a cell of x (Lagrange).
inline double SurfaceAt(const RadialSurface& surface, double x, double y) {
  TablePlace row(x, RadialSurface::kRowBits), column(y, RadialSurface::kCellBits);
  if (row.cell >= surface.row_cells) row = {surface.row_cells - 1, 1};
  if (column.cell >= surface.count) column = {surface.count - 1, 1};
  constexpr double kNodes[] = {0, 0.25, 0.75, 1};
  double sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    double weight = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i != k) weight *= (row.part - kNodes[i]) / (kNodes[k] - kNodes[i]);
    }
    const std::size_t cell = (3 * row.cell + k) * surface.count + column.cell;
    sum += weight * Cubic(surface.cells + 4 * cell, column.part);
  }
  return sum;
}

// Slopes of visible normals at unit roughness: t along the view's azimuth, reach = a + t, y across it.
struct VisibleSlopes {
  double t, reach, y;
};

// The slope t >= -a, at most 2^200, above which the share u of the visible normals is, whose density is that
// of max(0, a + t) P(t), P = W'' (Heitz 2014 Eq. 16): with Q = -W' and x = |t|,
//   u W(-a) = W(t) + (a + t) Q(t), W(-x) = x + W(x), Q(-x) = 1 - Q(x),
// from the nearer end. Newton's method on the logarithm of that share, kept within a bracket.
inline void SolveAlong(const RadialEntries& entries, double a, double u, double& t, double& reach) {
  const RadialCurve& curve = entries.masking;
  const double area = std::exp(CurveAt(curve, a)), whole = a + area;
  const bool up = u * whole <= entries.area[0] + a * entries.above[0];
  const double side = up ? 1 : -1, wanted = (up ? u : 1 - u) * whole, shift = up ? 0 : area;
  const auto node = [](std::size_t j) {
    const int octave = static_cast<int>(j >> RadialCurve::kCellBits);
    const double part = static_cast<double>(j & ((std::size_t{1} << RadialCurve::kCellBits) - 1));
    return std::ldexp(1 + std::ldexp(part, -static_cast<int>(RadialCurve::kCellBits)), octave) - 1;
  };
  std::size_t j = 0;
  for (std::size_t step = RadialEntries::kNodes / 2; step > 0; step /= 2) {
    const std::size_t k = j + step;
    if (k > curve.count || (!up && node(k) > a)) continue;
    if (side * entries.area[k] + (a + side * node(k)) * entries.above[k] >= wanted - shift) j = k;
  }
  // Beyond the last cell by the logarithm of x/end.
  const bool tail = j == curve.count;
  const double start = node(j), width = node(j + 1) - start, s = curve.tail_slope;
  double low = tail ? 0 : start, high = up ? (tail ? 1000 : start + width) : std::min(a, start + width);
  if (tail && !up) high = std::log(std::max(1.0, a / start));
  double at = (low + high) / 2, x = at;
  for (int i = 0; i < 200; ++i) {
    double w, q, p;
    if (tail) {
      x = start * std::exp(at);
      w = std::exp(curve.tail_value + s * at);
      q = -s * w / x;
      p = s * (s - 1) * w / x / x;
    } else {
      x = at;
      const double* const c = curve.cells + 4 * j;
      const double part = (x - start) / width;
      const double d = (c[1] + part * (2 * c[2] + part * 3 * c[3])) / width;
      w = std::exp(Cubic(c, part));
      q = -w * d;
      p = w * (d * d + (2 * c[2] + 6 * c[3] * part) / (width * width));
    }
    const double share = side * w + (a + side * x) * q + shift;
    (share > wanted ? low : high) = at;
    const double slope = -(a + side * x) * p * (tail ? x : 1);
    double next = at - share * std::log(share / wanted) / slope;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    const bool done = std::abs(next - at) <= 1e-16 * (1 + std::abs(at));
    at = next;
    if (done) break;
  }
  x = std::min(tail ? start * std::exp(std::min(at, 200.0)) : at, 0x1p200);
  t = side * x;
  reach = a + t;
}

inline VisibleSlopes SolveVisibleSlopes(const RadialEntries& entries, double a, double u1, double u2) {
  VisibleSlopes slopes;
  SolveAlong(entries, a, u1, slopes.t, slopes.reach);
  const double x = -std::log(2 * std::min(u2, 1 - u2));
  const double v = std::min(x * SurfaceAt(entries.across, std::abs(slopes.t), x), 60.0);
  slopes.y = std::copysign(std::hypot(1, slopes.t) * std::sinh(v), u2 - 0.5);
  return slopes;
}

template <class Real>
struct Tabulated {
  const RadialEntries* entries;
  Real alpha_x, alpha_y;

  // 0 for m.z <= 0.
  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DTimes(m, 1)); }

  // factor D(m), for a factor that may bring D back into range.
  double DTimes(const Vec3<Real>& m, double factor) const { return DOfGiven(Widen(m), factor); }

  // factor f(r) / (ax ay cos^4), r = tan stretched, in halves: neither f nor cos^4 is formed, as either may
  // leave the range while the product is inside it. f = exp(g) / (pi (1 + r^2)^2).
  double DOfGiven(const Vec3<Wide<Real>>& m, double factor) const {
    if (AnyNan(m, alpha_x, alpha_y)) return kNan<Real>;
    using W = Wide<Real>;
    if (!(m.z > W(0))) return 0;
    const W ax = alpha_x, ay = alpha_y;
    const double r2 = Narrow<double>((Square(m.x * ay) + Square(m.y * ax)) / Square(m.z * ax * ay));
    const double z = Narrow<double>(m.z),
                 half = 0.5 * std::max(CurveAt(entries->density, std::sqrt(r2)), -4000.0);
    const double root = std::exp(half) / ((1 + r2) * z) / z;
    return factor * (root / (kPi<double> * alpha_x * alpha_y)) * root;
  }

  // scale s exp(g) of a = |v.n|/s.
  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    using W = Wide<Real>;
    const double s = std::sqrt(Narrow<double>(Square(W(alpha_x) * W(v.x)) + Square(W(alpha_y) * W(v.y))));
    if (s == 0) return 0;
    return scale * s * std::exp(CurveAt(entries->masking, std::abs(v.z) / s));
  }

  // m along (alpha_x r cos, alpha_y r sin, 1), r by the inverse of its cumulative function. There D = f / (ax
  // ay m.z^4). u1 = 1, which is outside [0, 1), counts as the number below it.
  SampledNormal<double> SampleNormal(double u1, double u2) const {
    const double y = -std::log1p(-std::min(u1, 1 - 0x1p-53));
    const double log = y * CurveAt(entries->quantile, std::sqrt(y)), r = std::sqrt(std::expm1(log));
    const SinCos<double> phi = SinCos2Pi(u2);
    const double mx = alpha_x * r * phi.cos, my = alpha_y * r * phi.sin;
    const double length2 = mx * mx + my * my + 1, length = std::sqrt(length2);
    const double pi_f = std::exp(CurveAt(entries->density, r) - 2 * log);
    return {{mx / length, my / length, 1 / length},
            pi_f * length * length2 / (kPi<double> * alpha_x * alpha_y)};
  }

  // Slopes t along the azimuth of the stretched view, whose share above t is u1, and y across it, the share
  // u2 of those of t below, stretched. The density is Heitz 2014 Eq. 16, (a + t) f(r) / (W(-a) alpha_x
  // alpha_y m.z^3). Below the surface -v is seen.
  SampledNormal<double> SampleVisibleNormal(const Vec3<Real>& v, double u1, double u2, bool = false) const {
    if (AnyNan(v, u1, u2, alpha_x, alpha_y)) {
      return {{kNan<double>, kNan<double>, kNan<double>}, kNan<double>};
    }
    const double side = Side(v), qx = side * alpha_x * v.x, qy = side * alpha_y * v.y;
    const double q = std::hypot(qx, qy), z = std::abs(v.z);
    if (q == 0 && z == 0) return {{0, 0, 0}, 0};
    const double cos = q == 0 ? 1 : qx / q, sin = q == 0 ? 0 : qy / q;
    const double a = q * 0x1p300 < z ? 0x1p300 : z / q;
    const auto [t, reach, y] = SolveVisibleSlopes(*entries, a, InsideUnit(u1), InsideUnit(u2));
    const Vec3<double> m{alpha_x * (cos * t - sin * y), alpha_y * (sin * t + cos * y), 1};
    const double length2 = Dot(m, m), length = std::sqrt(length2), r2 = t * t + y * y;
    const double pi_f = std::exp(CurveAt(entries->density, std::sqrt(r2))) / (1 + r2) / (1 + r2);
    const double whole = a + std::exp(CurveAt(entries->masking, a));
    // A float above 0, of the longest slopes too.
    return {{m.x / length, m.y / length, std::max(1 / length, 0x1p-126)},
            reach / whole * pi_f * length / (kPi<double> * alpha_x * alpha_y) * length2};
  }
};

template <class Real>
bool IsNan(const Tabulated<Real>& d) {
  return AnyNan(d.alpha_x, d.alpha_y);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_TABULATED_H_
