// Quadrature over microfacet normals: nodes and weights, made once and taken by any number of calls.
//
// Slopes (x, y) = (alpha_x r cos, alpha_y r sin) of the normals that both wi and wo see fill a wedge about 0.
// It is cut along three azimuths of the stretched plane: wi's horizon, wo's, and that of the wedge's corner,
// where the edges beyond the horizons meet. Between two of them, with m halfway and 2 b their angle, the
// azimuth goes along e of
//   q = (1 - x)^2 e_1 + 2 x (1 - x) m + x^2 e_2, |q| = (1 - x)^2 + 2 x (1 - x) cos(b) + x^2, e = q/|q|,
//   d(azimuth) = 2 sin(b) / |q| dx,
// and the radius up to the edge at 1/K, K = 0 where there is none: for GGX
//   r = p/(1 + K + K p), p = tan(pi t/2),
// for Beckmann r = t min(1/K, R), R^2 = 1 + 1.5 order, beyond which exp(-r^2) counts as 0. x and t take the
// Gauss-Legendre nodes of [0, 1]: 3 order^2 normals, every one of them seen from both sides. The integrand is
// smooth in both, so the error falls exponentially with the order.
//
// Normals that v sees: of GGX by the spherical caps of its sampler, c.z = (1 - u) - u s.z with u = sin^2(pi
// t/2) and azimuths phi = +-(j + 1/2) pi/order, 2 order^2 of them; of Beckmann order^2, of slopes t along v's
// azimuth from the edge of what v sees, or -S, to S, and y across it from -S to S, S^2 = 0.6 (order + 1).
#ifndef MICROLANE_QUADRATURE_H_
#define MICROLANE_QUADRATURE_H_

#include <cstddef>
#include <vector>

#include "microlane/prepared.h"

namespace microlane {

// Rows of a rule's table, of one number for each node; w is Gauss-Legendre's weight.
enum class QuadratureRow : std::size_t {
  kFirst,           // (1 - x)^2
  kMiddle,          // 2 x (1 - x)
  kLast,            // x^2
  kWeight,          // w
  kGgxRadius,       // p
  kGgxWeight,       // w p dp/dt
  kGgxFree,         // the same times the density 1/(1 + p^2)^2 of K = 0
  kBeckmannRadius,  // t R
  kBeckmannFree,    // w t R^2 exp(-(t R)^2), of K = 0
  kBeckmannPart,    // t
  kBeckmannRest,    // 1 - t
  kBeckmannWeight,  // w t
  // Of normals visible from v, below.
  kCapPart,               // u
  kCapRest,               // 1 - u
  kCapWeight,             // w sin(pi t), to a sum of 1/(2 order)
  kCosine,                // cos(phi)
  kSine,                  // sin(phi)
  kBeckmannAcross,        // y
  kBeckmannAcrossWeight,  // w exp(-y^2), to a sum of 1
  kNumRows
};

// The table of a rule in the numbers of a kernel's lanes.
template <class T>
struct QuadratureTable {
  std::size_t order;
  T beckmann_radius;   // R
  T beckmann_visible;  // S
  const T* rows;

  const T* operator[](QuadratureRow row) const { return rows + static_cast<std::size_t>(row) * order; }
};

class QuadratureRule : public Prepared {
 public:
  static constexpr std::size_t kMaxOrder = 32;

  // order: a whole number, 1 to 32.
  explicit QuadratureRule(double order);

  std::size_t order() const { return order_; }
  // Of T = float or double; lives as long as the rule.
  template <class T>
  QuadratureTable<T> Table() const;

 private:
  std::size_t order_ = 0;
  double beckmann_radius_ = 0, beckmann_visible_ = 0;
  std::vector<double> doubles_;
  std::vector<float> floats_;
};

template <>
inline QuadratureTable<double> QuadratureRule::Table<double>() const {
  return {order_, beckmann_radius_, beckmann_visible_, doubles_.data()};
}
template <>
inline QuadratureTable<float> QuadratureRule::Table<float>() const {
  return {order_, static_cast<float>(beckmann_radius_), static_cast<float>(beckmann_visible_),
          floats_.data()};
}

}  // namespace microlane

#endif  // MICROLANE_QUADRATURE_H_
