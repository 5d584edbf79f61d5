// The Gaussian of the angle (Meneveaux 2015 Eq. 13) in lanes.
#if defined(MICROLANE_GAUSSIAN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_GAUSSIAN_INL_H_
#undef MICROLANE_GAUSSIAN_INL_H_
#else
#define MICROLANE_GAUSSIAN_INL_H_
#endif

#include "microlane/distribution-inl.h"
#include "microlane/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct GaussianOfAngle {
  // sigma as it counts.
  template <class D>
  static HWY_INLINE Vec<D> Sigma(D d, Vec<D> sigma) {
    return Clamped(d, sigma, 1e-3, 2);
  }

  // exp(-theta^2/(2 v)) at the horizon, of the variance v = sigma^2.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> AtHorizon(D d, Vec<D> v) {
    return Exp<A>(d, RefinedDiv<A>(d, Const(d, -kPi * kPi / 8), v), hn::Zero(d));
  }

  // 1/(2 pi C v) = Int_0^(pi/2) exp(-t^2/(2 v)) sin t dt / v = P(v) - exp(-pi^2/(8 v)) Q(v): P is the
  // integral to infinity, sqrt(2/v) F(sqrt(v/2)) with Dawson's F, and the other term what lies behind the
  // horizon. Q falls from 2/pi at v = 0 to 0.14 at 4, P from 1 to 0.32, so that little cancels.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> IntegralOverVariance(D d, Vec<D> sigma, Vec<D> at_horizon) {
    const Vec<D> x = hn::MulSub(sigma, sigma, Const(d, 2));
    Vec<D> p, q;
    // Interpolation in Chebyshev's nodes of v in [0, 4], x = v - 2: of the difference to 2^-20.9 and 2^-53.
    if constexpr (A == Accuracy::kFast) {
      p = Polynomial(d, x,
                     {0.5380795, -0.153561011, 0.0287149101, -0.00395092461, 0.000429108681, -3.97863587e-05,
                      3.00129659e-06});
      q = Polynomial(d, x,
                     {0.28975898, -0.110339932, 0.0230123214, -0.00334905065, 0.000376288284, -3.57202007e-05,
                      2.73696241e-06});
    } else {
      p = Polynomial(
          d, x,
          {0.5380795069127684, -0.1535596301845763, 0.028714830501264148, -0.0039536819436893911,
           0.0004292691869962532, -3.8413955663480303e-05, 2.9213431929147654e-06, -1.9307829391652867e-07,
           1.1280868825284224e-08, -5.9050595785941411e-10, 2.799392813074812e-11, -1.2125892063701857e-12,
           4.8343887566869564e-14, -1.7857053186835663e-15, 6.2401265376475875e-17, -2.0052319016645024e-18});
      q = Polynomial(
          d, x,
          {0.28975898678429535, -0.11033865458953053, 0.023012246754295498, -0.003351594842223742,
           0.00037643774590477087, -3.4454018566146713e-05, 2.6625183921882757e-06, -1.7808859641032573e-07,
           1.0501794894482792e-08, -5.5378952743145394e-10, 2.6411357189326466e-11, -1.1497516347860363e-12,
           4.6031521944148053e-14, -1.7064054958251338e-15, 5.9820142174270337e-17, -1.927464623170716e-18});
    }
    return hn::NegMulAdd(at_horizon, q, p);
  }

  // C of sigma within its range.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> Normalisation(D d, Vec<D> sigma) {
    const Vec<D> v = hn::Mul(sigma, sigma);
    const Vec<D> integral = IntegralOverVariance<A>(d, sigma, AtHorizon<A>(d, v));
    return RefinedDiv<A>(d, Const(d, 0.5 / kPi), hn::Mul(v, integral));
  }

  // factor D(m), factor at most 2 mz where it is above 1.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> TimesNormalDensity(D d, Vec<D> factor, Vec<D> mx, Vec<D> my, Vec<D> mz,
                                              Vec<D> sigma) {
    sigma = Sigma(d, sigma);
    Vec<D> slope, turns;
    SlopeOfAngle(d, slope, turns, hn::Sqrt(hn::MulAdd(mx, mx, hn::Mul(my, my))), mz);
    // The exponent magnifies the angle's error: no approximation here.
    const Vec<D> theta = AngleOfSlope<Accuracy::kStandard>(d, slope, turns);
    const Vec<D> q = hn::Div(theta, sigma);
    // The cosine before the exponential, which may be subnormal where the quotient is not. What would take
    // the factor out of ExpTimes' range goes into the exponent.
    constexpr int kShift = kIsFloat<D> ? 64 : 512;
    constexpr double kScale = kIsFloat<D> ? 0x1p64 : 0x1p512, kLn2 = 0.69314718055994531;
    const auto low = hn::Lt(mz, Const(d, 1 / kScale));
    const Vec<D> z = hn::IfThenElse(low, hn::Mul(mz, Const(d, kScale)), mz);
    const Vec<D> rise = hn::IfThenElseZero(low, Const(d, kShift * kLn2));
    const Vec<D> exponent = hn::MulAdd(hn::Mul(q, q), Const(d, -0.5), rise);
    const Vec<D> c_over_cos = hn::Mul(Normalisation<A>(d, sigma), RefinedDiv<A>(d, factor, z));
    return ZeroIf(hn::Le(mz, hn::Zero(d)), ExpTimes<A>(d, exponent, hn::Zero(d), c_over_cos));
  }
};

struct GaussianNormalisationOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& c, Vec<D>& unused, Vec<D> sigma) {
    c = unused = GaussianOfAngle::Normalisation<A>(d, GaussianOfAngle::Sigma(d, sigma));
  }
};

struct GaussianDensityOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& density, Vec<D>& unused, Vec<D> mx, Vec<D> my, Vec<D> mz,
                             Vec<D> sigma) {
    density = unused = GaussianOfAngle::TimesNormalDensity<A>(d, Const(d, 1), mx, my, mz, sigma);
  }
};

// Density of the normals that V-cavities show (Heitz 2014 Eqs. 16, 49).
struct GaussianVCavityOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& density, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx,
                             Vec<D> my, Vec<D> mz, Vec<D> sigma) {
    Vec<D> dot, visibility, unused_too;
    InDouble2<InStandard<CarefulDotOp>>(d, dot, unused_too, vx, vy, vz, mx, my, mz);
    VCavityVisibilityOfDotOp::Run<A>(d, visibility, unused_too, dot, vz, mz);
    const Vec<D> factor = hn::Mul(visibility, Const(d, 0x1p-40 * kPi));
    const Vec<D> product = GaussianOfAngle::TimesNormalDensity<A>(d, factor, mx, my, mz, sigma);
    density = unused = ZeroIf(hn::Le(visibility, hn::Zero(d)), product);
  }
};

// f |cos(theta_o)| of ideal mirrors (Meneveaux 2015 Eqs. 13, 14): D(h) G/(4 |wi.z|) with h = H/|H|, H = wi +
// wo, of which no length is divided by: G = min(1, 2 H.z |wi.z|/(wi.H), 2 H.z |wo.z|/(wo.H)). wi.H cancels
// where wi and wo are nearly opposite, with bits to spare where products of floats are exact.
struct GaussianEvalVCavityOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& f_cos, Vec<D>& unused, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                             Vec<D> oy, Vec<D> oz, Vec<D> sigma) {
    const Vec<D> zero = hn::Zero(d), half = Const(d, 0.5);
    const Vec<D> hx = hn::Add(ix, ox), hy = hn::Add(iy, oy), sum_z = hn::Add(iz, oz), hz = hn::Abs(sum_z);
    const Vec<D> zi = hn::Abs(iz), zo = hn::Abs(oz);
    const Vec<D> ih = Dot(ix, iy, iz, hx, hy, sum_z), oh = Dot(ox, oy, oz, hx, hy, sum_z);
    const auto hidden = hn::Or(
        hn::Or(hn::Le(ih, zero), hn::Le(oh, zero)),
        hn::Or(hn::Or(hn::Eq(iz, zero), hn::Eq(oz, zero)), hn::Xor(hn::Lt(iz, zero), hn::Lt(oz, zero))));
    // G/(4 |wi.z|)
    const Vec<D> masked_o = hn::Div(hn::Mul(half, hn::Mul(hz, zo)), hn::Mul(oh, zi));
    const Vec<D> masked = hn::Min(hn::Div(hn::Mul(half, hz), ih), masked_o);
    const Vec<D> visible = hn::Min(hn::Div(Const(d, 0.25), zi), masked);
    const Vec<D> factor = hn::Mul(visible, hn::Sqrt(Dot(hx, hy, hz, hx, hy, hz)));
    f_cos = unused = ZeroIf(hidden, GaussianOfAngle::TimesNormalDensity<A>(d, factor, hx, hy, hz, sigma));
  }
};

// theta = sigma sqrt(-2 log(1 - u1 q)), q = 1 - exp(-pi^2/(8 sigma^2)), of azimuth 2 pi u2, and its density
// over solid angle theta/sin(theta) (1 - u1 q)/(2 pi sigma^2 q).
struct SampleGaussianOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1, Vec<D> u2,
                             Vec<D> sigma) {
    const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
    sigma = GaussianOfAngle::Sigma(d, sigma);
    const Vec<D> v = hn::Mul(sigma, sigma), at_horizon = GaussianOfAngle::AtHorizon<A>(d, v);
    const Vec<D> q = hn::Sub(one, at_horizon), u = hn::Mul(u1, q);
    const Vec<D> left = hn::MulAdd(u1, at_horizon, hn::Sub(one, u1));  // 1 - u
    // -log(1 - u) = 2 atanh(u/(2 - u)) by its series while that is below 3 - 2 sqrt 2.
    const Vec<D> near = TwoAtanh<A>(d, RefinedDiv<A>(d, u, hn::Add(one, left)));
    const Vec<D> log = hn::IfThenElse(hn::Lt(u, Const(d, 0.29)), near, hn::Neg(Log<A>(d, left)));
    const Vec<D> theta = hn::Mul(sigma, Sqrt<A>(d, hn::Add(log, log)));
    Vec<D> sin_m, cos_m, sin_phi, cos_phi;
    SinCos2Pi<A>(d, hn::Min(hn::Mul(theta, Const(d, 0.5 / kPi)), Const(d, 0.25)), sin_m, cos_m);
    SinCos2Pi<A>(d, u2, sin_phi, cos_phi);
    mx = hn::Mul(sin_m, cos_phi);
    my = hn::Mul(sin_m, sin_phi);
    mz = hn::Abs(cos_m);
    const auto upright = hn::Le(sin_m, zero);
    const Vec<D> angle = hn::IfThenElse(upright, one, theta), sine = hn::IfThenElse(upright, one, sin_m);
    const Vec<D> above = hn::Mul(hn::Mul(left, angle), Const(d, 0.5 / kPi));
    pdf = RefinedDiv<A>(d, above, hn::Mul(hn::Mul(v, q), sine));
  }
};

struct SampleGaussianInDoubleOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& mx, Vec<DD>& my, Vec<DD>& mz, Vec<DD>& pdf, Vec<DD>& unused0,
                             Vec<DD>& unused1, Vec<DD> u1, Vec<DD> u2, Vec<DD> sigma) {
    SampleGaussianOp::Run<Accuracy::kStandard>(dd, mx, my, mz, pdf, u1, u2, sigma);
    unused0 = unused1 = pdf;
  }
};

template <Accuracy A, class D>
HWY_INLINE void SampleGaussian(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1, Vec<D> u2,
                               Vec<D> sigma) {
  u1 = hn::Max(BelowOne(d, u1), hn::Zero(d));
  if constexpr (A == Accuracy::kFast) {
    SampleGaussianOp::Run<A>(d, mx, my, mz, pdf, u1, u2, sigma);
  } else {
    Vec<D> unused0, unused1;
    InDouble6<SampleGaussianInDoubleOp>(d, mx, my, mz, pdf, unused0, unused1, u1, u2, sigma);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_GAUSSIAN_INL_H_
