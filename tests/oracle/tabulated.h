// Slopes by a table of kernels/microlane/radial_table.h, whose entries are data: cubics between them.
#ifndef MICROLANE_TESTS_ORACLE_TABULATED_H_
#define MICROLANE_TESTS_ORACLE_TABULATED_H_

#include <cstddef>
#include <memory>

#include "microlane/radial_entries.h"
#include "oracle/math.h"
#include "oracle/stretch.h"

namespace microlane::oracle {

// The entries that kernel `kernel` of the list looks up, of the values of the inputs behind its second bar;
// null where they make none. They are part of the question, so whoever asks gives them: tests/tables.cc.
std::shared_ptr<const RadialEntries> GivenRadialEntries(std::size_t kernel, const double* values);

// Where cell j begins, 2^bits to an octave of 1 + x.
inline Real CellBegin(std::size_t j, std::size_t bits = RadialCurve::kCellBits) {
  const std::size_t cells = std::size_t{1} << bits;
  return ldexp(Real(cells + j % cells), static_cast<int>(j / cells) - static_cast<int>(bits)) - 1;
}

// The cell of x >= 0 among `count` and how far along; the end of the last for what is beyond.
struct TablePlace {
  std::size_t cell;
  Real part;
};
inline TablePlace FindPlace(const Real& x, std::size_t count, std::size_t bits) {
  if (x >= CellBegin(count, bits)) return {count - 1, 1};
  std::size_t low = 0, high = count;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (CellBegin(middle, bits) <= x ? low : high) = middle;
  }
  const Real begin = CellBegin(low, bits);
  return {low, (x - begin) / (CellBegin(low + 1, bits) - begin)};
}

inline Real Cubic(const double* c, const Real& p) { return c[0] + p * (c[1] + p * (c[2] + p * c[3])); }

// A curve at x >= 0.
inline Real Curve(const RadialCurve& curve, const Real& x) {
  if (x >= curve.end) return curve.tail_value + curve.tail_slope * log(x / curve.end);
  const TablePlace place = FindPlace(x, curve.count, RadialCurve::kCellBits);
  return Cubic(curve.cells + 4 * place.cell, place.part);
}

// A surface: the cubic of Lagrange through rows at 0, 1/4, 3/4 and 1.
inline Real Surface(const RadialSurface& surface, const Real& x, const Real& y) {
  const TablePlace row = FindPlace(x, surface.row_cells, RadialSurface::kRowBits),
                   column = FindPlace(y, surface.count, RadialSurface::kCellBits);
  static const Real kNodes[] = {0, Real(1) / 4, Real(3) / 4, 1};
  Real sum = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    Real weight = 1;
    for (std::size_t i = 0; i < 4; ++i) {
      if (i != k) weight *= (row.part - kNodes[i]) / (kNodes[k] - kNodes[i]);
    }
    const std::size_t cell = (3 * row.cell + k) * surface.count + column.cell;
    sum += weight * Cubic(surface.cells + 4 * cell, column.part);
  }
  return sum;
}

// W, Q = -W' and P = W'' of the masking curve within cell j, or beyond the last, of W = a Lambda(a).
struct AxisShares {
  Real area, above, density;
};
inline AxisShares SharesAt(const RadialCurve& curve, std::size_t j, const Real& x) {
  if (j == curve.count) {
    const Real s = curve.tail_slope, w = exp(curve.tail_value + s * log(x / curve.end));
    return {w, -s * w / x, s * (s - 1) * w / (x * x)};
  }
  const double* const c = curve.cells + 4 * j;
  const Real begin = CellBegin(j), width = CellBegin(j + 1) - begin, p = (x - begin) / width;
  const Real w = exp(Cubic(c, p)), d = (c[1] + p * (2 * Real(c[2]) + p * 3 * Real(c[3]))) / width;
  const Real d2 = (2 * Real(c[2]) + 6 * Real(c[3]) * p) / (width * width);
  return {w, -w * d, w * (d * d + d2)};
}

// The slope t >= -a above which u of the visible normals of unit roughness are, and reach = a + t: with x =
// |t| and side its sign, side W(x) + (a + side x) Q(x) is u W(-a), or (1 - u) W(-a) - W(a) where t < 0, W(-a)
// = a + W(a). Newton's method in the cell that the table's values at its ends bracket x by.
inline void VisibleSlope(const RadialEntries& entries, const Real& a, const Real& u, Real& t, Real& reach) {
  const RadialCurve& curve = entries.masking;
  const Real area = exp(Curve(curve, a)), whole = a + area;
  const bool up = u * whole <= entries.area[0] + a * entries.above[0];
  const Real side = up ? 1 : -1, shift = up ? Real(0) : area, wanted = (up ? u : Real(1 - u)) * whole;
  std::size_t j = 0;
  for (std::size_t step = RadialEntries::kNodes / 2; step > 0; step /= 2) {
    const std::size_t k = j + step;
    if (k > curve.count || (!up && CellBegin(k) > a)) continue;
    if (side * entries.area[k] + (a + side * CellBegin(k)) * entries.above[k] >= wanted - shift) j = k;
  }
  Real low = CellBegin(j), high = j < curve.count ? CellBegin(j + 1) : ldexp(Real(1), 400);
  if (!up && a < high) high = a;
  // In the tail the middle is that of logarithms.
  const auto middle = [&] { return j < curve.count ? Real((low + high) / 2) : Real(sqrt(low * high)); };
  Real x = middle();
  for (int i = 0; i < 2000; ++i) {
    const AxisShares at = SharesAt(curve, j, x);
    const Real share = side * at.area + (a + side * x) * at.above + shift;
    (share > wanted ? low : high) = x;
    const Real slope = (a + side * x) * at.density;
    Real next = share > 0 && slope > 0 ? Real(x + share * log(share / wanted) / slope) : middle();
    if (!(next >= low && next <= high)) next = middle();
    const Real step = abs(next - x);
    x = next;
    if (step <= ldexp(Real(a + side * x), -90) && step <= ldexp(x, -90)) break;
  }
  const Real most = ldexp(Real(1), 200);
  if (x > most) x = most;
  t = side * x;
  reach = a + t;
}

struct Tabulated {
  const RadialEntries* entries;
  Roughness alpha;

  Real Alphas() const { return alpha.alpha_x + alpha.alpha_y; }

  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    const Real tan2 = StretchedTan2(m, alpha);
    const Real pi_f = exp(Curve(entries->density, sqrt(tan2))) / Square(1 + tan2);
    return pi_f / (Pi() * alpha.Area() * Square(Square(m.z)));
  }

  // Infinite at v.n = 0.
  Real Lambda(const Vec& v) const {
    const Real s = sqrt(ProjectedRoughness2(v, alpha)), z = abs(alpha.Cosine(v));
    if (s == 0) return 0;
    if (z == 0) return Infinity();
    return s / z * exp(Curve(entries->masking, z / s));
  }

  Real G1(const Vec& v, const Vec& m) const { return SameSide(v, m, alpha) ? 1 / (1 + Lambda(v)) : Real(0); }

  Real DVisible(const Vec& v, const Vec& m) const { return VisibleDensity(*this, v, m); }

  // (1 + Lambda) |v.n| at v.n = 0.
  Real GrazingArea(const Vec& v) const {
    return sqrt(ProjectedRoughness2(v, alpha)) * exp(Curve(entries->masking, 0));
  }

  Vec SampleNormal(const Real& u1, const Real& u2) const {
    const Real y = -log(1 - u1), r2 = exp(y * Curve(entries->quantile, sqrt(y))) - 1;
    return StretchedNormal(sqrt(r2), u2, alpha);
  }
};

// A visible normal: slopes t along the azimuth of the stretched view and y across it at unit roughness.
struct TabulatedNormal {
  Vec m, h;        // h: at unit roughness, not normalised
  Vec sizes;       // of the parts of h
  Real end_share;  // (1 + |t|) / (a + t)
};

inline TabulatedNormal VisibleNormal(const Tabulated& tabulated, const Vec& v, const Real& u1,
                                     const Real& u2) {
  const Roughness& alpha = tabulated.alpha;
  const Vec view = UnitView(alpha.Cosine(v) < 0 ? -v : v, alpha);
  if (IsZero(view)) return {view, {0, 0, 1}, {0, 0, 1}, 0};
  const Real r = sqrt(view.x * view.x + view.y * view.y), most = ldexp(Real(1), 300);
  const Real cos = r == 0 ? Real(1) : Real(view.x / r), sin = r == 0 ? Real(0) : Real(view.y / r);
  const Real a = r * most < view.z ? most : Real(view.z / r);
  Real t, reach;
  VisibleSlope(*tabulated.entries, a, FromTiny(u1), t, reach);
  const Real u = FromTiny(u2), x = -log(u < 0.5 ? Real(2 * u) : Real(2 * (1 - u)));
  Real e = exp(x * Surface(tabulated.entries->across, abs(t), x));
  static const Real kMost = exp(Real(60));
  if (e > kMost) e = kMost;
  const Real y = (u < 0.5 ? -1 : 1) * sqrt(1 + t * t) * (e - 1 / e) / 2, size = 1 + abs(t);
  const Vec h{cos * t - sin * y, sin * t + cos * y, 1};
  return {FromUnit(h, alpha),
          h,
          {abs(cos) * size + abs(sin * y), abs(sin) * size + abs(cos * y), 1},
          size / reach};
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_TABULATED_H_
