// Masking functions of Heitz 2014, section 4, and joint masking-shadowing, section 6, as printed.
#ifndef MICROLANE_TESTS_ORACLE_MASKING_H_
#define MICROLANE_TESTS_ORACLE_MASKING_H_

#include "oracle/real.h"

namespace microlane::oracle {

// v.m as seen from v's side of the surface; 0 or less where m is not seen.
inline Real FacingDot(const Vec& v, const Vec& m) { return v.z == 0 ? Real(0) : Sign(v.z) * Dot(v, m); }

// Heitz 2014, Eq. 49.
inline Real VCavityG1(const Vec& v, const Vec& m) {
  const Real facing = FacingDot(v, m);
  if (facing <= 0 || m.z <= 0) return 0;
  const Real ratio = 2 * m.z * abs(v.z) / facing;
  return ratio < 1 ? ratio : Real(1);
}

// Heitz 2014, Eq. 16 with Eq. 49; at v.n = 0 the limit from above.
template <class Distribution>
Real VCavityDensity(const Distribution& distribution, const Vec& v, const Vec& m) {
  const Real facing = v.z < 0 ? Real(-Dot(v, m)) : Dot(v, m);
  if (facing <= 0 || m.z <= 0) return 0;
  if (v.z == 0) return 2 * m.z * distribution.D(m);
  return VCavityG1(v, m) * facing * distribution.D(m) / abs(v.z);
}

// One of the two facets of a V-cavity by its share of what v sees (Heitz and d'Eon 2014), n and (-n.x, -n.y,
// n.z): the other where u3 is below its share. `margin` is how far the decision is from turning out
// otherwise, as a relative change of the dot products; otherwise: takes the facet that was not decided for.
struct VCavityFacet {
  Vec m;
  Real share;  // of what v sees of both
  Real kappa;  // of the share: its relative change over that of the dot products' terms
  double margin;
};
inline VCavityFacet ChooseFacet(const Vec& v, const Vec& n, const Real& u3, bool otherwise) {
  const Vec mirrored{-n.x, -n.y, n.z}, up = v.z < 0 ? -v : v;
  const Real of_n = Dot(up, n), of_mirrored = Dot(up, mirrored);
  const Real seen_n = of_n > 0 ? of_n : Real(0), seen_mirrored = of_mirrored > 0 ? of_mirrored : Real(0);
  const Real sum = seen_n + seen_mirrored;
  const Real sizes = abs(up.x * n.x) + abs(up.y * n.y) + abs(up.z * n.z);
  const bool other = (u3 * sum < seen_mirrored) != otherwise;
  const Real seen = other ? seen_mirrored : seen_n;
  const Real nearest = abs(Real(2 * u3 * up.z * n.z - of_mirrored));
  return {other ? mirrored : n, sum == 0 ? Real(1) : Real(seen / sum),
          seen == 0 || seen == sum ? Real(1) : Real(1 + sizes / seen),
          sizes == 0 ? 0 : static_cast<double>(Real(nearest / sizes))};
}

// Heitz 2014, Eq. 56.
inline Real ImplicitG1(const Vec& v, const Vec& m) { return FacingDot(v, m) > 0 ? abs(v.z) : Real(0); }

// Heitz 2014, section 4.3.
inline Real SchlickSmithG1(const Vec& v, const Vec& m, const Real& alpha) {
  if (FacingDot(v, m) <= 0) return 0;
  const Real k = alpha * sqrt(2 / Pi()), c = abs(v.z);
  return c / (c * (1 - k) + k);
}

// Heitz 2014, Eq. 59.
inline Real KelemenG1(const Vec& v, const Vec& m) {
  const Real facing = FacingDot(v, m);
  return facing > 0 ? abs(v.z) / facing : Real(0);
}

// The angle in [0, pi] between the azimuths of two directions; 0 where one has none.
inline Real AzimuthDifference(const Real& ax, const Real& ay, const Real& bx, const Real& by) {
  const Real sine = abs(ax * by - ay * bx), cosine = ax * bx + ay * by;
  if (sine == 0 && cosine == 0) return 0;
  return atan2(sine, cosine);
}

// lambda of van Ginneken 1998, after Heitz 2014, Eq. 101.
inline Real DirectionalCorrelation(const Real& phi) {
  const Real factor = Real(441) / 100;
  return factor * phi / (factor * phi + 1);
}

// Heitz 2014, Eq. 98.
inline Real SeparableG2(const Real& lambda_i, const Real& lambda_o) {
  return 1 / (1 + lambda_o) * (1 / (1 + lambda_i));
}

// Heitz 2014, Eq. 99.
inline Real HeightCorrelatedG2(const Real& lambda_i, const Real& lambda_o) {
  return 1 / (1 + lambda_o + lambda_i);
}

inline Real LogGamma(const Real& x) {
  Real result;
  int sign;
  mpfr_lgamma(result.backend().data(), &sign, x.backend().data(), MPFR_RNDN);
  return result;
}

// B(1 + Lambda_i, 1 + Lambda_o). Of the largest floats log Gamma leaves 300 bits.
inline Real HeightCorrelatedTransmissionG2(const Real& lambda_i, const Real& lambda_o) {
  return exp(LogGamma(1 + lambda_i) + LogGamma(1 + lambda_o) - LogGamma(2 + lambda_i + lambda_o));
}

// Heitz 2014, Eq. 100.
inline Real DirectionCorrelatedG2(const Real& lambda_i, const Real& lambda_o, const Real& phi) {
  const Real lambda = DirectionalCorrelation(phi), g_i = 1 / (1 + lambda_i), g_o = 1 / (1 + lambda_o);
  return lambda * g_o * g_i + (1 - lambda) * (g_i < g_o ? g_i : g_o);
}

// Heitz 2014, Eq. 101.
inline Real HeightDirectionCorrelatedG2(const Real& lambda_i, const Real& lambda_o, const Real& phi) {
  const bool less = lambda_i < lambda_o;
  return 1 / (1 + (less ? lambda_o : lambda_i) + DirectionalCorrelation(phi) * (less ? lambda_i : lambda_o));
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_MASKING_H_
