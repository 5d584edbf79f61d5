// The kernel list: every kernel's id, inputs, outputs, source and declared error bounds.
// Tests, benchmarks, documentation and the `microlane` command are driven from it.
#ifndef MICROLANE_KERNEL_LIST_H_
#define MICROLANE_KERNEL_LIST_H_

#include <array>
#include <cstddef>
#include <iterator>
#include <string_view>

namespace microlane {

// Largest error found by exhaustive or adversarial search, in real-valued units in the last place of
// the result type, over the inputs' domains. B ULP of float are a relative error of B * 2^-23 at most and of
// half that at least. `fast` is what was found with every approximation at its worst, off by 2^-14 (AVX-512's
// limit); the relative error stays below 2^-11, which is 4096 to 8192 ULP.
struct Bounds {
  float high;            // computed in double lanes, rounded once to float
  float standard;        // float lanes, targets with a native FMA
  float fast;            // float lanes, approximate reciprocals and roots
  float standard_nofma;  // float lanes, targets without FMA (SSSE3, SSE4, SCALAR)
  double double_lanes;   // double lanes on every target, in ULP of double, for inputs that are floats
};

// How an output's error is scaled.
enum class Metric {
  kUlp,  // |got - exact| / ulp(exact)
  // Component of a unit vector: |got - exact| / ulp(kappa). kappa is 1; of sampled refraction 1 + wi.m / |g|,
  // about visible normals times theirs; of sampled visible normals, and of wo reflected about them, |(alpha_x
  // (|c.x| + |s.x|), alpha_y (|c.y| + |s.y|), c.z + s.z)| over the same of c + s, where c is the point of the
  // cap and s the stretched view; of Beckmann's and tables' |(alpha_x (|e.x| T + |e.y y|), alpha_y (|e.y| T + |e.x y|),
  // 1)| over the same of (e.x t - e.y y, e.y t + e.x y), where t and y are the slopes at unit roughness, e
  // the stretched view's azimuth, and T = |t| + N/(2 (a + t) exp(-t^2)). With A and B the parts of M (its
  // note) above and below t, A/(2 (a + t) exp(-t^2)) is u1 |dt/du1|, what a rounding of u1 moves t by: N = A.
  // Where it is less, N = B + exp(-t^2): B/(2 (a + t) exp(-t^2)) is what a rounding of 1 - u1 moves t by, and
  // 1/(2 (a + t)) at least what one of a does, a |dt/da| = (1 - u1 exp(t^2 - a^2))/(2 (a + t)). Of tables T = 1
  // + |t|.
  kDirection,
  // |got - exact| / (ulp(exact) * kappa), where kappa >= 1 is the amplification of an input rounding by
  // the geometry: kappa = (1 + 1/|wi.m|) (1 + (wi.m)^2/|g^2|) (1 + 1/|wo.z| + w), g of Walter 2007 Eq. 22,
  // where w is 0 of a density, and of a weight (alpha_x + alpha_y)/(|wo.z| (1 + 2 Lambda(wo))), 0 for Phong.
  // Of opaque surfaces the second factor is 1 of a density and of a mirror's weight, has the complex g of a
  // conductor, and is 1 + |dF/dc|/F of Schlick's.
  // Of the density of a sampled visible normal: kDirection's kappa, or the same with alphas of 1 if that is
  // more, of Beckmann's and tables' plus T/(a + t); so too of the density of wo reflected about it. Of the weight of
  // that, with r = |(alpha_x wo.x, alpha_y wo.y, wo.z)|: 1 + kDirection's kappa times Lambda_o/(1 + Lambda_i
  // + Lambda_o) (1/|wo.z| + 1/r) + (alpha_x + alpha_y)/(2 |wo.z| (1 + Lambda_i + Lambda_o)), of Beckmann,
  // with s = |(alpha_x wo.x, alpha_y wo.y)|, times exp(-(wo.z/s)^2)/(2 sqrt(pi)) (s/wo.z^2 + (alpha_x +
  // alpha_y)/|wo.z|)/(1 + Lambda_i + Lambda_o), at least the sum of |d ln(weight)/d wo.x|, ... d wo.y, ... d
  // wo.z; of separable masking Lambda_o/(1 + Lambda_o) and 1/(1 + Lambda_o) in these; of facets that do not
  // reflect all, plus kDirection's kappa times |dF/d(wi.m)|/F. Judged where the error that kDirection allows
  // is small beside wo.z, r/(alpha_x + alpha_y), and Schlick's F/|dF/d(wi.m)| or a conductor's |g^2|/|wi.m|;
  // other weights of opaque surfaces beside the latter two.
  // Of an interface over a body (1 + 1/|wi.h|) (1 + 1/|wo.z|) times kDirection's kappa of the lobe; of the weight, plus
  // that of the body's normal m times 1/(wi.m) + 1/(wo.m).
  // Of a mean of F over normals: 1 + the mean of (|F(c + e) - F(c)| + |F(c - e) - F(c)|)/F over 2^-21, for e
  // = 2^-21 c times kDirection's kappa of the normal, of GGX at least that with alphas of 1; c - e at least
  // 0. Of a dielectric about visible normals the first kappa, times that of the normal: of a density that of
  // its density, of a weight kDirection's.
  kConditioned,
  kExact,  // an integer label; must agree
};

struct Output {
  std::string_view name;
  Metric metric;
  std::string_view unit;
};

struct Input {
  std::string_view name;
  double low, high;  // domain of the declared bounds
  std::string_view meaning;
};

struct Kernel {
  std::string_view id;
  // Names in order; those behind '|' may be one value for the whole batch, and those behind a second '|'
  // belong to an object that the call takes whole (Call::prepared).
  std::string_view inputs;
  std::string_view outputs;  // names in order
  std::string_view source;   // paper and equation
  std::string_view note;     // definition where the source leaves a choice, and special values
  bool has_transport;        // takes radiance or importance transport
  Bounds bounds;
};

// clang-format off

inline constexpr Input kInputs[] = {
    {"mx", -1, 1, "microfacet normal, x"},
    {"my", -1, 1, "microfacet normal, y"},
    {"mz", -1, 1, "microfacet normal, z = cos(theta_m)"},
    {"vx", -1, 1, "direction, x"},
    {"vy", -1, 1, "direction, y"},
    {"vz", -1, 1, "direction, z = cos(theta_v)"},
    {"wix", -1, 1, "direction light comes from, x"},
    {"wiy", -1, 1, "direction light comes from, y"},
    {"wiz", -1, 1, "direction light comes from, z"},
    {"wox", -1, 1, "direction light leaves to, x"},
    {"woy", -1, 1, "direction light leaves to, y"},
    {"woz", -1, 1, "direction light leaves to, z"},
    {"cos_i", -1, 1, "cosine on the incident side"},
    {"cos_o", -1, 1, "cosine on the scattered side"},
    {"alpha", 1e-5, 1e2, "roughness"},
    {"alpha_x", 1e-5, 1e2, "roughness along x"},
    {"alpha_y", 1e-5, 1e2, "roughness along y"},
    {"r_xy", -0.9999, 0.9999, "correlation of the slopes along x and y"},
    {"mean_x", -16, 16, "mean slope along x"},
    {"mean_y", -16, 16, "mean slope along y"},
    {"moment_xx", 0, 6e3, "E[x^2] of slopes"},
    {"moment_yy", 0, 6e3, "E[y^2] of slopes"},
    {"moment_xy", -6e3, 6e3, "E[x y] of slopes"},
    {"exponent", 0, 2e10, "Phong exponent alpha_p"},
    {"eta", 0.25, 4, "index of the transmitted over the incident side"},
    {"n", 0.05, 10, "real part of the index of a conductor over that of the incident side"},
    {"kappa", 0, 20, "imaginary part of that index"},
    {"f0", 0, 1, "reflectance at normal incidence"},
    {"Lambda_i", 0, 0x1.fffffep+127, "Smith's Lambda of wi"},
    {"Lambda_o", 0, 0x1.fffffep+127, "Smith's Lambda of wo"},
    {"u1", 0, 1, "uniform random number in [0, 1)"},
    {"u2", 0, 1, "uniform random number in [0, 1)"},
    {"u3", 0, 1, "uniform random number in [0, 1)"},
    {"u4", 0, 1, "uniform random number in [0, 1)"},
    {"u5", 0, 1, "uniform random number in [0, 1)"},
    {"x", -104, 88, "argument"},
    {"a", 0, 32, "1 / (alpha tan(theta)), Heitz 2014"},
    {"mu", 0, 0x1p60, "1 / (alpha tan(theta) sqrt(gamma - 1))"},
    {"gamma", 1.55, 1e10, "Student-T's exponent: 2 is GGX, infinity Beckmann"},
    {"order", 1, 32, "order of a quadrature, a whole number"},
    {"k", 0, 1, "albedo of the matte part, one channel of its colour"},
    {"m", 1e-4, 10, "root mean square slope of Kelemen 2001, alpha of Beckmann"},
    {"index", 1, 4, "index of a dielectric over that of the outside"},
    {"n_i", 1, 4, "index of a body under its interface over that of the outside"},
    {"sigma", 1e-3, 2, "roughness of the Gaussian of the angle, in radians"},
    {"tail", 1.55, 1e10, "gamma of the Student-T slopes that a table is made of: any radial function makes one, this one does for tools"},
};

inline constexpr Output kOutputs[] = {
    {"C", Metric::kUlp, "1/sr"},
    {"D", Metric::kUlp, "1/sr"},
    {"Lambda", Metric::kUlp, "1"},
    {"G1", Metric::kUlp, "1"},
    {"G2", Metric::kUlp, "1"},
    {"phi", Metric::kUlp, "rad"},
    {"F", Metric::kUlp, "1"},
    {"T", Metric::kUlp, "1"},
    {"hx", Metric::kUlp, "1"},
    {"hy", Metric::kUlp, "1"},
    {"hz", Metric::kUlp, "1"},
    {"jacobian", Metric::kUlp, "1"},
    {"mx", Metric::kDirection, "1"},
    {"my", Metric::kDirection, "1"},
    {"mz", Metric::kDirection, "1"},
    {"wox", Metric::kDirection, "1"},
    {"woy", Metric::kDirection, "1"},
    {"woz", Metric::kDirection, "1"},
    {"exponent", Metric::kUlp, "1"},
    {"f", Metric::kUlp, "1/sr"},
    {"f_cos", Metric::kUlp, "1/sr"},
    {"pdf", Metric::kUlp, "1/sr"},
    {"weight", Metric::kConditioned, "1"},
    {"lobe", Metric::kExact, "0 none, 1 reflection, 2 transmission or matte"},
    {"alpha_x", Metric::kUlp, "1"},
    {"alpha_y", Metric::kUlp, "1"},
    {"r_xy", Metric::kUlp, "1"},
    {"moment_xx", Metric::kUlp, "1"},
    {"moment_yy", Metric::kUlp, "1"},
    {"moment_xy", Metric::kUlp, "1"},
    {"sin", Metric::kUlp, "1"},
    {"cos", Metric::kUlp, "1"},
    {"y", Metric::kUlp, "1"},
    {"density", Metric::kUlp, "1/sr"},
    {"albedo", Metric::kUlp, "1"},
    {"deficit", Metric::kUlp, "1"},
};

inline constexpr std::string_view kFresnelNote =
    "|cos_i| is used; 1 under total internal reflection; 0 at eta = 1.";
inline constexpr std::string_view kMaskingSides =
    "v of either side, -v in place of v below; 0 where v.m and vz differ in sign or either is 0.";
inline constexpr std::string_view kJointNote =
    "Lambda from 0 to the largest float; sidedness is left to the caller.";
inline constexpr std::string_view kDirectionNote =
    "lambda = 4.41 phi/(4.41 phi + 1) (van Ginneken 1998), phi as math.azimuth_difference: within [0, pi], and 0 where an "
    "azimuth is undefined. Lambda from 0 to the largest float; sidedness is left to the caller.";
inline constexpr std::string_view kEvalNote =
    "f |cos(theta_o)|. Same signs of wiz and woz: reflection; opposite: transmission; 0 where either is 0, where a "
    "sidedness test (Walter 7) fails, or under total internal reflection. Transmission carries eta^2 for radiance "
    "(Walter 21 as printed) and not for importance. Height-correlated: G = 1/(1 + Lambda_i + Lambda_o), Heitz 99.";
inline constexpr std::string_view kSeparableNote = "As eval with the separable G = G1(i) G1(o), Walter 23.";
inline constexpr std::string_view kPdfNote =
    "Solid-angle density of wo for D cos sampling of normals (Walter 24, 38) and, with both lobes, choice by Fresnel.";
inline constexpr std::string_view kEvalPdfNote = "eval and pdf in one call.";
inline constexpr std::string_view kEvalPdfSeparableNote = "eval_separable and pdf in one call.";
inline constexpr std::string_view kReflectorNote =
    "f |cos(theta_o)| of light that facets reflect and nothing transmits; 0 for opposite sides. Height-correlated: G = 1/(1 + "
    "Lambda_i + Lambda_o), Heitz 99.";
inline constexpr std::string_view kReflectorSampleNote =
    "m by D cos sampling, wi.m > 0 on wi's side, wo = 2 (wi.m) m - wi. weight = f |cos(theta_o)| / pdf in closed form (Walter 41). "
    "Where wo is not on wi's side: lobe 0, and every output 0.";
inline constexpr std::string_view kReflectorSampleVisibleNote =
    "m, wo and pdf of sample_visible_reflection of the distribution. weight = f |cos(theta_o)| / pdf = F G2/G1(wi) <= 1. wiz = 0 counts as "
    "above. Where wo is not on wi's side: lobe 0, and every output 0.";
inline constexpr std::string_view kVCavityNote =
    "As eval with the joint masking of V-cavities (Cook and Torrance 1982): G = min(1, 2 hz |wiz|/(wi.h), 2 hz |woz|/(wo.h)).";
inline constexpr std::string_view kSampleVCavityReflectionNote =
    "m of sample_visible_normal_v_cavity of the distribution, on wi's side, wo = 2 (wi.m) m - wi. weight = f |cos(theta_o)| / pdf = F G/G1(wi) "
    "<= 1. Where wo is not on wi's side, and at wiz = 0: lobe 0, and every output 0.";
inline constexpr std::string_view kKelemenNote =
    "f |cos(theta_o)| of f = P_H F/(H.H), H = wi + wo, P_H = D cos(theta_h): Ward's of Beckmann (Eq. 4), Phong's of Phong (Eq. 5, n = exponent "
    "+ 1); 0 for opposite sides.";
inline constexpr std::string_view kSampleKelemenNote =
    "m by P_H = D cos on wi's side, wo = 2 (wi.m) m - wi. weight = f |cos(theta_o)| / pdf = F |wo.z|/(wi.m) <= 2. Where wo is not on wi's side: "
    "lobe 0, and every output 0.";
inline constexpr std::string_view kDiffuseNote =
    "f |cos(theta_o)| of white Lambertian facets without light from facet to facet, as a sum over 3 order^2 normals (quadrature.h), "
    "against which the error bounds are; 0 for opposite sides and where wiz or woz is 0. Height-correlated: G = 1/(1 + Lambda_i + "
    "Lambda_o), Heitz 99.";
inline constexpr std::string_view kDiffuseSeparableNote = "As eval with the separable G = G1(i) G1(o), Heitz 98.";
inline constexpr std::string_view kOneNormalNote =
    "eval's integrand over mz D(m): unbiased for m of sample_normal of the distribution, f(wi.m, wo.m) (wi.m) (wo.m) G2/(|wiz| mz), f "
    "that of a facet. -wi and -wo in place of them below the surface; 0 where wi.m, wo.m or mz is not above 0 and for opposite sides.";
inline constexpr std::string_view kOneVisibleNormalNote =
    "eval's integrand over D_visible of wi: unbiased for m of sample_visible_normal of the distribution, f(wi.m, wo.m) (wo.m) G2/G1(wi), f "
    "that of a facet. -wi and -wo in place of them below the surface; 0 where wi.m, wo.m or mz is not above 0 and for opposite sides.";
inline constexpr std::string_view kPdfWithInterfaceNote =
    "R_s/(R_s + R_b) pdf_visible_reflection of the distribution + R_b/(R_s + R_b) |cos(theta_o)|/pi, R_s = r_e, R_b = (1 - r_e)^2 k/(n^2 (1 - "
    "k r_i)): wo by the interface's visible normals or by the cosine; by the cosine alone where both are 0; 0 for opposite sides.";
inline constexpr std::string_view kSampleWithInterfaceNote =
    "Where u3 < R_s/(R_s + R_b) of pdf_with_interface (lobe 1) wo = 2 (wi.m) m - wi of the visible normal m by u1 and u2, else (lobe 2) "
    "by the cosine. pdf is that of both together, weight (f_s + f_b) |cos(theta_o)| / pdf of rough_dielectric's eval_reflection and of "
    "eval_one_visible_normal about the visible normal by u4 and u5. All 0 with lobe 0 where wo is on the other side or wiz is 0. In double lanes.";
inline constexpr std::string_view kInterfacedNote =
    "f |cos(theta_o)| of the body: Lambertian of albedo k under smooth facets of index n_i, without light from facet to facet, as a sum over "
    "the normals of rough_diffuse's rule, against which the error bounds are. n_i = 1 is rough_diffuse times k. Height-correlated: G = 1/(1 + "
    "Lambda_i + Lambda_o), Heitz 99.";
inline constexpr std::string_view kDiffuseFresnelNote = "0 at eta = 1; eta beyond 1/4 or 4 counts as that. n^2 (1 - r_i) = 1 - r_e.";
inline constexpr std::string_view kMeanFresnelNote =
    "Mean of F(v.m) over the normals that v sees, as a sum over the normals of quadrature.h, against which the error bounds are. v of "
    "either side, as |vz|; 0 where v = 0.";
inline constexpr std::string_view kMeanFresnelCosineNote =
    "Cosine c at which Schlick's F is its mean over the normals of an isotropic surface seen at cos_i, as a fit (mean_fresnel_fit.h): "
    "f0 + (1 - f0) (1 - c)^5 is within 0.006 (1 - f0) of the mean over GGX and 0.0014 (1 - f0) over Beckmann. |cos_i| is used; alpha "
    "above 2 counts as 2.";
inline constexpr std::string_view kSampleNote =
    "wi.m > 0 on wi's side, else none; u3 < F reflects. Outside its hemisphere: lobe 0, and every output 0. "
    "weight = f |cos(theta_o)| / pdf in closed form (Walter 41).";
inline constexpr std::string_view kPdfVisibleNote =
    "Solid-angle density of wo for sampling of the normals visible from wi (Heitz 16) and, with both lobes, choice by Fresnel.";
inline constexpr std::string_view kSampleVisibleLobesNote =
    "m of sample_visible_normal of the distribution, on wi's side; u3 < F reflects. Outside its hemisphere, and at wiz = 0: lobe 0, and "
    "every output 0. weight = f |cos(theta_o)| / pdf = G2/G1(wi), at most 1 (importance: over eta^2 in transmission).";
inline constexpr std::string_view kSampleVisibleLobeNote =
    "As sample_visible with one lobe and no choice: weight = F or 1 - F times that, pdf without that factor; lobe 0 also where total "
    "internal reflection leaves nothing to transmit.";
inline constexpr std::string_view kSampleLobeNote =
    "As sample with one lobe and no choice: weight = F or 1 - F times Walter 41, pdf without that factor; lobe 0 also "
    "where total internal reflection leaves nothing to transmit.";

inline constexpr std::string_view kAlbedoNote =
    "a and 1 - a, linear between the entries of a table (albedo.h), against which the error bounds are; the table itself is within 1e-4 of "
    "the integral. |cos_i| is used, and above 1 counts as 1.";

inline constexpr std::string_view kCoupledNote =
    "f |cos(theta_o)| of f = P_H F/(H.H) + k (1 - a_i)(1 - a_o)/(pi (1 - a_average)), P_H as half_vector_density.ward of m, a as "
    "albedo.directional with the table's entries; 0 for opposite sides and where wiz or woz is 0.";
inline constexpr std::string_view kSampleCoupledNote =
    "u3 < a_i: lobe 1, m by P_H and wo = 2 (wi.m) m - wi; else u3 < a_i + k (1 - a_i): lobe 2, azimuth 2 pi u2 and cos(theta_o) by the inverse "
    "of int (1 - a) cos sin (the sine is missing in print) from the normal on, at u1 of it; else lobe 0 and every output 0, as where wo is not "
    "on wi's side. pdf of both lobes together; weight = f |cos(theta_o)| / pdf.";

inline constexpr std::string_view kGaussianNote =
    "tan(theta_m)^2 = (mx^2 + my^2)/mz^2 and cos(theta_m) = mz of m as given; 0 where mz <= 0. sigma beyond its ends counts as the nearer. "
    "Double lanes round the angle, and an exponent of up to 745, once.";

inline constexpr Kernel kComponentKernels[] = {
    // Mathematics that Highway 1.0.3 lacks, as the kernels use it.
    {"math.exp", "x", "y", "e^x", "0 below the subnormal range.", false, {1, 4, 96, 8, 1.5}},
    {"math.neg_log1m", "u1", "y", "-log(1 - u), used by Walter 2007 Eq. 28", "u in [0, 1).", false, {1, 4, 11, 8, 2}},
    {"math.sincos_2pi", "u1", "sin cos", "sin(2 pi u), cos(2 pi u), used by Walter 2007 Eq. 29", "", false, {1, 4, 256, 8, 2}},
    {"math.erfcx_defect", "a", "y", "1 - sqrt(pi) a exp(a^2) erfc(a): Heitz 2014 Eq. 69 is Lambda = y exp(-a^2) / (2 sqrt(pi) a)", "", false, {1, 4, 1600, 8, 13}},
    {"math.erfcx", "a", "y", "exp(a^2) erfc(a)", "a >= 0.", false, {1, 1, 96, 1, 8}},
    {"math.erfinv", "u1", "y", "erfinv(2 u - 1)", "u counts as at least 2^-126.", false, {1, 4, 640, 5, 4}},
    {"math.azimuth_difference", "wix wiy wox woy", "phi", "atan2(|wi x wo|, wi.wo) in the plane, used by Heitz 2014 Eqs. 100, 101", "In [0, pi]; 0 where an azimuth is undefined.", false, {1, 4, 64, 8, 4}},
    {"math.student_defect", "mu | gamma", "y", "1 - 2 n mu (1 + mu^2)^n int_mu^inf (1 + x^2)^-(n + 1) dx: Heitz 2014 Eq. 43 of Student-T slopes is Lambda = Gamma(n) y (1 + mu^2)^-n / (2 sqrt(pi) Gamma(n + 1/2) mu)", "n = gamma - 3/2; 1 - sqrt(pi) a exp(a^2) erfc(a) of a = mu sqrt(gamma - 1) as gamma grows. |mu| is used.", false, {1, 1, 3800, 1, 32}},

    {"fresnel.dielectric", "cos_i | eta", "F", "Walter 2007 Eq. 22", kFresnelNote, false, {1, 4, 3600, 8, 13}},
    {"fresnel.dielectric_transmittance", "cos_i | eta", "T", "1 - F, Walter 2007 Eq. 22", "|cos_i| is used; 0 under total internal reflection; 1 at eta = 1.", false, {1, 4, 2400, 8, 8}},
    {"fresnel.dielectric_s", "cos_i | eta", "F", "Walter 2007 Eq. 22, first factor: ((g - c)/(g + c))^2", kFresnelNote, false, {1, 4, 3400, 8, 10}},
    {"fresnel.dielectric_p", "cos_i | eta", "F", "Walter 2007 Eq. 22, the part polarised in the plane of incidence: ((eta^2 c - g)/(eta^2 c + g))^2", kFresnelNote, false, {1, 4, 1, 8, 18}},

    {"fresnel.conductor", "cos_i | n kappa", "F", "Meneveaux 2015 section 2.2; Kelemen 2001 appendix", "Unpolarised; index n + i kappa over that of the incident side; |cos_i| is used. At kappa = 0 the dielectric of eta = n.", false, {1, 4, 4200, 8, 16}},
    {"fresnel.diffuse_external", "eta", "F", "r_e of Meneveaux 2015 Eq. 10: mean of F over diffuse light from outside", kDiffuseFresnelNote, false, {1, 1, 400, 1, 32}},
    {"fresnel.diffuse_internal", "eta", "F", "r_i of Meneveaux 2015 Eq. 9: mean of F over diffuse light from inside", kDiffuseFresnelNote, false, {1, 1, 400, 1, 32}},
    {"fresnel.schlick", "cos_i | f0", "F", "Schlick 1994: f0 + (1 - f0) (1 - |cos_i|)^5", "|cos_i| above 1 counts as 1.", false, {1, 4, 16, 8, 4}},
    {"interfaced.facet_body", "cos_i cos_o | n_i k", "f", "Meneveaux 2015 Eq. 8", "Of a flat surface or one facet: T(cos_i) T(cos_o) k/(pi n^2 (1 - k r_i)); 0 where a cosine is not above 0. n_i beyond 1 or 4, and k beyond 0 or 1, count as that.", false, {1, 1, 5200, 1, 40}},

    {"half_vector.reflection", "wix wiy wiz wox woy woz", "hx hy hz", "Walter 2007 Eq. 13", "0 where wi = -wo; sign(0) = 1.", false, {1, 4, 2200, 8, 4}},
    {"half_vector.reflection_jacobian", "wix wiy wiz wox woy woz", "jacobian", "Walter 2007 Eq. 14, first form |o.h|/|h_r|^2", "0 where wi = -wo. Double lanes do not make up for what wo.h_r loses to cancellation near there.", false, {1, 4, 1, 8, 0x1p22}},
    {"half_vector.reflection_jacobian_cos", "cos_o", "jacobian", "Walter 2007 Eq. 14, second form 1/(4 |o.h|)", "The largest finite number at 0.", false, {1, 4, 1, 8, 1}},
    {"half_vector.refraction", "wix wiy wiz wox woy woz | eta", "hx hy hz", "Walter 2007 Eq. 16; Marschner 2012: -normalize(i + n o)", "Points into the side of lower index; 0 where i + eta o = 0.", false, {1, 4, 2200, 8, 4}},
    {"half_vector.refraction_jacobian", "wix wiy wiz wox woy woz | eta", "jacobian", "Walter 2007 Eq. 17, first form; Marschner 2012: n^2 |o.h|/|i + n o|^2", "0 where i + eta o = 0. Double lanes do not make up for what o.(i + eta o) loses to cancellation near there and edge-on.", false, {1, 4, 1, 8, 0x1p32}},
    {"half_vector.refraction_jacobian_cos", "cos_i cos_o | eta", "jacobian", "Walter 2007 Eq. 17, second form eta^2 |o.h|/(i.h + eta o.h)^2", "cos_i = i.h, cos_o = o.h; the largest finite number where the denominator is 0, and 0 where cos_o is 0.", false, {1, 4, 6, 8, 6}},

    {"reflect", "wix wiy wiz mx my mz", "wox woy woz", "Walter 2007 Eq. 39, as 2 (i.m) m - i", "", false, {1, 4, 3, 8, 2.5}},
    {"refract", "wix wiy wiz mx my mz | eta", "wox woy woz", "Walter 2007 Eq. 40", "sign(i.n) is sign(wiz), sign(0) = 1; 0 under total internal reflection. Double lanes do not make up for the cancellation of g^2 at the critical angle.", false, {1, 4, 1100, 8, 0x1p17}},

    {"half_vector_density.ward", "mx my mz | alpha", "density", "Kelemen 2001 Eq. 4 with m = alpha", "Of solid angle: mz D of beckmann.D_isotropic; 0 where mz <= 0. Double lanes round an exponent of up to 745 once.", false, {1, 4, 2800, 8, 3000}},
    {"half_vector_density.phong", "mx my mz | exponent", "density", "Kelemen 2001 Eq. 5 with n = exponent + 1", "Of solid angle: mz D of phong.D, (exponent + 2)/(2 pi) mz^(exponent + 1); 0 where mz <= 0. Double lanes round an exponent of up to 745 once.", false, {1, 4, 128, 8, 2000}},

    {"masking.v_cavity", "vx vy vz mx my mz", "G1", "Heitz 2014 Eq. 49; physically based", "min(1, 2 mz |vz| / |v.m|). v of either side, -v in place of v below; 0 where v.m and vz differ in sign or either is 0, and where mz <= 0. Satisfies the weak white furnace with every distribution of normals.", false, {1, 4, 1100, 8, 2}},
    {"masking.implicit", "vx vy vz mx my mz", "G1", "Heitz 2014 Eq. 56; not physically based", kMaskingSides, false, {1, 1, 1, 1, 1}},
    {"masking.schlick_smith", "vx vy vz mx my mz | alpha", "G1", "Heitz 2014 section 4.3, Schlick 1994; not physically based", "c/(c (1 - k) + k), c = |vz|, k = alpha sqrt(2/pi). v of either side; 0 where v.m and vz differ in sign or either is 0.", false, {1, 4, 1200, 8, 4}},
    {"masking.kelemen", "vx vy vz mx my mz", "G1", "Heitz 2014 Eq. 59; not physically based", "|vz|/|v.m|, above 1 where |v.m| < |vz|, the largest finite number where it is larger. v of either side; 0 where v.m and vz differ in sign or either is 0.", false, {1, 4, 1100, 8, 2}},
    {"masking.separable", "Lambda_i Lambda_o", "G2", "Heitz 2014 Eq. 98", kJointNote, false, {1, 4, 2200, 8, 4}},
    {"masking.height_correlated", "Lambda_i Lambda_o", "G2", "Heitz 2014 Eq. 99", kJointNote, false, {1, 4, 1200, 8, 3}},
    {"masking.height_correlated_transmission", "Lambda_i Lambda_o", "G2", "Heitz et al. 2016", "B(1 + Lambda_i, 1 + Lambda_o), B Euler's Beta function: masking and shadowing from opposite sides of one height. Sidedness is the caller's.", false, {1, 1, 1, 1, 4000}},
    {"masking.student_lambda", "vx vy vz | alpha_x alpha_y gamma", "Lambda", "Heitz 2014 Eqs. 41-43 of Student-T slopes (d'Eon 2023; Burley 2012)", "Slopes of density 1/(pi alpha_x alpha_y) (1 + (x^2/alpha_x^2 + y^2/alpha_y^2)/(gamma - 1))^-gamma. The same on both sides of the surface; 0 along the normal; the largest finite number where the exact value exceeds it. Double lanes round an exponent of up to 745 once.", false, {1, 1, 1, 1, 6000}},
    {"masking.direction_correlated", "Lambda_i Lambda_o wix wiy wox woy", "G2", "Heitz 2014 Eq. 100", kDirectionNote, false, {1, 4, 2200, 8, 6}},
    {"masking.height_direction_correlated", "Lambda_i Lambda_o wix wiy wox woy", "G2", "Heitz 2014 Eq. 101", kDirectionNote, false, {1, 4, 1200, 8, 4}},

    {"gaussian.C", "sigma", "C", "Meneveaux 2015, after Eq. 13", "1/(2 pi Int_0^(pi/2) exp(-t^2/(2 sigma^2)) sin(t) dt); sigma beyond its ends counts as the nearer.", false, {1, 1, 64, 1, 8}},
    {"gaussian.D", "mx my mz | sigma", "D", "Meneveaux 2015 Eq. 13", kGaussianNote, false, {1, 1, 1000, 1, 6000}},
    {"gaussian.D_visible_v_cavity", "vx vy vz mx my mz | sigma", "D", "Heitz 2014 Eqs. 16, 49; Meneveaux 2015 Eqs. 13, 14", "min(|v.m|/|vz|, 2 mz) D(m) with gaussian.D; v of either side, -v in place of v below; vz = 0 counts as above. 0 where v.m and vz differ in sign, and where mz <= 0.", false, {1, 1, 2400, 1, 6000}},
    {"gaussian.eval_v_cavity", "wix wiy wiz wox woy woz | sigma", "f_cos", "Meneveaux 2015 Eqs. 13, 14; Walter 2007 Eq. 20", "D(h) G/(4 |wiz|), f |cos(theta_o)| of ideal mirrors, G = min(1, 2 hz |wiz|/(wi.h), 2 hz |woz|/(wo.h)); 0 for opposite sides and where wiz or woz is 0. sigma beyond its ends counts as the nearer. Double lanes round the angle, and an exponent of up to 745, once.", false, {1, 1, 1, 1, 6000}},
    {"gaussian.sample_normal", "u1 u2 | sigma", "mx my mz pdf", "Meneveaux 2015 Eq. 13 with theta in place of sin(theta) and cos(theta)", "theta_m = sigma sqrt(-2 log(1 - u1 q)), q = 1 - exp(-pi^2/(8 sigma^2)), azimuth 2 pi u2; pdf = theta_m exp(-theta_m^2/(2 sigma^2))/(2 pi sigma^2 q sin(theta_m)), which is not D cos, but D cos theta_m/sin(theta_m) times 1/(2 pi C sigma^2 q). sigma beyond its ends counts as the nearer.", false, {1, 1, 2000, 1, 32}},

    {"albedo.directional", "cos_i | | m index", "albedo deficit", "Kelemen 2001 section 2.1.5, of Eqs. 3, 4", kAlbedoNote, false, {1, 2, 2, 2, 2}},

    {"coupled.eval", "wix wiy wiz wox woy woz | k | m index", "f_cos", "Kelemen 2001 Eqs. 3, 4, 7", kCoupledNote, false, {1, 14, 6500, 20, 0x1p12}},
    {"coupled.pdf", "wix wiy wiz wox woy woz | k | m index", "pdf", "Kelemen 2001 sections 2.1.4, 2.2.1", "Density with which sample finds wo: a_i P_H/(4 cos(beta)) + k (1 - a_i) (1 - a_o) |cos(theta_o)|/(pi (1 - a_average)).", false, {1, 10, 2400, 18, 4800}},
    {"coupled.eval_pdf", "wix wiy wiz wox woy woz | k | m index", "f_cos pdf", "Kelemen 2001 Eqs. 3, 4, 7, section 2.2.1", "eval and pdf in one call.", false, {1, 14, 6500, 20, 0x1p12}},
    {"coupled.sample", "wix wiy wiz u1 u2 u3 | k | m index", "wox woy woz weight pdf lobe", "Kelemen 2001 sections 2.1.4, 2.2.1", kSampleCoupledNote, false, {1, 1, 1, 1, 0x1p14}},

    {"roughness.from_moments", "mean_x mean_y moment_xx moment_yy moment_xy", "alpha_x alpha_y r_xy", "Olano and Baker 2010; Dupuy et al. 2013", "alpha^2/2 = E[x^2] - E[x]^2, r = (E[x y] - E[x] E[y])/(alpha_x alpha_y/2) of slopes; alphas within 1e-5 and 100, |r| at most 0.9999.", false, {1, 1, 1, 1, 4}},
    {"roughness.to_moments", "alpha_x alpha_y r_xy mean_x mean_y", "moment_xx moment_yy moment_xy", "Olano and Baker 2010; Dupuy et al. 2013", "E[x^2] = E[x]^2 + alpha_x^2/2, E[x y] = E[x] E[y] + r alpha_x alpha_y/2 of slopes.", false, {1, 1, 1, 1, 4}},
};

// Distributions of normals, by their places in kNormalFamilies and kModelFamilies.
enum class Normals { kGgx, kBeckmann, kPhong, kStudentT, kTabulated };

// Parameters of a distribution behind those of its own shape, by their places in kRoughnesses. All but the exponent are
// linear maps of the slopes of one distribution of unit roughness (Heitz 2014 section 5).
enum class RoughnessKind { kAnisotropic, kIsotropic, kRotated, kOffCentre, kExponent };

struct RoughnessRow {
  std::string_view suffix;  // of the ids
  std::string_view parameters;
};

inline constexpr RoughnessRow kRoughnesses[] = {
    {"", "alpha_x alpha_y"},
    {"_isotropic", "alpha"},
    {"_rotated", "alpha_x alpha_y r_xy"},
    {"_off_centre", "alpha_x alpha_y r_xy mean_x mean_y"},
    {"", "exponent"},
};

// Of the notes of the rows below, for the kinds that shear (Heitz 2014 Eqs. 88-97): the slopes (x, y) become
// (x/alpha_x, (y/alpha_y - r_xy x/alpha_x) / sqrt(1 - r_xy^2)), where off-centre the mean slope comes off first, normals
// by (x + mean_x z, y + mean_y z, z); and directions go by the inverse transpose, so that in place of vz and of the side of
// the surface stand those of the mesosurface, vz - mean_x vx - mean_y vy.
// Sums that cancel are formed in double lanes, so that double lanes themselves lose what near correlation (1/sqrt(1 - r^2))
// and a small alpha beside a large mean magnify; high, standard and fast do not.
// What every distribution may give, and what one of them alone gives (kOwn).
struct NormalQuantity {
  enum What {
    kD, kLambda, kG1, kDVisible, kSampleNormal, kSampleVisible, kSampleVisibleBounded,
    kSampleReflection, kSampleReflectionBounded,  // about a visible normal
    kPdfReflection, kPdfReflectionBounded,        // of those
    kDVisibleVCavity, kSampleVCavity,             // of normals as V-cavities show them
    kOwn
  };
  std::string_view lanes, outputs;
};

// By NormalQuantity::What.
inline constexpr NormalQuantity kNormalQuantities[] = {
    {"mx my mz", "D"},
    {"vx vy vz", "Lambda"},
    {"vx vy vz mx my mz", "G1"},
    {"vx vy vz mx my mz", "D"},
    {"u1 u2", "mx my mz pdf"},
    {"vx vy vz u1 u2", "mx my mz pdf"},
    {"vx vy vz u1 u2", "mx my mz pdf"},
    {"wix wiy wiz u1 u2", "wox woy woz weight pdf lobe"},
    {"wix wiy wiz u1 u2", "wox woy woz weight pdf lobe"},
    {"wix wiy wiz wox woy woz", "pdf"},
    {"wix wiy wiz wox woy woz", "pdf"},
    {"vx vy vz mx my mz", "D"},
    {"vx vy vz u1 u2 u3", "mx my mz pdf"},
};

inline constexpr std::string_view kStretch =
    "Heitz 2014 Eq. 85/82: tan^2 = (x^2/alpha_x^2 + y^2/alpha_y^2)/z^2 of the direction as given; 0 where mz <= 0.";
inline constexpr std::string_view kStretchedExponent =
    "Heitz 2014 Eq. 82: tan^2 = (x^2/alpha_x^2 + y^2/alpha_y^2)/z^2 of the direction as given; 0 where mz <= 0. Double "
    "lanes round an exponent of up to 745 once.";
inline constexpr std::string_view kLambdaNote =
    "a = |vz| / sqrt((alpha_x vx)^2 + (alpha_y vy)^2), the same on both sides of the surface; 0 at a = inf; "
    "the largest finite number where the exact value exceeds it (vz = 0).";
inline constexpr std::string_view kLambdaExponentNote =
    "a = |vz| / sqrt((alpha_x vx)^2 + (alpha_y vy)^2), the same on both sides of the surface; 0 at a = inf; "
    "the largest finite number where the exact value exceeds it (vz = 0). Double lanes round an exponent of up to 745 "
    "once.";
inline constexpr std::string_view kG1Note = "chi+((v.m)/(v.n)) / (1 + Lambda(v)); 0 where (v.m) vz <= 0.";
inline constexpr std::string_view kDVisibleNote =
    "D_v(m) = G1(v,m) |v.m| D(m) / |v.n| = 2 (v.m) D(m) / (|vz| + sqrt(vz^2 + (alpha_x vx)^2 + (alpha_y vy)^2)); v of "
    "either side, -v in place of v below; vz = 0 counts as above. 0 where v.m and vz differ in sign, and where mz <= 0.";
inline constexpr std::string_view kDVisibleExponentNote =
    "D_v(m) = G1(v,m) |v.m| D(m) / |v.n|; v of either side, -v in place of v below; vz = 0 counts as above. 0 where v.m and vz "
    "differ in sign, and where mz <= 0. Double lanes round exponents of up to 745 once.";
inline constexpr std::string_view kSampleVisibleNote =
    "Spherical caps: s = normalize(alpha_x vx, alpha_y vy, vz), c of azimuth 2 pi u2 and c.z = (1 - u1)(1 + s.z) - s.z, "
    "h = c + s, m = normalize(alpha_x hx, alpha_y hy, hz); pdf = D_v(m). Below the surface -v in place of v, so that mz > "
    "0 on either side; vz = 0 counts as above. 0 where v = 0.";
inline constexpr std::string_view kSampleVisibleBeckmannNote =
    "m = normalize(alpha_x (e.x t - e.y y), alpha_y (e.y t + e.x y), 1): e = azimuth of (alpha_x vx, alpha_y vy), (1, 0) at 0; y = "
    "erfinv(2 u2 - 1); u1 M = sqrt(pi) a erfc(t) + exp(-t^2), M = sqrt(pi) a erfc(-a) + exp(-a^2), t >= -a = -|vz| / |(alpha_x vx, "
    "alpha_y vy)|; pdf = D_v(m). u1, u2 count as at least 2^-126. Below the surface -v in place of v, so that mz > 0 on either side; "
    "vz = 0 counts as above. 0 where v = 0.";
inline constexpr std::string_view kSampleBoundedNote =
    "As ggx.sample_visible_normal with c.z = (1 - u1)(1 + k s.z) - k s.z, k = (1 - a^2) t^2/(t^2 + a^2 vz^2), a = min(alpha_x, "
    "alpha_y, 1), t = 1 + sqrt(vx^2 + vy^2); pdf of m: D_v(m) (1 + s.z)/(1 + k s.z).";
inline constexpr std::string_view kSampleReflectionNote =
    "wo = 2 (wi.m) m - wi, m of sample_visible_normal, turned to wi's side; weight = (1 + Lambda_i)/(1 + Lambda_i + "
    "Lambda_o), which is f |cos(theta_o)| / pdf of the ideal mirror, F = 1, and at most 1; pdf = D_v(m)/(4 |wi.m|). wiz = 0 "
    "counts as above. Where wo is not on wi's side: lobe 0, and every output 0.";
inline constexpr std::string_view kSampleReflectionBoundedNote =
    "As ggx.sample_visible_reflection with m of ggx.sample_visible_normal_bounded: weight times (1 + k s.z)/(1 + s.z), pdf over "
    "that.";
inline constexpr std::string_view kPdfReflectionNote =
    "Density with which sample_visible_reflection finds wo: G1(wi) D(h)/(4 |wiz|) = D(h)/(2 (|wiz| + sqrt(wiz^2 + (alpha_x wix)^2 + "
    "(alpha_y wiy)^2))) of GGX, h the half vector; 0 where wiz or woz is 0, and for opposite sides.";
inline constexpr std::string_view kPdfReflectionBeckmannNote =
    "Density with which sample_visible_reflection finds wo: G1(wi) D(h)/(4 |wiz|), h the half vector; 0 where wiz or woz is 0, and "
    "for opposite sides.";
inline constexpr std::string_view kPdfReflectionBoundedNote =
    "Density with which sample_visible_reflection_bounded finds wo: that of ggx.pdf_visible_reflection times (1 + s.z)/(1 + k s.z).";
inline constexpr std::string_view kDVisibleVCavityNote =
    "masking.v_cavity in place of Smith's G1 in Heitz 2014 Eq. 16: min(|v.m|/|vz|, 2 mz) D(m); v of either side, -v in place of v "
    "below; vz = 0 counts as above. 0 where v.m and vz differ in sign, and where mz <= 0.";
inline constexpr std::string_view kSampleVCavityNote =
    "The normal n of sample_normal, or the other facet of its V-cavity (-n.x, -n.y, n.z), each by its share of what v sees: the other "
    "where 2 u3 n.z vz < n.z vz - n.x vx - n.y vy; pdf = D_visible_v_cavity. Below the surface -v in place of v, so that mz > 0 on "
    "either side; vz = 0 counts as above.";
inline constexpr std::string_view kSampleGgxNote = "m = normalize(alpha_x r cos(2 pi u2), alpha_y r sin(2 pi u2), 1), r = sqrt(u1/(1 - u1)); pdf = D cos.";
inline constexpr std::string_view kSampleBeckmannNote = "m = normalize(alpha_x r cos(2 pi u2), alpha_y r sin(2 pi u2), 1), r = sqrt(-log(1 - u1)); pdf = D cos.";
inline constexpr std::string_view kStudentNote =
    "Slopes of density 1/(pi alpha_x alpha_y) (1 + (x^2/alpha_x^2 + y^2/alpha_y^2)/(gamma - 1))^-gamma: GGX at gamma = 2, Beckmann as "
    "gamma grows. Of the direction as given; 0 where mz <= 0. Double lanes round an exponent of up to 745 once.";
inline constexpr std::string_view kStudentLambdaNote =
    "Smith's, exactly, of student_t.D's slopes; the same on both sides of the surface; 0 along the normal; the largest finite number "
    "where the exact value exceeds it (vz = 0). Double lanes round an exponent of up to 745 once.";
inline constexpr std::string_view kSampleStudentNote =
    "m = normalize(alpha_x r cos(2 pi u2), alpha_y r sin(2 pi u2), 1), 1 + r^2/(gamma - 1) = (1 - u1)^(-1/(gamma - 1)); pdf = D cos.";
inline constexpr std::string_view kTabulatedNote =
    "Slopes of a user's density f(r)/(alpha_x alpha_y), r^2 = x^2/alpha_x^2 + y^2/alpha_y^2, as cubics of log f in a table "
    "(radial_table.h), against which the error bounds are. Of the direction as given; 0 where mz <= 0. Double lanes round an exponent of "
    "up to 745 once.";
inline constexpr std::string_view kTabulatedLambdaNote =
    "Smith's of tabulated.D's slopes, as cubics of log(a Lambda) in a table, against which the error bounds are; the same on both sides "
    "of the surface; 0 along the normal; the largest finite number where the exact value exceeds it (vz = 0). Double lanes round an "
    "exponent of up to 745 once.";
inline constexpr std::string_view kSampleTabulatedNote =
    "m = normalize(alpha_x r cos(2 pi u2), alpha_y r sin(2 pi u2), 1), log(1 + r^2) by the table's inverse of f's cumulative function at "
    "u1; pdf = D cos.";
inline constexpr std::string_view kSampleVisibleTabulatedNote =
    "m = normalize(alpha_x (t cos - y sin), alpha_y (t sin + y cos), 1) of the azimuth of (alpha_x vx, alpha_y vy): u1 of visible normals "
    "slope by more than t towards v at unit roughness, t at most 2^200 and mz at least 2^-126, by W(a) = a Lambda(a) of the table and its derivatives, and u2 of "
    "those by less than y across it, by another, y/sqrt(1 + t^2) at most sinh(60); pdf = D_visible. Below the surface -v in place of v, so "
    "that mz > 0 on either side; vz = 0 counts as above. 0 where v = 0.";
inline constexpr std::string_view kPhongNote =
    "(exponent + 2)/(2 pi) mz^exponent of mz as given; 0 where mz <= 0. Double lanes round an exponent of up to 745 once.";

inline constexpr std::size_t kNumRoughnesses = std::size(kRoughnesses);

// One quantity of one distribution, with bounds for each kind of roughness that it takes; those of the others are 0.
struct NormalRow {
  Normals normals;
  NormalQuantity::What what;
  std::string_view name, source, note;
  Bounds bounds[kNumRoughnesses];
  // Of kOwn, whose bounds stand first. NOLINTNEXTLINE(readability-redundant-member-init): rows may leave them out
  std::string_view own_inputs{}, own_outputs{};

  constexpr bool Takes(std::size_t roughness) const { return bounds[roughness].high > 0; }
};

struct NormalFamily {
  std::string_view id;
  std::string_view own;    // parameters of its shape, which stand before those of its roughness
  std::string_view table;  // what an object is made of that calls take whole, in place of such
};

inline constexpr NormalFamily kNormalFamilies[] = {{"ggx", "", ""}, {"beckmann", "", ""}, {"phong", "", ""}, {"student_t", "gamma ", ""}, {"tabulated", "", " | tail"}};

// Columns of bounds: those of kRoughnesses.
inline constexpr NormalRow kNormalRows[] = {
    {Normals::kGgx, NormalQuantity::kD, "D", "Heitz 2014 Eq. 85; Walter 2007 Eq. 33", kStretch, {{1, 4, 2400, 8, 4}, {1, 4, 2400, 8, 3}, {1, 4, 4, 8, 1000}, {1, 4, 4, 8, 1000}}},
    {Normals::kGgx, NormalQuantity::kLambda, "Lambda", "Heitz 2014 Eqs. 72, 86", kLambdaNote, {{1, 4, 1300, 8, 5}, {1, 4, 1300, 8, 5}, {1, 1, 1300, 1, 128}, {1, 1, 1, 1, 128}}},
    {Normals::kGgx, NormalQuantity::kG1, "G1", "Walter 2007 Eq. 34, stretched", kG1Note, {{1, 4, 2048, 8, 3}, {1, 4, 2048, 8, 3}, {1, 4, 2048, 8, 64}, {1, 4, 2048, 8, 64}}},
    {Normals::kGgx, NormalQuantity::kSampleNormal, "sample_normal", "Walter 2007 Eqs. 24, 35, 36, stretched", kSampleGgxNote, {{1, 4, 2400, 8, 15}, {1, 4, 2400, 8, 15}, {1, 1, 1, 1, 40000}, {1, 1, 1, 1, 40000}}},
    {Normals::kGgx, NormalQuantity::kDVisible, "D_visible", "Heitz 2014 Eq. 16", kDVisibleNote, {{1, 4, 4000, 8, 8}, {1, 4, 4000, 8, 8}, {1, 4, 4000, 8, 1000}, {1, 4, 4000, 8, 1000}}},
    {Normals::kGgx, NormalQuantity::kSampleVisible, "sample_visible_normal", "Dupuy and Benyoub 2023; Heitz 2014 Eq. 16", kSampleVisibleNote, {{1, 16, 3000, 24, 16}, {1, 16, 3000, 24, 16}, {1, 1, 1, 1, 6000}, {1, 1, 1, 1, 6000}}},
    {Normals::kGgx, NormalQuantity::kSampleVisibleBounded, "sample_visible_normal_bounded", "Eto and Tokuyoshi 2023; Heitz 2014 Eq. 16", kSampleBoundedNote, {{1, 16, 4000, 24, 16}, {1, 16, 4000, 24, 16}}},
    {Normals::kGgx, NormalQuantity::kSampleReflection, "sample_visible_reflection", "Dupuy and Benyoub 2023; Heitz 2014 Eqs. 16, 99; Walter 2007 Eqs. 14, 39", kSampleReflectionNote, {{1, 24, 2800, 32, 24}, {1, 24, 2800, 32, 24}}},
    {Normals::kGgx, NormalQuantity::kSampleReflectionBounded, "sample_visible_reflection_bounded", "Eto and Tokuyoshi 2023; Heitz 2014 Eqs. 16, 99; Walter 2007 Eqs. 14, 39", kSampleReflectionBoundedNote, {{1, 24, 2800, 32, 24}, {1, 24, 2800, 32, 24}}},

    {Normals::kGgx, NormalQuantity::kPdfReflection, "pdf_visible_reflection", "Heitz 2014 Eq. 16; Walter 2007 Eq. 14", kPdfReflectionNote, {{1, 16, 2800, 24, 300}, {1, 16, 2800, 24, 300}}},
    {Normals::kGgx, NormalQuantity::kPdfReflectionBounded, "pdf_visible_reflection_bounded", "Eto and Tokuyoshi 2023; Heitz 2014 Eq. 16; Walter 2007 Eq. 14", kPdfReflectionBoundedNote, {{1, 16, 2800, 24, 300}, {1, 16, 2800, 24, 300}}},
    {Normals::kGgx, NormalQuantity::kDVisibleVCavity, "D_visible_v_cavity", "Heitz 2014 Eqs. 16, 49", kDVisibleVCavityNote, {{1, 4, 4000, 8, 5000}, {1, 4, 4000, 8, 5000}}},
    {Normals::kGgx, NormalQuantity::kSampleVCavity, "sample_visible_normal_v_cavity", "Heitz and d'Eon 2014; Heitz 2014 Eqs. 16, 49", kSampleVCavityNote, {{1, 8, 4000, 12, 64}, {1, 8, 4000, 12, 64}}},

    {Normals::kBeckmann, NormalQuantity::kD, "D", "Heitz 2014 Eq. 82; Walter 2007 Eq. 25", kStretchedExponent, {{1, 4, 2800, 8, 3000}, {1, 4, 2800, 8, 3000}, {1, 4, 200, 8, 0x1p17}, {1, 4, 200, 8, 0x1p17}}},
    {Normals::kBeckmann, NormalQuantity::kLambda, "Lambda", "Heitz 2014 Eqs. 69, 83", kLambdaExponentNote, {{1, 4, 1700, 8, 2200}, {1, 4, 1700, 8, 2200}, {1, 1, 1700, 1, 50000}, {1, 1, 1, 1, 50000}}},
    {Normals::kBeckmann, NormalQuantity::kG1, "G1", "Walter 2007 Eq. 26, stretched", kG1Note, {{1, 4, 2500, 8, 14}, {1, 4, 2500, 8, 14}, {1, 1, 2500, 1, 64}, {1, 1, 2500, 1, 64}}},
    {Normals::kBeckmann, NormalQuantity::kDVisible, "D_visible", "Heitz 2014 Eq. 16", kDVisibleExponentNote, {{1, 4, 4000, 8, 3000}, {1, 4, 4000, 8, 3000}, {1, 4, 2800, 8, 0x1p17}, {1, 4, 2800, 8, 0x1p17}}},
    {Normals::kBeckmann, NormalQuantity::kSampleVisible, "sample_visible_normal", "Heitz 2014 Eq. 16 by the inverse of its cumulative function", kSampleVisibleBeckmannNote, {{1, 24, 3300, 24, 24}, {1, 24, 3300, 24, 24}, {1, 1, 1, 1, 4000}, {1, 1, 1, 1, 4000}}},
    {Normals::kBeckmann, NormalQuantity::kSampleReflection, "sample_visible_reflection", "Heitz 2014 Eqs. 16, 99; Walter 2007 Eqs. 14, 39", kSampleReflectionNote, {{1, 16, 2800, 20, 18}, {1, 16, 2800, 20, 18}}},
    {Normals::kBeckmann, NormalQuantity::kPdfReflection, "pdf_visible_reflection", "Heitz 2014 Eq. 16; Walter 2007 Eq. 14", kPdfReflectionBeckmannNote, {{1, 16, 3400, 24, 5000}, {1, 16, 3400, 24, 5000}}},
    {Normals::kBeckmann, NormalQuantity::kOwn, "G1_rational", "Walter 2007 Eq. 27, clamped at 1", "The error bound is against Eq. 27; Eq. 27 itself is within 0.313% of Eq. 26.", {{1, 4, 2300, 8, 6}}, "vx vy vz mx my mz | alpha_x alpha_y", "G1"},
    {Normals::kBeckmann, NormalQuantity::kSampleNormal, "sample_normal", "Walter 2007 Eqs. 24, 28, 29, stretched", kSampleBeckmannNote, {{1, 4, 2400, 8, 17}, {1, 4, 2400, 8, 17}, {1, 1, 1, 1, 900}, {1, 1, 1, 1, 900}}},
    {Normals::kBeckmann, NormalQuantity::kOwn, "sample_normal_widened", "Walter 2007 section 5.3", "beckmann.sample_normal with both alphas times 1.2 - 0.2 sqrt(|cos_i|).", {{1, 4, 3000, 8, 17}}, "u1 u2 cos_i | alpha_x alpha_y", "mx my mz pdf"},
    {Normals::kBeckmann, NormalQuantity::kDVisibleVCavity, "D_visible_v_cavity", "Heitz 2014 Eqs. 16, 49", kDVisibleVCavityNote, {{1, 4, 4000, 8, 5000}, {1, 4, 4000, 8, 5000}}},
    {Normals::kBeckmann, NormalQuantity::kSampleVCavity, "sample_visible_normal_v_cavity", "Heitz and d'Eon 2014; Heitz 2014 Eqs. 16, 49", kSampleVCavityNote, {{1, 8, 4000, 12, 64}, {1, 8, 4000, 12, 64}}},

    {Normals::kPhong, NormalQuantity::kOwn, "exponent", "Walter 2007, after Eq. 30: 2/alpha^2 - 2", "0 for alpha >= 1.", {{1, 4, 1200, 8, 1.5}}, "alpha", "exponent"},
    {Normals::kPhong, NormalQuantity::kOwn, "Lambda", "Heitz 2014 Eqs. 41-43 of Student-T slopes with gamma = exponent/2 + 2, alpha = sqrt(2/(exponent + 2)); Heitz 2014 section 7", "Smith's, exactly; the same on both sides of the surface; 0 along the normal; the largest finite number where the exact value exceeds it (vz = 0). Double lanes round an exponent of up to 745 once.", {{1, 1, 5000, 1, 6000}}, "vx vy vz | exponent", "Lambda"},
    {Normals::kPhong, NormalQuantity::kOwn, "G1_smith", "Heitz 2014 Eqs. 41-43, 80 of Student-T slopes; Heitz 2014 section 7", "1/(1 + Lambda) with phong.Lambda; 0 where (v.m) vz <= 0.", {{1, 1, 2600, 1, 24}}, "vx vy vz mx my mz | exponent", "G1"},
    {Normals::kPhong, NormalQuantity::kD, "D", "Walter 2007 Eq. 30", kPhongNote, {{}, {}, {}, {}, {1, 4, 128, 8, 2000}}},
    {Normals::kPhong, NormalQuantity::kG1, "G1", "Walter 2007 Eq. 27 with a = sqrt(0.5 exponent + 1)/tan(theta_v), clamped at 1", "chi+((v.m)/(v.n)) by Walter's recipe, which is not Phong's own masking: see phong.G1_smith; 0 where (v.m) vz <= 0.", {{}, {}, {}, {}, {1, 4, 2900, 8, 6}}},
    {Normals::kPhong, NormalQuantity::kSampleNormal, "sample_normal", "Walter 2007 Eqs. 24, 31, 32", "cos(theta_m) = u1^(1/(exponent + 2)); pdf = D cos. Double lanes round the logarithm of the density once.", {{}, {}, {}, {}, {1, 4, 1200, 8, 128}}},
    {Normals::kPhong, NormalQuantity::kDVisibleVCavity, "D_visible_v_cavity", "Heitz 2014 Eqs. 16, 49", kDVisibleVCavityNote, {{}, {}, {}, {}, {1, 4, 4000, 8, 5000}}},
    {Normals::kPhong, NormalQuantity::kSampleVCavity, "sample_visible_normal_v_cavity", "Heitz and d'Eon 2014; Heitz 2014 Eqs. 16, 49", kSampleVCavityNote, {{}, {}, {}, {}, {1, 4, 3000, 8, 64}}},

    {Normals::kStudentT, NormalQuantity::kD, "D", "d'Eon 2023; Burley 2012; Heitz 2014 Eqs. 65, 73", kStudentNote, {{1, 4, 2800, 8, 5000}, {1, 4, 2800, 8, 5000}, {1, 4, 200, 8, 0x1p17}, {1, 4, 200, 8, 0x1p17}}},
    {Normals::kStudentT, NormalQuantity::kLambda, "Lambda", "Heitz 2014 Eqs. 41-43, 73", kStudentLambdaNote, {{1, 1, 1, 1, 6000}, {1, 1, 1, 1, 6000}, {1, 1, 1, 1, 50000}, {1, 1, 1, 1, 50000}}},
    {Normals::kStudentT, NormalQuantity::kG1, "G1", "Heitz 2014 Eqs. 41-43, 80", kG1Note, {{1, 1, 2600, 1, 24}, {1, 1, 2600, 1, 24}, {1, 1, 2600, 1, 64}, {1, 1, 2600, 1, 64}}},
    {Normals::kStudentT, NormalQuantity::kDVisible, "D_visible", "Heitz 2014 Eq. 16", kDVisibleExponentNote, {{1, 4, 4096, 8, 5000}, {1, 4, 4096, 8, 5000}, {1, 4, 2800, 8, 0x1p17}, {1, 4, 2800, 8, 0x1p17}}},
    {Normals::kStudentT, NormalQuantity::kSampleNormal, "sample_normal", "Walter 2007 Eq. 24; d'Eon 2023; Burley 2012, stretched", kSampleStudentNote, {{1, 4, 2400, 8, 32}, {1, 4, 2400, 8, 32}, {1, 1, 1, 1, 40000}, {1, 1, 1, 1, 40000}}},
    {Normals::kStudentT, NormalQuantity::kDVisibleVCavity, "D_visible_v_cavity", "Heitz 2014 Eqs. 16, 49", kDVisibleVCavityNote, {{1, 4, 4000, 8, 5000}, {1, 4, 4000, 8, 5000}}},
    {Normals::kStudentT, NormalQuantity::kSampleVCavity, "sample_visible_normal_v_cavity", "Heitz and d'Eon 2014; Heitz 2014 Eqs. 16, 49", kSampleVCavityNote, {{1, 4, 3000, 8, 32}, {1, 4, 3000, 8, 32}}},

    {Normals::kTabulated, NormalQuantity::kD, "D", "Heitz 2014 Eqs. 65, 73", kTabulatedNote, {{1, 4, 2800, 8, 5000}, {1, 4, 2800, 8, 5000}, {1, 4, 200, 8, 0x1p17}, {1, 4, 200, 8, 0x1p17}}},
    {Normals::kTabulated, NormalQuantity::kLambda, "Lambda", "Heitz 2014 Eqs. 41-43, 73, 87", kTabulatedLambdaNote, {{1, 1, 1, 1, 6000}, {1, 1, 1, 1, 6000}, {1, 1, 1, 1, 50000}, {1, 1, 1, 1, 50000}}},
    {Normals::kTabulated, NormalQuantity::kG1, "G1", "Heitz 2014 Eqs. 41-43, 80, 87", kG1Note, {{1, 1, 2600, 1, 24}, {1, 1, 2600, 1, 24}, {1, 1, 2600, 1, 64}, {1, 1, 2600, 1, 64}}},
    {Normals::kTabulated, NormalQuantity::kDVisible, "D_visible", "Heitz 2014 Eqs. 16, 87", kDVisibleExponentNote, {{1, 4, 4096, 8, 5000}, {1, 4, 4096, 8, 5000}, {1, 4, 2800, 8, 0x1p17}, {1, 4, 2800, 8, 0x1p17}}},
    {Normals::kTabulated, NormalQuantity::kSampleNormal, "sample_normal", "Walter 2007 Eq. 24; Heitz 2014 Eqs. 65, 73", kSampleTabulatedNote, {{1, 4, 2400, 8, 256}, {1, 4, 2400, 8, 256}, {1, 1, 1, 1, 1000}, {1, 1, 1, 1, 1000}}},
    {Normals::kTabulated, NormalQuantity::kSampleVisible, "sample_visible_normal", "Heitz 2014 Eqs. 16, 87 by the inverse of its cumulative function", kSampleVisibleTabulatedNote, {{1, 1, 1, 1, 0x1p16}, {1, 1, 1, 1, 0x1p16}, {1, 1, 1, 1, 0x1p19}, {1, 1, 1, 1, 0x1p19}}},
    {Normals::kTabulated, NormalQuantity::kDVisibleVCavity, "D_visible_v_cavity", "Heitz 2014 Eqs. 16, 49", kDVisibleVCavityNote, {{1, 4, 4000, 8, 5000}, {1, 4, 4000, 8, 5000}}},
    {Normals::kTabulated, NormalQuantity::kSampleVCavity, "sample_visible_normal_v_cavity", "Heitz and d'Eon 2014; Heitz 2014 Eqs. 16, 49", kSampleVCavityNote, {{1, 4, 3000, 8, 256}, {1, 4, 3000, 8, 256}}},
};

// Whether sampling of visible normals is among a distribution's quantities.
constexpr bool HasVisibleNormals(Normals normals) {
  for (const NormalRow& row : kNormalRows) {
    if (row.normals == normals && row.what == NormalQuantity::kSampleVisible) return true;
  }
  return false;
}

// What the rough dielectric gives over each distribution of normals; what has to do with visible normals, last, only where
// the distribution has them.
struct DielectricQuantity {
  enum What { kEval, kPdf, kEvalPdf, kSample, kEvalNormal };  // the last: about a given normal
  enum Joint { kCorrelated, kSeparable, kVCavity, kKelemen };
  std::string_view name;
  What what;
  bool reflects, transmits;  // both: the lobe is chosen by Fresnel
  Joint joint;               // masking of the value; V-cavities' normals are those that they show
  std::string_view source, note;
  bool visible = false;  // density and samples are those of visible normals, not of D cos

  constexpr bool HasBothLobes() const { return reflects && transmits; }
  constexpr bool HasValue() const { return what != kPdf; }
};

inline constexpr DielectricQuantity kDielectricQuantities[] = {
    {"eval", DielectricQuantity::kEval, true, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 19-21; Heitz 2014 Eq. 99", kEvalNote},
    {"eval_reflection", DielectricQuantity::kEval, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eq. 20; Heitz 2014 Eq. 99", kEvalNote},
    {"eval_transmission", DielectricQuantity::kEval, false, true, DielectricQuantity::kCorrelated, "Walter 2007 Eq. 21; Heitz 2014 Eq. 99", kEvalNote},
    {"eval_separable", DielectricQuantity::kEval, true, true, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 19-21, 23", kSeparableNote},
    {"eval_reflection_separable", DielectricQuantity::kEval, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 20, 23", kSeparableNote},
    {"eval_transmission_separable", DielectricQuantity::kEval, false, true, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 21, 23", kSeparableNote},
    {"pdf", DielectricQuantity::kPdf, true, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 24, 38, section 5.3", kPdfNote},
    {"pdf_reflection", DielectricQuantity::kPdf, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 24, 38", kPdfNote},
    {"pdf_transmission", DielectricQuantity::kPdf, false, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 17, 24, 38", kPdfNote},
    {"eval_pdf", DielectricQuantity::kEvalPdf, true, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 19-21, 24, 38; Heitz 2014 Eq. 99", kEvalPdfNote},
    {"eval_pdf_separable", DielectricQuantity::kEvalPdf, true, true, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 19-21, 23, 24, 38", kEvalPdfSeparableNote},
    {"sample", DielectricQuantity::kSample, true, true, DielectricQuantity::kCorrelated, "Walter 2007 section 5.3, Eqs. 37-41; Heitz 2014 Eq. 99", kSampleNote},
    {"sample_reflection", DielectricQuantity::kSample, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 37-39, 41; Heitz 2014 Eq. 99", kSampleLobeNote},
    {"sample_transmission", DielectricQuantity::kSample, false, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 37, 38, 40, 41; Heitz 2014 Eq. 99", kSampleLobeNote},
    {"sample_separable", DielectricQuantity::kSample, true, true, DielectricQuantity::kSeparable, "Walter 2007 section 5.3, Eqs. 23, 37-41", kSampleNote},
    {"sample_reflection_separable", DielectricQuantity::kSample, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 23, 37-39, 41", kSampleLobeNote},
    {"sample_transmission_separable", DielectricQuantity::kSample, false, true, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 23, 37, 38, 40, 41", kSampleLobeNote},
    {"pdf_visible", DielectricQuantity::kPdf, true, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 17, section 5.3; Heitz 2014 Eq. 16", kPdfVisibleNote, true},
    {"pdf_visible_reflection", DielectricQuantity::kPdf, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eq. 14; Heitz 2014 Eq. 16", kPdfVisibleNote, true},
    {"pdf_visible_transmission", DielectricQuantity::kPdf, false, true, DielectricQuantity::kCorrelated, "Walter 2007 Eq. 17; Heitz 2014 Eq. 16", kPdfVisibleNote, true},
    {"eval_pdf_visible", DielectricQuantity::kEvalPdf, true, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 17, 19-21; Heitz 2014 Eqs. 16, 99", "eval and pdf_visible in one call.", true},
    {"eval_pdf_visible_separable", DielectricQuantity::kEvalPdf, true, true, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 14, 17, 19-21, 23; Heitz 2014 Eq. 16", "eval_separable and pdf_visible in one call.", true},
    {"sample_visible", DielectricQuantity::kSample, true, true, DielectricQuantity::kCorrelated, "Walter 2007 section 5.3, Eqs. 37, 39, 40; Heitz 2014 Eqs. 16, 99", kSampleVisibleLobesNote, true},
    {"sample_visible_reflection", DielectricQuantity::kSample, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 39; Heitz 2014 Eqs. 16, 99", kSampleVisibleLobeNote, true},
    {"sample_visible_transmission", DielectricQuantity::kSample, false, true, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 17, 40; Heitz 2014 Eqs. 16, 99", kSampleVisibleLobeNote, true},
    {"sample_visible_separable", DielectricQuantity::kSample, true, true, DielectricQuantity::kSeparable, "Walter 2007 section 5.3, Eqs. 23, 37, 39, 40; Heitz 2014 Eq. 16", kSampleVisibleLobesNote, true},
    {"sample_visible_reflection_separable", DielectricQuantity::kSample, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 14, 23, 39; Heitz 2014 Eq. 16", kSampleVisibleLobeNote, true},
    {"sample_visible_transmission_separable", DielectricQuantity::kSample, false, true, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 17, 23, 40; Heitz 2014 Eq. 16", kSampleVisibleLobeNote, true},
};

// What a facet of an opaque surface reflects, by its place in kReflectors.
enum class Reflector { kMirror, kConductor, kSchlick };

struct ReflectorRow {
  std::string_view id;          // of the family over GGX
  std::string_view parameters;  // behind those of the distribution
  std::string_view source;      // its reflectance
};

inline constexpr ReflectorRow kReflectors[] = {
    {"rough_mirror", "", "F = 1"},
    {"rough_conductor", " n kappa", "F as fresnel.conductor"},
    {"rough_schlick", " f0", "F as fresnel.schlick"},
};
inline constexpr std::size_t kNumReflectors = std::size(kReflectors);

// What opaque surfaces give over each distribution of normals; those of visible normals, which stand last, only where the
// distribution has them. The density alone is rough_dielectric's pdf_reflection, or the distribution's
// pdf_visible_reflection.
inline constexpr DielectricQuantity kReflectorQuantities[] = {
    {"eval", DielectricQuantity::kEval, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eq. 20; Heitz 2014 Eq. 99", kReflectorNote},
    {"eval_separable", DielectricQuantity::kEval, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 20, 23", kSeparableNote},
    {"eval_pdf", DielectricQuantity::kEvalPdf, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 20, 24, 38; Heitz 2014 Eq. 99", "eval and the density with which sample finds wo, in one call."},
    {"eval_pdf_separable", DielectricQuantity::kEvalPdf, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 14, 20, 23, 24, 38", kEvalPdfSeparableNote},
    {"sample", DielectricQuantity::kSample, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 37-39, 41; Heitz 2014 Eq. 99", kReflectorSampleNote},
    {"sample_separable", DielectricQuantity::kSample, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 23, 37-39, 41", kReflectorSampleNote},
    {"eval_v_cavity", DielectricQuantity::kEval, true, false, DielectricQuantity::kVCavity, "Walter 2007 Eq. 20; Kelemen 2001 Eq. 1; Heitz 2014 Eq. 49", kVCavityNote},
    {"eval_pdf_v_cavity", DielectricQuantity::kEvalPdf, true, false, DielectricQuantity::kVCavity, "Walter 2007 Eqs. 14, 20; Heitz 2014 Eqs. 16, 49", "eval_v_cavity and the density with which sample_v_cavity finds wo, in one call."},
    {"sample_v_cavity", DielectricQuantity::kSample, true, false, DielectricQuantity::kVCavity, "Heitz and d'Eon 2014; Walter 2007 Eqs. 14, 39; Heitz 2014 Eqs. 16, 49", kSampleVCavityReflectionNote},
    {"eval_kelemen", DielectricQuantity::kEval, true, false, DielectricQuantity::kKelemen, "Kelemen 2001 Eq. 3", kKelemenNote},
    {"eval_pdf_kelemen", DielectricQuantity::kEvalPdf, true, false, DielectricQuantity::kKelemen, "Kelemen 2001 Eqs. 3, 9; Walter 2007 Eqs. 14, 24, 38", "eval_kelemen and the density with which sample_kelemen finds wo, in one call."},
    {"sample_kelemen", DielectricQuantity::kSample, true, false, DielectricQuantity::kKelemen, "Kelemen 2001 section 2.1.4; Walter 2007 Eqs. 14, 37, 39", kSampleKelemenNote},
    {"eval_pdf_visible", DielectricQuantity::kEvalPdf, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 20; Heitz 2014 Eqs. 16, 99", "eval and the density with which sample_visible finds wo, in one call.", true},
    {"eval_pdf_visible_separable", DielectricQuantity::kEvalPdf, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 14, 20, 23; Heitz 2014 Eq. 16", "eval_separable and the density with which sample_visible finds wo, in one call.", true},
    {"sample_visible", DielectricQuantity::kSample, true, false, DielectricQuantity::kCorrelated, "Walter 2007 Eqs. 14, 39; Heitz 2014 Eqs. 16, 99", kReflectorSampleVisibleNote, true},
    {"sample_visible_separable", DielectricQuantity::kSample, true, false, DielectricQuantity::kSeparable, "Walter 2007 Eqs. 14, 23, 39; Heitz 2014 Eq. 16", kReflectorSampleVisibleNote, true},
};

// What scatters light within a facet, by its place in kScatterers.
enum class Scatterer { kLambertian, kInterfaced };

struct ScattererRow {
  std::string_view id;          // of the family over GGX
  std::string_view parameters;  // behind those of the distribution
  std::string_view source;
  std::string_view note;   // of eval
  std::size_t quantities;  // how many of kDiffuseQuantities it gives
};

inline constexpr ScattererRow kScatterers[] = {
    {"rough_diffuse", "", "Heitz 2014 Eq. 31", kDiffuseNote, 6},
    {"interfaced_body", " n_i k", "Meneveaux 2015 Eq. 12", kInterfacedNote, 8},
};
inline constexpr std::size_t kNumScatterers = std::size(kScatterers);

// What facets that scatter give over each distribution that is a stretch of a radial one; what only interfaced ones do
// stands last.
inline constexpr DielectricQuantity kDiffuseQuantities[] = {
    {"eval", DielectricQuantity::kEval, true, false, DielectricQuantity::kCorrelated, "Heitz 2014 Eq. 99", ""},
    {"eval_separable", DielectricQuantity::kEval, true, false, DielectricQuantity::kSeparable, "Heitz 2014 Eq. 98", kDiffuseSeparableNote},
    {"eval_one_normal", DielectricQuantity::kEvalNormal, true, false, DielectricQuantity::kCorrelated, "Meneveaux 2015 Eq. 28; Heitz 2014 Eq. 99", kOneNormalNote},
    {"eval_one_normal_separable", DielectricQuantity::kEvalNormal, true, false, DielectricQuantity::kSeparable, "Meneveaux 2015 Eq. 28; Heitz 2014 Eq. 98", kOneNormalNote},
    {"eval_one_visible_normal", DielectricQuantity::kEvalNormal, true, false, DielectricQuantity::kCorrelated, "Meneveaux 2015 Eq. 28; Heitz 2014 Eqs. 16, 99", kOneVisibleNormalNote, true},
    {"eval_one_visible_normal_separable", DielectricQuantity::kEvalNormal, true, false, DielectricQuantity::kSeparable, "Meneveaux 2015 Eq. 28; Heitz 2014 Eqs. 16, 98", kOneVisibleNormalNote, true},
    {"pdf_with_interface", DielectricQuantity::kPdf, true, false, DielectricQuantity::kCorrelated, "Meneveaux 2015 section 4, R_s and R_b; Walter 2007 Eq. 14; Heitz 2014 Eq. 16", kPdfWithInterfaceNote, true},
    {"sample_with_interface", DielectricQuantity::kSample, true, false, DielectricQuantity::kCorrelated, "Meneveaux 2015 section 4, R_s and R_b; Walter 2007 Eq. 39; Heitz 2014 Eqs. 16, 99", kSampleWithInterfaceNote, true},
};
inline constexpr std::size_t kNumDiffuseQuantities = std::size(kDiffuseQuantities);

// Means over visible normals for each distribution that is a stretch of a radial one: of a reflectance, by the parameters that
// stand behind the distribution's, or what stands for it at one cosine.
struct MeanFresnelQuantity {
  enum What { kDielectric, kConductor, kSchlick, kCosine };
  std::string_view name, parameters, source;
};

// By MeanFresnelQuantity::What.
inline constexpr MeanFresnelQuantity kMeanFresnelQuantities[] = {
    {"dielectric", " eta", "F as fresnel.dielectric"},
    {"conductor", " n kappa", "F as fresnel.conductor"},
    {"schlick", " f0", "F as fresnel.schlick"},
    {"cosine", "", "F as fresnel.schlick"},
};
inline constexpr std::size_t kNumMeanFresnelQuantities = std::size(kMeanFresnelQuantities);

// A distribution of normals in the models over it; without bounds it has none of a model.
struct ModelFamily {
  std::string_view suffix;      // of the models' ids, before the '.'
  std::string_view parameters;  // of the distribution
  std::string_view source;      // its equations
  // NOLINTBEGIN(readability-redundant-member-init): rows may leave them out
  Bounds value{};               // values and densities that transmit
  Bounds eval_reflection{}, pdf_reflection{}, sample{};
  Bounds reflector_value[kNumReflectors]{}, reflector_sample[kNumReflectors]{};
  Bounds reflector_sample_v_cavity[kNumReflectors]{}, reflector_sample_visible[kNumReflectors]{},
      sample_visible{}, diffuse[kNumScatterers]{}, one_normal[kNumScatterers]{}, pdf_with_interface{}, sample_with_interface{};
  Bounds mean_fresnel[kNumMeanFresnelQuantities]{};
  // NOLINTEND(readability-redundant-member-init)

  constexpr const Bounds& BoundsOf(const DielectricQuantity& q) const {
    return q.what == DielectricQuantity::kSample ? (q.visible ? sample_visible : sample)
           : q.transmits                         ? value
           : q.what == DielectricQuantity::kPdf  ? pdf_reflection
                                                 : eval_reflection;
  }
};

// Values in double lanes: cosines and g^2 are left with a relative error of 2^-32 where they cancel, next to the critical
// angle and where a facet is seen edge-on. Samples, fast: the normal is within 2^-13, which refraction magnifies.
inline constexpr ModelFamily kModelFamilies[] = {
    {"", "alpha_x alpha_y", "GGX: Walter 2007 Eqs. 33-36, stretched",
     {1, 20, 6500, 24, 0x1p21}, {1, 18, 6500, 24, 0x1p14}, {1, 14, 2400, 20, 40}, {1, 24, 6500, 32, 17},
     {{1, 14, 2900, 20, 250}, {1, 23, 5000, 24, 250}, {1, 17, 5600, 22, 4000}},
     {{1, 14, 450, 16, 13}, {1, 14, 1000, 16, 13}, {1, 14, 450, 16, 13}},
     {{1, 16, 2800, 24, 4000}, {1, 16, 2800, 24, 4000}, {1, 16, 2800, 24, 4000}},
     {{1, 24, 2800, 32, 24}, {1, 24, 3400, 32, 60}, {1, 24, 2800, 32, 24}}, {1, 24, 6500, 32, 24},
     {{1, 14, 4200, 14, 256}, {1, 20, 4200, 24, 256}}, {{1, 14, 4200, 14, 256}, {1, 24, 4200, 28, 256}}, {1, 14, 4200, 20, 4096}, {1, 1, 1, 1, 0x1p15},
     {{1, 24, 3600, 36, 256}, {1, 30, 4400, 64, 256}, {1, 24, 1200, 24, 64}, {1, 1, 64, 1, 40}}},
    {"_beckmann", "alpha_x alpha_y", "Beckmann: Walter 2007 Eqs. 25, 26, 28, 29, stretched",
     {1, 19, 6500, 24, 0x1p21}, {1, 18, 6500, 24, 0x1p14}, {1, 14, 2400, 20, 4800}, {1, 24, 6500, 32, 17},
     {{1, 14, 3400, 20, 4096}, {1, 24, 5800, 24, 4500}, {1, 17, 6500, 22, 4800}},
     {{1, 14, 450, 16, 13}, {1, 14, 1000, 16, 13}, {1, 14, 450, 16, 13}},
     {{1, 16, 2800, 24, 4000}, {1, 16, 2800, 24, 4000}, {1, 16, 2800, 24, 4000}},
     {{1, 18, 2800, 20, 26}, {1, 18, 2800, 20, 40}, {1, 18, 2800, 20, 26}}, {1, 24, 6500, 32, 24},
     {{1, 14, 4200, 14, 512}, {1, 20, 4200, 24, 512}}, {{1, 14, 4200, 14, 512}, {1, 24, 4200, 28, 512}}, {1, 14, 4200, 20, 4800}, {1, 1, 1, 1, 0x1p18},
     {{1, 40, 4400, 40, 256}, {1, 30, 4600, 64, 256}, {1, 40, 1200, 40, 64}, {1, 1, 32, 1, 16}}},
    {"_phong", "exponent", "Phong: Walter 2007 Eqs. 27, 30-32",
     {1, 21, 6500, 24, 0x1p21}, {1, 20, 6500, 24, 0x1p14}, {1, 14, 2400, 20, 4200}, {1, 24, 4600, 32, 17},
     {{1, 15, 4500, 20, 4800}, {1, 24, 7000, 24, 4800}, {1, 17, 7000, 22, 4800}},
     {{1, 6, 2700, 8, 6}, {1, 6, 2700, 8, 6}, {1, 6, 2700, 8, 6}},
     {{1, 16, 2800, 24, 4000}, {1, 16, 2800, 24, 4000}, {1, 16, 2800, 24, 4000}}},
    {"_student_t", "gamma alpha_x alpha_y", "Student-T: d'Eon 2023; Burley 2012"},
    {"_tabulated", "alpha_x alpha_y", "tabulated slopes: Heitz 2014 Eqs. 65, 73"},
};
// clang-format on

inline constexpr std::size_t kNumComponentKernels = std::size(kComponentKernels);
inline constexpr std::size_t kNumModelFamilies = std::size(kModelFamilies);
static_assert(kNumModelFamilies == std::size(kNormalFamilies), "both have a row for each of Normals");
inline constexpr std::size_t kNumNormalRows = std::size(kNormalRows);

constexpr std::size_t CountNormalKernels() {
  std::size_t count = 0;
  for (const NormalRow& row : kNormalRows) {
    for (std::size_t r = 0; r < kNumRoughnesses; ++r) count += row.Takes(r) ? 1 : 0;
  }
  return count;
}
inline constexpr std::size_t kNumNormalKernels = CountNormalKernels();

// How many of a model's quantities a distribution gives.
template <std::size_t kSize>
constexpr std::size_t CountQuantities(const DielectricQuantity (&quantities)[kSize], Normals normals) {
  std::size_t count = 0;
  for (const DielectricQuantity& q : quantities) count += !q.visible || HasVisibleNormals(normals) ? 1 : 0;
  return count;
}
constexpr std::size_t NumDielectricQuantities(Normals normals) {
  return kModelFamilies[static_cast<std::size_t>(normals)].value.high > 0
             ? CountQuantities(kDielectricQuantities, normals)
             : 0;
}
constexpr std::size_t NumReflectorQuantities(Normals normals) {
  return kModelFamilies[static_cast<std::size_t>(normals)].reflector_value[0].high > 0
             ? CountQuantities(kReflectorQuantities, normals)
             : 0;
}
constexpr std::size_t NumReflectorKernels(Normals normals) {
  return kNumReflectors * NumReflectorQuantities(normals);
}
// The first kernel of each scatterer over one distribution, and the end of the last.
constexpr auto MakeFirstScattererKernels() {
  std::array<std::size_t, kNumScatterers + 1> first{};
  for (std::size_t i = 0; i < kNumScatterers; ++i) first[i + 1] = first[i] + kScatterers[i].quantities;
  return first;
}
inline constexpr auto kFirstScattererKernels = MakeFirstScattererKernels();
constexpr std::size_t NumDiffuseKernels(Normals normals) {
  return kModelFamilies[static_cast<std::size_t>(normals)].diffuse[0].high > 0
             ? kFirstScattererKernels[kNumScatterers]
             : 0;
}
constexpr std::size_t NumMeanFresnelKernels(Normals normals) {
  return kModelFamilies[static_cast<std::size_t>(normals)].mean_fresnel[0].high > 0
             ? kNumMeanFresnelQuantities
             : 0;
}

// The first of a model's kernels over each distribution, from `first` on, and the end of the last.
using FirstKernels = std::array<std::size_t, kNumModelFamilies + 1>;
constexpr FirstKernels MakeFirstKernels(std::size_t first, std::size_t (*count)(Normals)) {
  FirstKernels all{first};
  for (std::size_t i = 0; i < kNumModelFamilies; ++i) all[i + 1] = all[i] + count(static_cast<Normals>(i));
  return all;
}
constexpr std::size_t FamilyOf(std::size_t kernel, const FirstKernels& first) {
  std::size_t family = kNumModelFamilies - 1;
  while (kernel < first[family]) --family;
  return family;
}

// Component kernels, then distributions of normals, then rough dielectrics, then opaque surfaces, then
// ones of facets that scatter, then means over visible normals.
inline constexpr std::size_t kFirstDielectricKernel = kNumComponentKernels + kNumNormalKernels;
inline constexpr FirstKernels kFirstDielectricKernels =
    MakeFirstKernels(kFirstDielectricKernel, NumDielectricQuantities);
inline constexpr std::size_t kFirstReflectorKernel = kFirstDielectricKernels[kNumModelFamilies];
inline constexpr FirstKernels kFirstReflectorKernels =
    MakeFirstKernels(kFirstReflectorKernel, NumReflectorKernels);
inline constexpr std::size_t kFirstDiffuseKernel = kFirstReflectorKernels[kNumModelFamilies];
inline constexpr FirstKernels kFirstDiffuseKernels = MakeFirstKernels(kFirstDiffuseKernel, NumDiffuseKernels);
inline constexpr std::size_t kFirstMeanFresnelKernel = kFirstDiffuseKernels[kNumModelFamilies];
inline constexpr FirstKernels kFirstMeanFresnelKernels =
    MakeFirstKernels(kFirstMeanFresnelKernel, NumMeanFresnelKernels);
inline constexpr std::size_t kNumKernels = kFirstMeanFresnelKernels[kNumModelFamilies];
inline constexpr std::size_t kNumDielectricKernels = kFirstReflectorKernel - kFirstDielectricKernel;
inline constexpr std::size_t kNumReflectorKernels = kFirstDiffuseKernel - kFirstReflectorKernel;
inline constexpr std::size_t kNumDiffuseKernels = kFirstMeanFresnelKernel - kFirstDiffuseKernel;
inline constexpr std::size_t kNumMeanFresnelKernels = kNumKernels - kFirstMeanFresnelKernel;
inline constexpr std::size_t kMaxInputs = 13;
inline constexpr std::size_t kMaxOutputs = 6;

// A model's kernel: its distribution of normals and place in the model's quantities.
struct ModelKernelPlace {
  Normals normals;
  std::size_t quantity;
};
constexpr std::size_t ModelKernel(const FirstKernels& first, Normals normals, std::size_t quantity) {
  return first[static_cast<std::size_t>(normals)] + quantity;
}
constexpr ModelKernelPlace PlaceOfModelKernel(const FirstKernels& first, std::size_t kernel) {
  const std::size_t family = FamilyOf(kernel, first);
  return {static_cast<Normals>(family), kernel - first[family]};
}

// By kDielectricQuantities and kMeanFresnelQuantities.
constexpr std::size_t DielectricKernel(Normals normals, std::size_t quantity) {
  return ModelKernel(kFirstDielectricKernels, normals, quantity);
}
constexpr ModelKernelPlace PlaceOfDielectricKernel(std::size_t kernel) {
  return PlaceOfModelKernel(kFirstDielectricKernels, kernel);
}
constexpr std::size_t MeanFresnelKernel(Normals normals, std::size_t quantity) {
  return ModelKernel(kFirstMeanFresnelKernels, normals, quantity);
}
constexpr ModelKernelPlace PlaceOfMeanFresnelKernel(std::size_t kernel) {
  return PlaceOfModelKernel(kFirstMeanFresnelKernels, kernel);
}

// An opaque surface's kernel: its distribution of normals, reflectance and place in kReflectorQuantities.
struct ReflectorKernelPlace {
  Normals normals;
  Reflector reflector;
  std::size_t quantity;
};
constexpr std::size_t ReflectorKernel(const ReflectorKernelPlace& place) {
  return kFirstReflectorKernels[static_cast<std::size_t>(place.normals)] +
         static_cast<std::size_t>(place.reflector) * NumReflectorQuantities(place.normals) + place.quantity;
}
constexpr ReflectorKernelPlace PlaceOfReflectorKernel(std::size_t kernel) {
  const auto [normals, i] = PlaceOfModelKernel(kFirstReflectorKernels, kernel);
  const std::size_t count = NumReflectorQuantities(normals);
  return {normals, static_cast<Reflector>(i / count), i % count};
}

// A kernel of facets that scatter: its distribution of normals, scatterer and place in kDiffuseQuantities.
struct DiffuseKernelPlace {
  Normals normals;
  Scatterer scatterer;
  std::size_t quantity;
};
constexpr std::size_t DiffuseKernel(const DiffuseKernelPlace& place) {
  return ModelKernel(kFirstDiffuseKernels, place.normals,
                     kFirstScattererKernels[static_cast<std::size_t>(place.scatterer)] + place.quantity);
}
constexpr DiffuseKernelPlace PlaceOfDiffuseKernel(std::size_t kernel) {
  const auto [normals, i] = PlaceOfModelKernel(kFirstDiffuseKernels, kernel);
  std::size_t scatterer = kNumScatterers - 1;
  while (i < kFirstScattererKernels[scatterer]) --scatterer;
  return {normals, static_cast<Scatterer>(scatterer), i - kFirstScattererKernels[scatterer]};
}

// A kernel of a distribution of normals: its place in kNormalRows, and its kind of roughness.
struct NormalKernelPlace {
  std::size_t row = kNumNormalRows;
  RoughnessKind roughness = RoughnessKind::kAnisotropic;
};

constexpr auto MakeNormalKernelPlaces() {
  std::array<NormalKernelPlace, kNumNormalKernels> places{};
  std::size_t i = 0;
  for (std::size_t row = 0; row < kNumNormalRows; ++row) {
    for (std::size_t r = 0; r < kNumRoughnesses; ++r) {
      if (kNormalRows[row].Takes(r)) places[i++] = {row, static_cast<RoughnessKind>(r)};
    }
  }
  return places;
}
// In the order of kKernels, from kNumComponentKernels on.
inline constexpr auto kNormalKernelPlaces = MakeNormalKernelPlaces();

// Index into kKernels, or kNumKernels where the distribution does not give the quantity for that roughness.
constexpr std::size_t NormalKernel(Normals normals, NormalQuantity::What what, RoughnessKind roughness) {
  for (std::size_t i = 0; i < kNumNormalKernels; ++i) {
    const NormalKernelPlace& place = kNormalKernelPlaces[i];
    const NormalRow& row = kNormalRows[place.row];
    if (row.normals == normals && row.what == what && place.roughness == roughness) {
      return kNumComponentKernels + i;
    }
  }
  return kNumKernels;
}

// Index into kReflectorQuantities, or their number if there is none.
constexpr std::size_t FindReflectorQuantity(DielectricQuantity::What what, DielectricQuantity::Joint joint,
                                            bool visible = false) {
  std::size_t i = 0;
  for (const DielectricQuantity& q : kReflectorQuantities) {
    if (q.what == what && q.joint == joint && q.visible == visible) break;
    ++i;
  }
  return i;
}

// Index into kDielectricQuantities, or their number if there is none.
constexpr std::size_t FindDielectricQuantity(DielectricQuantity::What what, bool reflects, bool transmits,
                                             DielectricQuantity::Joint joint, bool visible = false) {
  std::size_t i = 0;
  for (const DielectricQuantity& q : kDielectricQuantities) {
    if (q.what == what && q.reflects == reflects && q.transmits == transmits && q.joint == joint &&
        q.visible == visible) {
      break;
    }
    ++i;
  }
  return i;
}

// Index into kDiffuseQuantities, or their number if there is none.
constexpr std::size_t FindDiffuseQuantity(DielectricQuantity::What what, DielectricQuantity::Joint joint,
                                          bool visible = false) {
  std::size_t i = 0;
  for (const DielectricQuantity& q : kDiffuseQuantities) {
    if (q.what == what && q.joint == joint && q.visible == visible) break;
    ++i;
  }
  return i;
}

// Text joined at compile time.
class JoinedText {
 public:
  constexpr JoinedText() = default;
  template <class... Parts>
  constexpr explicit JoinedText(Parts... parts) {
    (Append(parts), ...);
  }
  constexpr std::string_view view() const { return {text_, size_}; }

 private:
  constexpr void Append(std::string_view part) {
    for (const char c : part) text_[size_++] = c;
  }

  char text_[160] = {};
  std::size_t size_ = 0;
};

struct NormalText {
  JoinedText id, inputs;
};

constexpr auto MakeNormalText() {
  std::array<NormalText, kNumNormalKernels> text{};
  for (std::size_t i = 0; i < kNumNormalKernels; ++i) {
    const NormalRow& row = kNormalRows[kNormalKernelPlaces[i].row];
    const RoughnessRow& kind = kRoughnesses[static_cast<std::size_t>(kNormalKernelPlaces[i].roughness)];
    const NormalFamily& family = kNormalFamilies[static_cast<std::size_t>(row.normals)];
    text[i] = {JoinedText(family.id, ".", row.name, kind.suffix),
               row.what == NormalQuantity::kOwn
                   ? JoinedText(row.own_inputs)
                   : JoinedText(kNormalQuantities[row.what].lanes, " | ", family.own, kind.parameters, family.table)};
  }
  return text;
}
inline constexpr auto kNormalText = MakeNormalText();

struct ModelText {
  JoinedText id, inputs, source;
};

// id: of the family over GGX; parameters: the model's own, behind the distribution's; sample: what its sampler takes, where
// that is not as of others.
constexpr ModelText MakeModelText(std::string_view id, std::string_view parameters, std::string_view source,
                                  const ModelFamily& family, const DielectricQuantity& q,
                                  std::string_view sample = {}) {
  const std::string_view lanes = q.what == DielectricQuantity::kEvalNormal ? "wix wiy wiz wox woy woz mx my mz"
                                 : q.what != DielectricQuantity::kSample   ? "wix wiy wiz wox woy woz"
                                 : !sample.empty()                         ? sample
                                 : q.HasBothLobes() || q.joint == DielectricQuantity::kVCavity
                                     ? "wix wiy wiz u1 u2 u3"
                                     : "wix wiy wiz u1 u2";
  return {JoinedText(id, family.suffix, ".", q.name), JoinedText(lanes, " | ", family.parameters, parameters),
          JoinedText(q.source, source, "; ", family.source)};
}

constexpr auto MakeDielectricText() {
  std::array<ModelText, kNumDielectricKernels> text{};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const ModelKernelPlace place = PlaceOfDielectricKernel(kFirstDielectricKernel + i);
    text[i] =
        MakeModelText("rough_dielectric", " eta", "", kModelFamilies[static_cast<std::size_t>(place.normals)],
                      kDielectricQuantities[place.quantity]);
  }
  return text;
}
inline constexpr auto kDielectricText = MakeDielectricText();

constexpr auto MakeReflectorText() {
  std::array<ModelText, kNumReflectorKernels> text{};
  for (std::size_t i = 0; i < kNumReflectorKernels; ++i) {
    const ReflectorKernelPlace place = PlaceOfReflectorKernel(kFirstReflectorKernel + i);
    const ReflectorRow& reflector = kReflectors[static_cast<std::size_t>(place.reflector)];
    text[i] = MakeModelText(reflector.id, reflector.parameters, JoinedText("; ", reflector.source).view(),
                            kModelFamilies[static_cast<std::size_t>(place.normals)],
                            kReflectorQuantities[place.quantity]);
  }
  return text;
}
inline constexpr auto kReflectorText = MakeReflectorText();

constexpr auto MakeDiffuseText() {
  std::array<ModelText, kNumDiffuseKernels> text{};
  for (std::size_t i = 0; i < kNumDiffuseKernels; ++i) {
    const DiffuseKernelPlace place = PlaceOfDiffuseKernel(kFirstDiffuseKernel + i);
    const ScattererRow& scatterer = kScatterers[static_cast<std::size_t>(place.scatterer)];
    const DielectricQuantity& q = kDiffuseQuantities[place.quantity];
    const bool sums = q.what == DielectricQuantity::kEval;
    text[i] = MakeModelText(scatterer.id, JoinedText(scatterer.parameters, sums ? " | order" : "").view(),
                            JoinedText("; ", scatterer.source).view(),
                            kModelFamilies[static_cast<std::size_t>(place.normals)], q,
                            "wix wiy wiz u1 u2 u3 u4 u5");
  }
  return text;
}
inline constexpr auto kDiffuseText = MakeDiffuseText();

constexpr auto MakeMeanFresnelText() {
  std::array<ModelText, kNumMeanFresnelKernels> text{};
  for (std::size_t i = 0; i < kNumMeanFresnelKernels; ++i) {
    const ModelKernelPlace place = PlaceOfMeanFresnelKernel(kFirstMeanFresnelKernel + i);
    const ModelFamily& family = kModelFamilies[static_cast<std::size_t>(place.normals)];
    const MeanFresnelQuantity& q = kMeanFresnelQuantities[place.quantity];
    text[i] = {JoinedText("mean_fresnel", family.suffix, ".", q.name),
               place.quantity == MeanFresnelQuantity::kCosine
                   ? JoinedText("cos_i | alpha")
                   : JoinedText("vx vy vz | ", family.parameters, q.parameters, " | order"),
               JoinedText("Heitz 2014 Eq. 105; ", q.source, "; ", family.source)};
  }
  return text;
}
inline constexpr auto kMeanFresnelText = MakeMeanFresnelText();

constexpr std::array<Kernel, kNumKernels> MakeKernels() {
  constexpr std::string_view outputs[] = {"f_cos", "pdf", "f_cos pdf", "wox woy woz weight pdf lobe", "f_cos"};
  std::array<Kernel, kNumKernels> kernels{};
  for (std::size_t i = 0; i < kNumComponentKernels; ++i) kernels[i] = kComponentKernels[i];
  for (std::size_t i = 0; i < kNumNormalKernels; ++i) {
    const NormalKernelPlace& place = kNormalKernelPlaces[i];
    const NormalRow& row = kNormalRows[place.row];
    const std::string_view outputs_of_row =
        row.what == NormalQuantity::kOwn ? row.own_outputs : kNormalQuantities[row.what].outputs;
    kernels[kNumComponentKernels + i] = {kNormalText[i].id.view(),
                                         kNormalText[i].inputs.view(),
                                         outputs_of_row,
                                         row.source,
                                         row.note,
                                         false,
                                         row.bounds[static_cast<std::size_t>(place.roughness)]};
  }
  const auto add_model = [&](std::size_t kernel, const ModelText& text, const DielectricQuantity& q,
                             bool has_transport, const Bounds& bounds) {
    kernels[kernel] = {text.id.view(), text.inputs.view(), outputs[q.what], text.source.view(),
                       q.note,         has_transport,      bounds};
  };
  for (std::size_t i = 0; i < kNumDielectricKernels; ++i) {
    const ModelKernelPlace place = PlaceOfDielectricKernel(kFirstDielectricKernel + i);
    const DielectricQuantity& q = kDielectricQuantities[place.quantity];
    add_model(kFirstDielectricKernel + i, kDielectricText[i], q, q.HasValue() && q.transmits,
              kModelFamilies[static_cast<std::size_t>(place.normals)].BoundsOf(q));
  }
  for (std::size_t i = 0; i < kNumReflectorKernels; ++i) {
    const ReflectorKernelPlace place = PlaceOfReflectorKernel(kFirstReflectorKernel + i);
    const ModelFamily& family = kModelFamilies[static_cast<std::size_t>(place.normals)];
    const std::size_t reflector = static_cast<std::size_t>(place.reflector);
    const DielectricQuantity& q = kReflectorQuantities[place.quantity];
    add_model(kFirstReflectorKernel + i, kReflectorText[i], q, false,
              q.what != DielectricQuantity::kSample     ? family.reflector_value[reflector]
              : q.joint == DielectricQuantity::kVCavity ? family.reflector_sample_v_cavity[reflector]
              : q.visible                               ? family.reflector_sample_visible[reflector]
                                                        : family.reflector_sample[reflector]);
  }
  for (std::size_t i = 0; i < kNumDiffuseKernels; ++i) {
    const DiffuseKernelPlace place = PlaceOfDiffuseKernel(kFirstDiffuseKernel + i);
    const std::size_t scatterer = static_cast<std::size_t>(place.scatterer);
    const ModelFamily& family = kModelFamilies[static_cast<std::size_t>(place.normals)];
    const DielectricQuantity& q = kDiffuseQuantities[place.quantity];
    add_model(kFirstDiffuseKernel + i, kDiffuseText[i], q, false,
              q.what == DielectricQuantity::kEval     ? family.diffuse[scatterer]
              : q.what == DielectricQuantity::kPdf    ? family.pdf_with_interface
              : q.what == DielectricQuantity::kSample ? family.sample_with_interface
                                                      : family.one_normal[scatterer]);
    if (place.quantity == 0) kernels[kFirstDiffuseKernel + i].note = kScatterers[scatterer].note;
  }
  for (std::size_t i = 0; i < kNumMeanFresnelKernels; ++i) {
    const ModelKernelPlace place = PlaceOfMeanFresnelKernel(kFirstMeanFresnelKernel + i);
    const ModelFamily& family = kModelFamilies[static_cast<std::size_t>(place.normals)];
    const bool cosine = place.quantity == MeanFresnelQuantity::kCosine;
    kernels[kFirstMeanFresnelKernel + i] = {kMeanFresnelText[i].id.view(),
                                            kMeanFresnelText[i].inputs.view(),
                                            cosine ? "cos" : "F",
                                            kMeanFresnelText[i].source.view(),
                                            cosine ? kMeanFresnelCosineNote : kMeanFresnelNote,
                                            false,
                                            family.mean_fresnel[place.quantity]};
  }
  return kernels;
}
inline constexpr std::array<Kernel, kNumKernels> kKernels = MakeKernels();

// Names of an `inputs` or `outputs` string, in order, without the '|'.
struct Names {
  std::array<std::string_view, kMaxInputs> name{};
  std::size_t count = 0;
  std::size_t per_lane = 0;  // how many stand before the first '|'
  std::size_t columns = 0;   // how many stand before a second: those that a call has arrays of
};

constexpr Names Split(std::string_view text) {
  Names names;
  int bars = 0;
  std::size_t i = 0;
  while (i < text.size()) {
    std::size_t end = i;
    while (end < text.size() && text[end] != ' ') ++end;
    const std::string_view word = text.substr(i, end - i);
    if (word == "|") {
      (bars++ == 0 ? names.per_lane : names.columns) = names.count;
    } else if (!word.empty()) {
      names.name[names.count++] = word;
    }
    i = end + 1;
  }
  if (bars < 1) names.per_lane = names.count;
  if (bars < 2) names.columns = names.count;
  return names;
}

// Whether the kernel takes an object whole.
constexpr bool TakesPrepared(std::size_t kernel) {
  const Names inputs = Split(kKernels[kernel].inputs);
  return inputs.columns < inputs.count;
}

// Index into kKernels, or kNumKernels if there is no such id.
constexpr std::size_t KernelIndex(std::string_view id) {
  std::size_t i = 0;
  while (i < kNumKernels && kKernels[i].id != id) ++i;
  return i;
}

// A table's entry for a kernel. `given` says whether there is one: comparisons of functions with null are no
// constant expressions under -fsanitize=undefined.
template <class Function>
struct KernelEntry {
  Function function = nullptr;
  bool given = false;
};
template <class Function>
using KernelTable = std::array<KernelEntry<Function>, kNumKernels>;

template <class Function>
constexpr bool HasEveryKernel(const KernelTable<Function>& table) {
  for (const KernelEntry<Function>& entry : table) {
    if (!entry.given) return false;
  }
  return true;
}

constexpr const Input& FindInput(std::string_view name) {
  std::size_t i = 0;
  while (kInputs[i].name != name) ++i;
  return kInputs[i];
}

constexpr const Output& FindOutput(std::string_view name) {
  std::size_t i = 0;
  while (kOutputs[i].name != name) ++i;
  return kOutputs[i];
}

// Whether a kernel samples a normal that is visible from a direction.
constexpr bool SamplesVisibleNormal(const Kernel& kernel) {
  return kernel.outputs == "mx my mz pdf" && kernel.inputs.substr(0, 2) == "vx";
}

// The density of a sampled direction or visible normal is a function of the random numbers through the
// geometry, so it is judged as a weight is, and so is a mean of F, whose slope has no limit at the critical
// angle; every other output has the metric of its name.
constexpr Metric MetricOf(const Kernel& kernel, std::string_view output) {
  const bool samples_direction =
      kernel.outputs.size() > 4 && kernel.outputs.substr(kernel.outputs.size() - 4) == "lobe";
  const bool depends_on_view = samples_direction || SamplesVisibleNormal(kernel);
  const bool mean = output == "F" && Split(kernel.inputs).columns < Split(kernel.inputs).count;
  return mean || (depends_on_view && output == "pdf") ? Metric::kConditioned : FindOutput(output).metric;
}

}  // namespace microlane

#endif  // MICROLANE_KERNEL_LIST_H_
