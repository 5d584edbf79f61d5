// Rotated and off-centre roughness: Heitz 2014 section 5.5, Eqs. 88-97.
#ifndef MICROLANE_SCALAR_SHEARED_H_
#define MICROLANE_SCALAR_SHEARED_H_

#include <cmath>
#include <cstddef>
#include <tuple>
#include <utility>

#include "microlane/scalar/direction.h"

namespace microlane::scalar {

// A distribution of unit roughness whose slopes are stretched by alpha_x and alpha_y, correlated by r_xy and
// moved by the mean slope. Normals go to those of unit roughness by a linear map, directions by its inverse
// transpose; sums that cancel are Wide. own: the parameters of the distribution's shape, or its table.
template <template <class> class Distribution, class Real, class... Own>
struct Sheared {
  std::tuple<Own...> own;
  Real alpha_x, alpha_y, r_xy, mean_x = 0, mean_y = 0;

  // The distribution of unit roughness.
  template <class T>
  Distribution<T> Unit() const {
    return Unit<T>(std::index_sequence_for<Own...>());
  }

  // The projected area of the mesosurface's normal, which stands for v.n.
  double Cosine(const Vec3<Real>& v) const {
    using Sum = DoubleDouble;
    return Narrow<double>(Sum(v.z) - (Sum(mean_x) * Sum(v.x) + Sum(mean_y) * Sum(v.y)));
  }

  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DTimes(m, 1)); }

  // factor D(m). Heitz 2014 Eqs. 92, 95 as a sum of squares: x, then y without what correlates with x.
  double DTimes(const Vec3<Real>& m, double factor) const {
    if (AnyNan(m, *this)) return kNan<double>;
    const W z = m.z;
    const W x = (W(m.x) + W(mean_x) * z) / W(alpha_x);
    const W y = ((W(m.y) + W(mean_y) * z) / W(alpha_y) - W(r_xy) * x) / Uncorrelated();
    return Unit<Real>().DOfGiven({x, y, z}, factor / Area());
  }

  // scale |v.n| Lambda(v), of the view of the surface of unit roughness.
  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    return Unit<double>().ScaledLambda(View(v), scale);
  }

  SampledNormal<double> SampleNormal(double u1, double u2) const {
    return FromUnit(Unit<double>().SampleNormal(u1, u2));
  }
  SampledNormal<double> SampleVisibleNormal(const Vec3<Real>& v, double u1, double u2, bool) const {
    return FromUnit(Unit<double>().SampleVisibleNormal(View(v), u1, u2));
  }

 private:
  using W = Wide<Real>;

  template <class T, std::size_t... kPlace>
  Distribution<T> Unit(std::index_sequence<kPlace...>) const {
    return {As<T>(std::get<kPlace>(own))..., 1, 1};
  }
  template <class T>
  static T As(Real parameter) {
    return static_cast<T>(parameter);
  }
  template <class T, class Entries>
  static const Entries* As(const Entries* entries) {
    return entries;
  }

  // sqrt(1 - r^2).
  W Uncorrelated() const { return Sqrt((W(1) - W(r_xy)) * (W(1) + W(r_xy))); }
  double Area() const { return alpha_x * (alpha_y * Narrow<double>(Uncorrelated())); }

  Vec3<double> View(const Vec3<Real>& v) const {
    const W y = W(alpha_y) * W(v.y);
    return {Narrow<double>(W(alpha_x) * W(v.x) + W(r_xy) * y), Narrow<double>(Uncorrelated() * y), Cosine(v)};
  }

  // Solid angles grow by |m|^3 / (alpha_x alpha_y sqrt(1 - r^2)) of the m that comes out, not normalised.
  SampledNormal<double> FromUnit(const SampledNormal<double>& unit) const {
    if (AnyNan(unit.m, unit.pdf, *this)) {
      return {{kNan<double>, kNan<double>, kNan<double>}, kNan<double>};
    }
    const double y = r_xy * unit.m.x + Narrow<double>(Uncorrelated()) * unit.m.y;
    const Vec3<double> m{alpha_x * unit.m.x - mean_x * unit.m.z, alpha_y * y - mean_y * unit.m.z, unit.m.z};
    const double length2 = Dot(m, m), length = std::sqrt(length2);
    if (!(length > 0)) return {{0, 0, 0}, 0};
    return {m / length, unit.pdf * length * (length2 / Area())};
  }
};

template <template <class> class Distribution, class Real, class... Own>
bool IsNan(const Sheared<Distribution, Real, Own...>& d) {
  return AnyNan(d.template Unit<Real>(), d.alpha_x, d.alpha_y, d.r_xy, d.mean_x, d.mean_y);
}

template <template <class> class Distribution, class Real, class... Own>
double Cosine(const Sheared<Distribution, Real, Own...>& distribution, const Vec3<Real>& v) {
  return distribution.Cosine(v);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_SHEARED_H_
