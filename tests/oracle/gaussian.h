// The Gaussian of the angle: Meneveaux 2015, Eq. 13.
#ifndef MICROLANE_TESTS_ORACLE_GAUSSIAN_H_
#define MICROLANE_TESTS_ORACLE_GAUSSIAN_H_

#include "oracle/math.h"
#include "oracle/real.h"

namespace microlane::oracle {

struct Gaussian {
  Real sigma;

  // 1/C over 2 pi: Int_0^(pi/2) exp(-t^2/(2 sigma^2)) sin t dt, the sine by its series: with J_k = Int t^(2k
  // + 1) exp(-t^2/(2 sigma^2)) dt, J_0 = sigma^2 (1 - E), J_k = 2 k sigma^2 J_(k-1) - sigma^2 (pi/2)^(2k) E,
  // E = exp(-pi^2/(8 sigma^2)), it is the sum of (-1)^k J_k/(2k + 1)!. What J_k loses to cancellation at
  // large k the factorial takes away: 10 bits at most up to sigma = 2.
  Real Integral() const {
    const Real variance = Square(sigma), horizon2 = Square(Pi() / 2), end = AtHorizon();
    Real moment = variance * (1 - end), power = variance * end, over_factorial = 1, sum = moment;
    for (int k = 1; k <= 90; ++k) {
      power *= horizon2;
      moment = 2 * k * variance * moment - power;
      over_factorial /= -2 * k * (2 * k + 1);
      sum += over_factorial * moment;
    }
    return sum;
  }
  Real C() const { return 1 / (2 * Pi() * Integral()); }

  // Eq. 13.
  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    const Real theta = atan2(Real(sqrt(Square(m.x) + Square(m.y))), m.z);
    return C() * exp(-Square(theta) / (2 * Square(sigma))) / m.z;
  }

  // Rayleigh's distribution of the angle, cut off at the horizon.
  Real SampleTheta(const Real& u1) const { return sigma * sqrt(2 * NegLog1m(u1 * (1 - AtHorizon()))); }

  static Vec Normal(const Real& theta, const Real& u2) {
    const SinCos phi = SinCos2Pi(u2);
    const Real sine = sin(theta);
    return {sine * phi.cos, sine * phi.sin, cos(theta)};
  }

  // The density over solid angle of normals with that distribution of the angle, of any azimuth.
  Real PdfOfTheta(const Real& theta) const {
    const Real variance = Square(sigma), ratio = theta == 0 ? Real(1) : Real(theta / sin(theta));
    return ratio * exp(-Square(theta) / (2 * variance)) / (2 * Pi() * variance * (1 - AtHorizon()));
  }

 private:
  Real AtHorizon() const { return exp(-Square(Pi()) / (8 * Square(sigma))); }
};

// sigma from 1e-3 to 2; beyond, the nearer.
inline Gaussian MakeGaussian(const Real& sigma) {
  const Real low = Real(1) / 1000;
  return {sigma < low ? low : sigma > 2 ? Real(2) : sigma};
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_GAUSSIAN_H_
