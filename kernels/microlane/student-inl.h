// Smith's Lambda of Student-T slopes, and with them of Phong, in lanes.
#if defined(MICROLANE_STUDENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_STUDENT_INL_H_
#undef MICROLANE_STUDENT_INL_H_
#else
#define MICROLANE_STUDENT_INL_H_
#endif

#include <iterator>
#include <limits>
#include <type_traits>

#include "microlane/distribution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Slopes of the density (g - 1)/pi (1 + x^2 + y^2)^-g, g = n + 3/2: those along one azimuth have C (1 +
// x^2)^-(n + 1), C = Gamma(n + 1)/(sqrt(pi) Gamma(n + 1/2)). With mu = cot(theta), Heitz 2014 Eqs. 41-43
// become
//   Lambda = C (1 + mu^2)^-n d(n) / (2 n mu),
//   d(n) = 1 - 2 n mu (1 + mu^2)^n int_mu^inf (1 + x^2)^-(n + 1) dx,
// where d is Beckmann's 1 - sqrt(pi) a erfcx(a) in the limit, a = sqrt(n) mu. Integration by parts gives
//   d(n) = (1 + 2 n w d(n + 1)) / (2 n + 1), w = 1/(1 + mu^2),
// a sum of positive terms, which magnifies no error. kShift steps of it lead to N = n + kShift, where d is
// smooth in k = 1/(N + 1/4) too, down to k = 0: d = t^2 Q, t = 1/(1 + kScale A), A = mu sqrt(w/k). Q is a
// polynomial in t - 5/16, t from its least, at mu = inf, to 1, and in x - 1/2, x = (kShift + 1/4) k.
//
// kDefect: least squares of p/Q - 1 in 113 bits over x = sin^5(pi a/2), a and t in 19 x 26 steps of
// Chebyshev's kind (25 x 34, 33 x 64), powers (i, j) with i/I + j/J <= 2 (1.3, 1.4). kGamma: so too Gamma(N)
// / (2 sqrt(pi k) Gamma(N + 1/2)), in x - 1/2.
struct StudentFast {  // relative errors 2^-14.5 and 2^-14
  static constexpr int kShift = 2;
  static constexpr double kScale = 0.4;
  static constexpr double kDefect[7][4] = {{0.217209578, 0.150393292, 0.0987570882, 0.0417568684},
                                           {0.449088842, -0.0313424282, -0.377824128, -0.258429259},
                                           {0.754174113, 0.65442729, 0.99603349, 0.443979323},
                                           {-0.207466051, -3.08073044, -2.80569959, -0.182371423},
                                           {1.29805017, 3.97307158, 4.69574976, 0.741714656},
                                           {-0.983169675, -2.95623827, -3.43400574, -2.45567536},
                                           {0.435795188, 1.22461343, 0.759591222, 1.86781514}};
  static constexpr double kGamma[] = {0.298918098, 0.0361800306, 0.00513122091};
};
struct StudentFloat {  // for float results of double lanes: 2^-25.7 and 2^-31.7
  static constexpr int kShift = 6;
  static constexpr double kScale = 0.35;
  static constexpr double kDefect[13][6] = {
      {0.137822290455, 0.0282024005702, 0.00529959934262, 0.000735241579452, -2.41926446064e-05,
       -3.01179379345e-05},
      {0.347852864126, 0.0525058113918, 0.00556936345659, 0.0020736950636, 0.00160933847676,
       0.000170916421852},
      {0.553149814828, 0.00713843502323, -0.0455755074765, -0.0399844030596, -0.01765000267,
       -0.000313747488258},
      {0.642219127176, -0.0538887649972, 0.100692234885, 0.170912272233, 0.075132755907, 0.00018752344314},
      {0.482843529403, -0.43481299476, -0.519910603143, -0.48796498362, -0.153944342302},
      {0.362838007797, 0.509718109364, 1.49756527883, 1.09092563097, 0.153378943978},
      {-0.18971144059, -1.15106435857, -2.30141895962, -1.6290767298, -0.0598571491377},
      {0.305384739528, 2.04068889782, 2.72459990794, 1.33926351428},
      {-0.487906536454, -1.94621549082, -2.78628343212, -0.451766553428},
      {0.597403412569, 1.94105744226, 1.77121409601},
      {-0.582667919527, -1.67170455665, -0.451921027068},
      {0.360696093508, 0.875909258585},
      {-0.0984395206989, -0.192853697116}};
  static constexpr double kGamma[] = {0.287880586269, 0.0118651503019, 0.000598781516521, 2.35913121535e-05,
                                      5.48175935015e-07};
};
struct StudentDouble {  // 2^-50.2, of the coefficients' rounding, and 2^-52.5
  static constexpr int kShift = 12;
  static constexpr double kScale = 0.35;
  static constexpr double kDefect[25][10] = {
      {0.13122260585298626, 0.013133167273193073, 0.0012408340941008566, 0.00010521149507050933,
       7.0862491599093188e-06, 2.1603902378732371e-07, -3.2214999744439725e-08, -8.087932094133818e-09,
       -1.7347611926577799e-09, -3.1048390008807245e-10},
      {0.3353011516565374, 0.025514513396285892, 0.0010912157591965327, -0.00010978065987119784,
       -3.6190162836012344e-05, -5.0431434500445479e-06, -1.6877502723384702e-07, 1.8293213719379667e-07,
       8.3809140092834002e-08, 1.507001984711787e-08},
      {0.54924265222287971, 0.012345390668110206, -0.0043456695125262904, -0.00089820910682955753,
       -7.4683560280756133e-05, 4.2984050446580001e-06, -8.6670818296822402e-07, -2.9684592475070878e-06,
       -1.4513564716519578e-06, -2.4185514301894096e-07},
      {0.65866712295238972, -0.04347050746629965, -0.011117650087014864, -0.00017853853011550049,
       0.0003615682808098664, 0.00012836717378365354, 6.7930070598184425e-05, 4.3341158824102061e-05,
       1.5628228141990522e-05, 1.8948590857634312e-06},
      {0.5681905168577891, -0.10880621334229867, -0.001712171523188337, 0.0042022834800509315,
       0.00032517522599242462, -0.00072860288912590632, -0.00072603832833830308, -0.00041445734388232498,
       -0.00011782972635165168, -8.5341355402125645e-06},
      {0.2990799184487466, -0.099077354566311823, 0.030568539176734653, 0.0062942684418299333,
       0.0015124230589207172, 0.0043596469543868569, 0.0047637032657056651, 0.0025986393585320654,
       0.00062534685599681828, 2.3728335283229234e-05},
      {0.011767680647902384, 0.026576934295438667, 0.038644649012410062, -0.020066831690919176,
       -0.023701149274394363, -0.026994166229885697, -0.023538002591082664, -0.01148216411990757,
       -0.0023254088503034502, -4.1544838937141315e-05},
      {-0.11526597586139258, 0.16335308044221744, -0.014100321735597538, 0.010485967019415666,
       0.08291068317741826, 0.10835471173941925, 0.085987562459857531, 0.037674853602136932,
       0.0060514935874027417, 4.4709629613022303e-05},
      {-0.058400156183670157, 0.12629215975247537, -0.1241404621740976, -0.053374245215487802,
       -0.13440465635811519, -0.23051931104245291, -0.21008128368768744, -0.093994172766462061,
       -0.010951492384762106, -2.7051893745296005e-05},
      {0.035791049246161194, -0.069820459341083385, -0.13327167720039362, -0.19365436395289318,
       -0.34309323587613283, -0.066466673165341147, 0.25495605597950505, 0.17817471459371467,
       0.013501764825434861, 7.0508016311447588e-06},
      {0.057559538434515368, 0.1011277860896499, 1.3158497840589385, 3.0020699517213334, 3.9844185780570696,
       2.5210288968300358, 0.27068387830878987, -0.25166239515671346, -0.010817507758880423},
      {-0.13367283545459657, -1.3268490074065413, -6.0057616609239473, -14.494493569142094,
       -17.797342517681745, -10.633885293870572, -1.981869383430378, 0.25534774952624834,
       0.005079755570600775},
      {0.46299163712296781, 5.1866496345265496, 21.086082181256703, 45.232241361710763, 50.854750452524868,
       27.110988097816399, 4.6835849401908369, -0.17509971833130469, -0.0010613598300632896},
      {-1.4526597471158869, -14.023703717855307, -53.583565238950165, -102.11204039829552,
       -101.62185131546261, -47.101080795190448, -6.7651415040948066, 0.072425053855991683},
      {3.280953075385574, 28.434449338051177, 98.354683633108721, 166.94262188110901, 142.87381209069864,
       55.275116887751338, 6.4703231054225281, -0.013615471851299644},
      {-5.2993020990195436, -41.516951709426706, -126.32315821167698, -185.98660181490439,
       -131.13413163013868, -38.616815965248193, -4.0301305554490652},
      {5.6669698388117942, 38.56562360841324, 97.078365500756647, 110.73270582464481, 52.091315496355968,
       5.6338405313427069, 1.4903551951013501},
      {-2.5263667551308258, -10.487377780461113, -4.7345931895279509, 31.541900293891118, 46.312435695496781,
       18.112538050614056, -0.24927208527739131},
      {-3.4606096616544701, -29.536134635209251, -92.941307984678801, -138.54170975082928,
       -94.200519442034661, -19.244012300944942},
      {8.483852712678905, 52.457179980536765, 122.98673563892429, 138.8653864699609, 75.269022005399819,
       8.7765980388225717},
      {-9.081354279595617, -44.064051001526444, -78.810253879251903, -69.030716828940697, -33.089430802369641,
       -1.622654521482588},
      {5.8745264822228487, 20.048523792626124, 20.309382350461828, 11.146709850989417, 7.4570719024301271},
      {-2.3045568669583543, -3.3281591971231026, 5.8537952850829393, 5.3740927862178358,
       -0.58313698082099374},
      {0.48370584244869691, -0.93441153817511646, -5.5110696897665701, -2.7355786677453793},
      {-0.036512342309207205, 0.37937612610742544, 1.1422584093872825, 0.31052194800710742}};
  static constexpr double kGamma[] = {0.28501040253201315,    0.0059061639331495401,  0.00015140808585946647,
                                      3.0633605076477203e-06, 3.4185509622817296e-08, 1.0043294438385295e-09,
                                      1.1689952611427206e-10, -3.5611363243691099e-13};
};

template <Accuracy A, bool kFloatResult>
using StudentFit = std::conditional_t<A == Accuracy::kFast, StudentFast,
                                      std::conditional_t<kFloatResult, StudentFloat, StudentDouble>>;

// How many coefficients stand before a row's zeros.
template <class Fit, size_t kRow>
constexpr size_t StudentTerms() {
  size_t terms = std::size(Fit::kDefect[kRow]);
  while (Fit::kDefect[kRow][terms - 1] == 0) --terms;
  return terms;
}

template <class Fit, size_t kRow, size_t kTerm = 0, class D>
HWY_INLINE Vec<D> StudentRow(D d, Vec<D> x) {
  const Vec<D> first = Const(d, Fit::kDefect[kRow][kTerm]);
  if constexpr (kTerm + 1 == StudentTerms<Fit, kRow>()) {
    return first;
  } else {
    return hn::MulAdd(StudentRow<Fit, kRow, kTerm + 1>(d, x), x, first);
  }
}

template <class Fit, size_t kRow = 0, class D>
HWY_INLINE Vec<D> StudentPolynomial(D d, Vec<D> t, Vec<D> x) {
  const Vec<D> row = StudentRow<Fit, kRow>(d, x);
  if constexpr (kRow + 1 == std::size(Fit::kDefect)) {
    return row;
  } else {
    return hn::MulAdd(StudentPolynomial<Fit, kRow + 1>(d, t, x), t, row);
  }
}

// From y = d(N) to d(n) times the product of 2 n + 1, 2 n + 3, ... 2 N - 1, and that product. v = 1 - w, for
// where w is near 1 its rounding would count in every step.
template <int kSteps, class D>
HWY_INLINE void StudentDescent(D d, Vec<D> twice_n, Vec<D> v, Vec<D>& y, Vec<D>& odd) {
  if constexpr (kSteps > 0) {
    const Vec<D> m = hn::Add(twice_n, Const(d, 2 * (kSteps - 1)));
    y = hn::MulAdd(m, hn::NegMulAdd(v, y, y), odd);
    odd = hn::MulAdd(m, odd, odd);
    StudentDescent<kSteps - 1>(d, twice_n, v, y, odd);
  }
}

// 2 n (2 n + 2) ... (2 N - 2).
template <int kSteps, class D>
HWY_INLINE Vec<D> StudentEven(D d, Vec<D> twice_n) {
  const Vec<D> m = hn::Add(twice_n, Const(d, 2 * (kSteps - 1)));
  if constexpr (kSteps == 1) {
    return m;
  } else {
    return hn::Mul(StudentEven<kSteps - 1>(d, twice_n), m);
  }
}

// d(n) = y/odd of mu = z/s, s2 = s^2 > 0; twice_n up to 2^41, and root = sqrt(N + 1/4), x as Q has it.
template <class Fit, Accuracy A, class D>
HWY_INLINE void StudentDefectFraction(D d, Vec<D>& y, Vec<D>& odd, Vec<D>& twice_n, Vec<D>& root, Vec<D>& x,
                                      Vec<D> s2, Vec<D> z, Vec<D> n) {
  constexpr double kFirst = Fit::kShift + 0.25;
  twice_n = hn::Min(hn::Add(n, n), Const(d, 0x1p41));
  const Vec<D> sum = hn::Add(n, Const(d, kFirst)), half = Const(d, 0.5);
  root = hn::Sqrt(sum);
  x = hn::Sub(hn::Div(Const(d, kFirst), sum), half);
  const Vec<D> z2 = hn::Mul(z, z), r2 = hn::MulAdd(z, z, s2), r = Sqrt<A>(d, r2);
  // An IEEE division in every accuracy, and t - 5/16 from 1 - t, whose error is that of a small A: near t = 1
  // Q takes several times the error of t.
  const Vec<D> scaled = hn::Mul(root, Const(d, Fit::kScale));
  const Vec<D> inverse = hn::Div(Const(d, 1), hn::MulAdd(scaled, z, r));
  const Vec<D> t = hn::Mul(r, inverse), u = hn::NegMulAdd(hn::Mul(scaled, z), inverse, Const(d, 0.6875));
  y = hn::Mul(hn::Mul(t, t), StudentPolynomial<Fit>(d, u, x));
  odd = Const(d, 1);
  StudentDescent<Fit::kShift>(d, twice_n, Div<A>(d, z2, r2), y, odd);
}

// d(n) of mu, by its size, and gamma = n + 3/2. Float lanes lose bits of a small mu in t.
template <bool kFloatResult>
struct StudentDefectOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& defect, Vec<D>& unused, Vec<D> mu, Vec<D> gamma) {
    Vec<D> y, odd, twice_n, root, x;
    const Vec<D> z = hn::Min(hn::Abs(mu), Const(d, 0x1p60));
    StudentDefectFraction<StudentFit<A, kFloatResult>, A>(d, y, odd, twice_n, root, x, Const(d, 1), z,
                                                          hn::Sub(gamma, Const(d, 1.5)));
    defect = unused = Div<A>(d, y, odd);
  }
};

// |v.n| Lambda = factor exp(-power), of mu = z/s, s2 = s^2 > 0.
template <class Fit, Accuracy A, class D>
HWY_INLINE void StudentLambdaFactors(D d, Vec<D>& factor, Vec<D>& power, Vec<D> s2, Vec<D> z, Vec<D> n) {
  Vec<D> y, odd, twice_n, root, x;
  StudentDefectFraction<Fit, A>(d, y, odd, twice_n, root, x, s2, z, n);
  // The odd product of d(n) has gone with that of Gamma(n)/Gamma(n + 1/2).
  const Vec<D> even = hn::Mul(StudentEven<Fit::kShift>(d, twice_n), root);
  factor = Div<A>(d, hn::Mul(y, hn::Mul(Polynomial(d, x, Fit::kGamma), hn::Sqrt(s2))), even);
  // Where mu^2 may overflow float lanes, 2^40 of it comes in as a logarithm.
  const Vec<D> z2 = hn::Mul(z, z);
  const auto far = hn::Gt(z2, hn::Mul(s2, Const(d, 0x1p100)));
  const Vec<D> nearer = hn::IfThenElse(far, hn::Mul(s2, Const(d, 0x1p40)), s2);
  const Vec<D> rest = hn::IfThenElseZero(far, Const(d, 27.725887222397812));
  power = hn::Mul(n, hn::Add(LogOnePlusRatio(d, z2, nearer), rest));
}

// Lambda of those; 0 where `flat`, along the normal.
template <Accuracy A, class D>
HWY_INLINE Vec<D> StudentLambda(D d, Vec<D> factor, Vec<D> power, Vec<D> z, hn::Mask<D> flat) {
  const Vec<D> over_z = hn::Min(hn::Div(factor, z), hn::Set(d, std::numeric_limits<T<D>>::max()));
  return ZeroIf(flat, ExpTimes<A>(d, hn::Neg(power), hn::Zero(d), over_z));
}

// Smith's masking of a policy `Dist` that gives s^2 of mu = |v.n|/s, Tangent2, and n, Order.
template <class Dist, bool kFloatResult>
struct StudentSmith {
  // |v.n| Lambda(v) = factor exp(-power), next to 0 along the normal.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void LambdaFactors(D d, Vec<D>& factor, Vec<D>& power, Vec<D> vx, Vec<D> vy, Vec<D> z,
                                       P... p) {
    // Float lanes keep s^2 from underflow where Lambda has not; nothing else depends on the scale.
    const Vec<D> scale = Const(d, kIsFloat<D> ? 0x1p30 : 1);
    const Vec<D> s2 = hn::Max(Dist::Tangent2(d, hn::Mul(vx, scale), hn::Mul(vy, scale), p...),
                              Const(d, kIsFloat<D> ? 0x1p-120 : 0x1p-1000));
    StudentLambdaFactors<StudentFit<A, kFloatResult>, A>(d, factor, power, s2, hn::Mul(z, scale),
                                                         Dist::Order(d, p...));
    factor = hn::Mul(factor, Const(d, kIsFloat<D> ? 0x1p-30 : 1));
  }

  struct LambdaOp {
    template <Accuracy A, class D, class... P>
    static HWY_INLINE void Run(D d, Vec<D>& lambda, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
      Vec<D> factor, power;
      const Vec<D> z = hn::Abs(CosineOf<Dist>(d, vx, vy, vz, p...));
      LambdaFactors<A>(d, factor, power, vx, vy, z, p...);
      const auto flat = hn::Eq(hn::Add(hn::Abs(vx), hn::Abs(vy)), hn::Zero(d));
      lambda = unused = StudentLambda<A>(d, factor, power, z, flat);
    }
  };

  template <Care, Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    Vec<D> factor, power;
    LambdaFactors<A>(d, factor, power, vx, vy, z, p...);
    return hn::Add(z, ExpTimes<A>(d, hn::Neg(power), hn::Zero(d), hn::Add(factor, factor)));
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_STUDENT_INL_H_
