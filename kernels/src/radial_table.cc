#include "microlane/radial_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <string>

#include "src/legendre.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;
// Cells up to r and a of 2^12, and sqrt(y) = 6.25, where the numbers below 1 end at 6.07.
constexpr std::size_t kOctave = std::size_t{1} << RadialCurve::kCellBits;
constexpr std::size_t kMost = 12 * kOctave, kMostQuantile = 2 * kOctave + 26;
// Rows up to t = 2^6, and cells up to x = 43, which 2^-62 of the slopes are beyond.
constexpr std::size_t kRowCells = 12, kRows = 3 * kRowCells + 1, kAcrossCells = 43;
constexpr double kNegligible = 1e-30, kGone = 1e-300;
constexpr double kRare = 1e-12;  // what of samples is not asked for their density
constexpr double kLargestError = 0.01, kLargestSamplingError = 0.1;
constexpr double kLeastPower = 3.05;
constexpr std::array<double, 4> kParts{0, 0.25, 0.75, 1};

// Of cells, 2^bits to an octave: where cell j begins, and its width.
double CellBegin(std::size_t j, std::size_t bits = RadialCurve::kCellBits) {
  const std::size_t part = j & ((std::size_t{1} << bits) - 1);
  return std::ldexp(1 + std::ldexp(static_cast<double>(part), -static_cast<int>(bits)),
                    static_cast<int>(j >> bits)) -
         1;
}
double CellWidth(std::size_t j, std::size_t bits = RadialCurve::kCellBits) {
  return std::ldexp(1.0, static_cast<int>(j >> bits) - static_cast<int>(bits));
}

// The cubic through values at kParts: neighbours meet at their ends.
void PutCubic(const std::array<double, 4>& at, double* c) {
  const double a = at[1] - at[0], b = at[2] - at[0], e = at[3] - at[0];
  c[0] = at[0];
  c[1] = 8 * a - 8.0 / 3 * b + e;
  c[2] = (-56 * a + 40 * b - 16 * e) / 3;
  c[3] = (32 * (a - b) + 16 * e) / 3;
}
// The cubic of values and slopes, by p, at both ends.
void PutHermite(double value0, double slope0, double value1, double slope1, double* c) {
  c[0] = value0;
  c[1] = slope0;
  c[2] = 3 * (value1 - value0) - 2 * slope0 - slope1;
  c[3] = 2 * (value0 - value1) + slope0 + slope1;
}
double Cubic(const double* c, double p) { return c[0] + p * (c[1] + p * (c[2] + p * c[3])); }
double CubicSlope(const double* c, double p) { return c[1] + p * (2 * c[2] + p * 3 * c[3]); }

// g(x) of a curve.
double CurveAt(const RadialCurve& curve, double x) {
  if (!(1 + x < 1 + curve.end)) return curve.tail_value + curve.tail_slope * std::log(x / curve.end);
  int exponent = 0;
  const double part = (2 * std::frexp(1 + x, &exponent) - 1) * kOctave, whole = std::floor(part);
  const std::size_t cell = static_cast<std::size_t>(exponent - 1) * kOctave + static_cast<std::size_t>(whole);
  return Cubic(curve.cells + 4 * cell, part - whole);
}

// 1 - atan(x)/x.
double AtanDefect(double x) {
  if (x > 0.25) return 1 - std::atan(x) / x;
  const double x2 = x * x;
  double sum = 0;
  for (int k = 10; k > 0; --k) sum = (1.0 / (2 * k + 1) - sum) * x2;
  return sum;
}

// Where log(F) reaches a value, F falling on [0, 1] from above it to below it: Newton's steps, or halves of
// what is left. f: F and its slope.
template <class F>
double FindFall(double value, const F& f) {
  double low = 0, high = 1, p = 0.5;
  for (int step = 0; step < 60; ++step) {
    const auto [at, slope] = f(p);
    (std::log(at) > value ? low : high) = p;
    double next = p - (std::log(at) - value) * at / slope;
    if (!(next >= low && next <= high)) next = (low + high) / 2;
    if (std::abs(next - p) < 1e-15) return next;
    p = next;
  }
  return p;
}

struct ValueSlope {
  double value, slope;
};

std::string Message(const char* format, double a, double b, double c) {
  char text[160];
  std::snprintf(text, sizeof text, format, a, b, c);
  return text;
}

}  // namespace

class RadialTable::Builder {
 public:
  Builder(RadialTable& table, const std::function<double(double)>& f) : table_(table), f_(f) {}

  // Empty, or what is wrong.
  std::string Run() {
    // Room for all, so that what points into them stays.
    table_.cells_.reserve(4 * (2 * kMost + kMostQuantile + kRows * kAcrossCells) + 2 * RadialEntries::kNodes);
    if (!MakeDensity() || !Normalise()) return error_;
    MakeQuantile();
    MakeMasking();
    MakeAcross();
    const double off = std::max(table_.sampling_error_, table_.visible_sampling_error_);
    if (off > kLargestSamplingError) {
      Fail(Message("f does not vary about r = 1: samples of it are off by %.2g %%, must be within 10 %%",
                   100 * off, 0, 0));
    }
    return error_;
  }

 private:
  // Appends cells of g(x) until one has a node where `last` is met: g has no value there. The slope at its
  // end goes on. Largest error found in the middle of cells where g is more than `least`.
  template <class G, class Last>
  double Append(RadialCurve& curve, std::size_t most, double least, const G& g, const Last& last) {
    std::vector<double>& cells = table_.cells_;
    const std::size_t first = cells.size();
    double error = 0, begin = g(0);
    std::size_t j = 0;
    for (; j < most; ++j) {
      const double x = CellBegin(j), width = CellWidth(j);
      std::array<double, 4> at{begin, 0, 0, 0};
      for (std::size_t k = 1; k < 4; ++k) at[k] = g(x + width * kParts[k]);
      if (last(at[1]) || last(at[2]) || last(at[3])) break;
      double c[4];
      PutCubic(at, c);
      cells.insert(cells.end(), c, c + 4);
      begin = at[3];
      if (begin > least) {
        const double off = std::abs(std::expm1(g(x + width * 0.5) - Cubic(c, 0.5)));
        if (off > error) {
          error = off;
          worst_ = x + width * 0.5;
        }
      }
    }
    curve.cells = cells.data() + first;
    curve.count = j;
    if (j == 0) return error;
    const double* const c = curve.cells + 4 * (j - 1);
    curve.end = CellBegin(j);
    curve.tail_value = begin;
    curve.tail_slope = CubicSlope(c, 1) * curve.end / CellWidth(j - 1);
    return error;
  }

  bool Fail(std::string error) {
    error_ = std::move(error);
    return false;
  }

  bool MakeDensity() {
    const double at_0 = f_(0);
    if (!(at_0 > 0) || std::isinf(at_0)) {
      return Fail(Message("f(0) = %g, must be positive and finite", at_0, 0, 0));
    }
    bool valid = true;
    double bad_r = 0, bad = 0;
    const auto log_f = [&](double r) {
      const double value = f_(r);
      if (valid && (!(value >= 0) || std::isinf(value))) {
        valid = false;
        bad_r = r;
        bad = value;
      }
      return std::log(value / at_0) + 2 * std::log1p(r * r);
    };
    const double gone = std::log(kGone);
    RadialCurve& curve = table_.entries_.density;
    table_.density_error_ = Append(curve, kMost, std::log(kNegligible), log_f,
                                   [&](double g) { return !(g > gone) || std::isinf(g); });
    if (!valid) return Fail(Message("f(%g) = %g, must be positive and finite", bad_r, bad, 0));
    const double end = curve.count > 0 ? curve.tail_value - 2 * std::log1p(curve.end * curve.end) : 0;
    if (end > std::log(kNegligible) && curve.count < kMost) {
      const double next = CellBegin(curve.count) + CellWidth(curve.count);
      return Fail(Message("f(%g) = %g, must be positive until it is below 1e-30 of f(0)", next, f_(next), 0));
    }
    if (table_.density_error_ > kLargestError) {
      return Fail(Message("f is not smooth: next to r = %g cubics miss it by %.2g %%, must be within 1 %%",
                          worst_, 100 * table_.density_error_, 0));
    }
    // The power of r that f goes towards: what is off from it falls as r^-2.
    if (curve.count == kMost) {
      const double at = log_f(curve.end / 2), last = log_f(curve.end) - at,
                   before = at - log_f(curve.end / 4);
      curve.tail_slope = (last + (last - before) / 3) / std::log(2);
      if (curve.tail_value > std::log(kNegligible)) {
        table_.density_error_ = std::max(table_.density_error_, std::abs(last - before) / 9);
      }
    }
    const double power = 4 - curve.tail_slope;
    if (!(power >= kLeastPower)) {
      return Fail(
          Message("f falls as r^-%.2f in the end, must fall at least as r^-%g", power, kLeastPower, 0));
    }
    return true;
  }

  // pi f(r), whose integral over t = r^2 is 1.
  double PiF(double t) const {
    return std::exp(CurveAt(table_.entries_.density, std::sqrt(t))) / ((1 + t) * (1 + t));
  }

  // Shares of the slopes beyond each cell's beginning.
  bool Normalise() {
    static const LegendreRule<12> rule;
    RadialCurve& curve = table_.entries_.density;
    beyond_.assign(curve.count + 1, 0);
    beyond_[curve.count] = 2 * std::exp(curve.tail_value) / (curve.end * curve.end * (2 - curve.tail_slope));
    for (std::size_t j = curve.count; j-- > 0;) beyond_[j] = beyond_[j + 1] + Part(rule, j, 0);
    const double total = beyond_[0], log_total = std::log(total);
    if (!(total > 0) || std::isinf(total)) return Fail("f has no finite integral over slopes");
    for (std::size_t j = 0; j < curve.count; ++j) table_.cells_[4 * j] -= log_total;
    curve.tail_value -= log_total;
    for (double& share : beyond_) share /= total;
    return true;
  }

  // The integral of 2 pi f r over cell j from p on.
  template <std::size_t kCount>
  double Part(const LegendreRule<kCount>& rule, std::size_t j, double p) const {
    const double* const c = table_.entries_.density.cells + 4 * j;
    const double begin = CellBegin(j), width = CellWidth(j);
    double sum = 0;
    for (std::size_t k = 0; k < kCount; ++k) {
      const double q = p + (1 - p) * rule.t[k];
      sum += rule.weight[k] * ShareSlope(c, q, begin + width * q);
    }
    return sum * (1 - p) * width;
  }

  // 2 pi f r of the cell of coefficients c.
  static double ShareSlope(const double* c, double p, double r) {
    const double w = 1 + r * r;
    return 2 * r * std::exp(Cubic(c, p)) / (w * w);
  }

  void MakeQuantile() {
    const RadialCurve& density = table_.entries_.density;
    static const LegendreRule<12> rule;
    // log(1 + r^2) of y, by Newton's steps on log(share) within its cell.
    const auto log_w = [&](double y) {
      const double share = std::exp(-y);
      if (share <= beyond_[density.count]) {
        const double log_r =
            std::log(density.end) + (y + std::log(beyond_[density.count])) / (2 - density.tail_slope);
        return 2 * log_r + std::log1p(std::exp(-2 * log_r));
      }
      const std::size_t j = static_cast<std::size_t>(
          std::upper_bound(beyond_.begin(), beyond_.end(), share, std::greater<double>()) - beyond_.begin() -
          1);
      const double* const c = density.cells + 4 * j;
      const double begin = CellBegin(j), width = CellWidth(j);
      const double p = FindFall(-y, [&](double q) {
        return ValueSlope{beyond_[j + 1] + Part(rule, j, q), -width * ShareSlope(c, q, begin + width * q)};
      });
      const double r = begin + width * p;
      return std::log1p(r * r);
    };
    const double at_0 = std::exp(-density.cells[0]);  // 1/(pi f(0))
    Append(
        table_.entries_.quantile, kMostQuantile, 0,
        [&](double root) { return root > 0 ? log_w(root * root) / (root * root) : at_0; },
        [](double) { return false; });
    // d log(1 + r^2)/dy is (1 - u)/(pi f(r) (1 + r^2)).
    const RadialCurve& curve = table_.entries_.quantile;
    for (std::size_t j = 0; j < curve.count; ++j) {
      const double* const c = curve.cells + 4 * j;
      for (const double p : {0.0, 1.0}) {
        const double root = CellBegin(j) + p * CellWidth(j), value = Cubic(c, p);
        const double slope = CubicSlope(c, p) / CellWidth(j);
        const double y = root * root, t = std::expm1(y * value);
        const double exact = std::exp(-y) / (PiF(t) * (1 + t));
        table_.sampling_error_ =
            std::max(table_.sampling_error_, std::abs((value + 0.5 * root * slope) / exact - 1));
      }
    }
  }

  // What q is integrated by where f(a^2 + q^2) is: a part of what f changes over.
  double Step(double a) const {
    const double t = a * a, h = 1e-3 * (1 + t), falls = std::log(PiF(t) / PiF(t + h)) / h;
    return 0x1p-6 / std::sqrt(std::max(falls, 1e-3 / (1 + t)));
  }
  // From where pi f = e^tail_value (r/end)^slope / r^4 of r = q as well: pi f q^3 there.
  double FarFrom(double a) const { return 0x1p12 * std::max(a, table_.entries_.density.end); }
  double FarPower(double q) const {
    const RadialCurve& density = table_.entries_.density;
    return std::exp(density.tail_value + density.tail_slope * std::log(q / density.end)) / q;
  }

  // Slopes with a part x along an axis: W = Int f (x - a)+ = 2 Int f(a^2 + q^2) (q - a atan(q/a)) q dq, the
  // share above a, which is 2 Int f atan(q/a) q dq, and their density at a, 2 Int f dq, over q > 0.
  struct Axis {
    double area, above, density;
  };
  Axis AxisAt(double a) const {
    static const LegendreRule<12> rule;
    const double t = a * a, far = FarFrom(a);
    double begin = 0, end = Step(a), area = 0, above = 0, density = 0;
    while (begin < far) {
      double last = 0;
      for (std::size_t k = 0; k < rule.t.size(); ++k) {
        const double q = begin + (end - begin) * rule.t[k];
        const double part = (end - begin) * rule.weight[k] * PiF(t + q * q);
        last += part * q * q * (a > 0 ? AtanDefect(q / a) : 1);
        above += part * q * (a > 0 ? std::atan(q / a) : kPi / 2);
        density += part;
      }
      area += last;
      if (last < 1e-18 * area && begin > 1) return {2 / kPi * area, 2 / kPi * above, 2 / kPi * density};
      begin = end;
      end *= 2;
    }
    // atan(q/a) = pi/2 - a/q + ...
    const double s = table_.entries_.density.tail_slope, power = FarPower(begin), ratio = a / begin;
    area += power / (1 - s) - kPi / 2 * ratio * power / (2 - s);
    above += (kPi / 2 * power / (2 - s) - ratio * power / (3 - s)) / begin;
    density += power / (3 - s) / (begin * begin);
    return {2 / kPi * area, 2 / kPi * above, 2 / kPi * density};
  }

  void MakeMasking() {
    RadialCurve& curve = table_.entries_.masking;
    std::vector<double>& cells = table_.cells_;
    std::vector<double> area, above;
    const std::size_t first = cells.size();
    Axis begin = AxisAt(0);
    const double gone = kGone * begin.area, negligible = kNegligible * begin.area;
    std::size_t j = 0;
    for (;; ++j) {
      area.push_back(begin.area);
      above.push_back(begin.above);
      if (j == kMost) break;
      const double x = CellBegin(j), width = CellWidth(j);
      const Axis end = AxisAt(x + width);
      if (!(end.area > gone)) break;
      const auto slope = [&](const Axis& at) { return -width * at.above / at.area; };
      double c[4];
      PutHermite(std::log(begin.area), slope(begin), std::log(end.area), slope(end), c);
      cells.insert(cells.end(), c, c + 4);
      if (end.area > negligible) {
        const double off = std::log(AxisAt(x + 0.5 * width).area) - Cubic(c, 0.5);
        table_.masking_error_ = std::max(table_.masking_error_, std::abs(std::expm1(off)));
      }
      // The density of W'' = W (log(W)'^2 + log(W)'') against that at both ends.
      for (const double p : {0.0, 1.0}) {
        const Axis& at = p == 0 ? begin : end;
        if (!(at.above > kRare)) continue;
        const double d = CubicSlope(c, p) / width, dd = (2 * c[2] + 6 * c[3] * p) / (width * width);
        along_error_ = std::max(along_error_, std::abs(at.area * (d * d + dd) / at.density - 1));
      }
      begin = end;
    }
    curve.cells = cells.data() + first;
    curve.count = j;
    curve.end = CellBegin(j);
    curve.tail_value = std::log(begin.area);
    // Where f goes on as a power, so does its integral.
    curve.tail_slope =
        j == kMost ? table_.entries_.density.tail_slope - 1 : -curve.end * begin.above / begin.area;
    // What the integral has of D's errors, and its normalisation.
    table_.masking_error_ += 2 * table_.density_error_;
    area.resize(RadialEntries::kNodes);
    above.resize(RadialEntries::kNodes);
    table_.entries_.area = Keep(area);
    table_.entries_.above = Keep(above);
  }

  const double* Keep(const std::vector<double>& values) {
    std::vector<double>& cells = table_.cells_;
    cells.insert(cells.end(), values.begin(), values.end());
    return cells.data() + cells.size() - values.size();
  }

  // Slopes with the part t along an axis: y across it, of which e^-x have more in absolute value.
  class Across {
   public:
    Across(const Builder& builder, double t) : builder_(builder), t2_(t * t), at_0_(builder.PiF(t * t)) {
      static const LegendreRule<12> rule;
      const double far = builder.FarFrom(t);
      edges_.push_back(0);
      // Panels of 1/8 of an octave, for f may fall as far as it likes.
      for (double end = builder.Step(t); edges_.back() < far; end *= 0x1.172b83c7d517bp0) {
        edges_.push_back(end);
        parts_.push_back(Integral(rule, edges_[edges_.size() - 2], end));
        if (parts_.back() < 1e-60 * parts_.front() && end > 1) break;
      }
      beyond_.assign(edges_.size(), 0);
      if (edges_.back() >= far) {
        const double q = edges_.back(), s = builder.table_.entries_.density.tail_slope;
        beyond_.back() = builder.FarPower(q) / (q * q) / (3 - s) / at_0_;
      }
      for (std::size_t k = parts_.size(); k-- > 0;) beyond_[k] = beyond_[k + 1] + parts_[k];
    }

    double At(double x) const {
      static const LegendreRule<12> rule;
      if (x == 0) return beyond_.front();  // y is x times this next to 0
      const double share = std::exp(-x) * beyond_.front();
      if (share <= beyond_.back()) {
        const double s = builder_.table_.entries_.density.tail_slope;
        return edges_.back() * std::exp(std::log(beyond_.back() / share) / (3 - s));
      }
      const std::size_t j = static_cast<std::size_t>(
          std::upper_bound(beyond_.begin(), beyond_.end(), share, std::greater<double>()) - beyond_.begin() -
          1);
      const double begin = edges_[j], end = edges_[j + 1];
      const double p = FindFall(std::log(share), [&](double q) {
        const double y = begin + (end - begin) * q;
        return ValueSlope{beyond_[j + 1] + Integral(rule, y, end), -(end - begin) * Density(y)};
      });
      return begin + (end - begin) * p;
    }

    // dy/dx where y is.
    double Slope(double x, double y) const { return std::exp(-x) * beyond_.front() / Density(y); }

   private:
    // Over that of y = 0, which may be next to nothing.
    double Density(double y) const { return builder_.PiF(t2_ + y * y) / at_0_; }
    template <std::size_t kCount>
    double Integral(const LegendreRule<kCount>& rule, double begin, double end) const {
      double sum = 0;
      for (std::size_t k = 0; k < kCount; ++k) {
        sum += rule.weight[k] * Density(begin + (end - begin) * rule.t[k]);
      }
      return sum * (end - begin);
    }

    const Builder& builder_;
    double t2_, at_0_;
    std::vector<double> edges_, parts_, beyond_;
  };

  void MakeAcross() {
    constexpr std::size_t kBits = RadialSurface::kCellBits;
    RadialSurface& surface = table_.entries_.across;
    std::vector<double>& cells = table_.cells_;
    surface = {cells.data() + cells.size(), kRowCells, kAcrossCells};
    double error = 0;
    const auto add_row = [&](double t, bool exists) {
      const Across across(*this, t);
      const double scale = std::sqrt(1 + t * t);
      const auto value = [&](double x) {
        return x > 0 ? std::asinh(across.At(x) / scale) / x : across.At(0) / scale;
      };
      // d asinh(y/scale)/dx.
      const auto slope = [&](double x, double y) { return across.Slope(x, y) / std::hypot(scale, y); };
      constexpr double kStep = 1e-3;
      ValueSlope begin{value(0), (4 * value(kStep) - value(2 * kStep) - 3 * value(0)) / (2 * kStep)};
      for (std::size_t j = 0; j < kAcrossCells; ++j) {
        const double x = CellBegin(j, kBits), width = CellWidth(j, kBits), next = x + width;
        const double at = value(next);
        const ValueSlope end{at, (slope(next, scale * std::sinh(next * at)) - at) / next};
        double c[4];
        PutHermite(begin.value, width * begin.slope, end.value, width * end.slope, c);
        cells.insert(cells.end(), c, c + 4);
        begin = end;
        if (!exists || !(std::exp(-next) > kRare)) continue;
        // Where the slope of what a cubic lacks is most.
        for (const double p : {0.21, 0.79}) {
          const double inside = x + width * p, v = inside * Cubic(c, p), y = scale * std::sinh(v);
          const double got = Cubic(c, p) + inside * CubicSlope(c, p) / width;
          error = std::max(error, std::abs(got / slope(inside, y) - 1));
        }
      }
    };
    // What a table without a tail has beyond its end is of no consequence.
    const double last = table_.entries_.density.end;
    for (std::size_t k = 0; k < kRows; ++k) {
      const std::size_t cell = k / 3;
      const double t =
          CellBegin(cell, RadialSurface::kRowBits) + kParts[k % 3] * CellWidth(cell, RadialSurface::kRowBits);
      add_row(std::min(t, last), t < last);
    }
    table_.visible_sampling_error_ = along_error_ + error;
  }

  RadialTable& table_;
  const std::function<double(double)>& f_;
  std::vector<double> beyond_;
  std::string error_;
  double worst_ = 0;  // x of Append's largest error
  double along_error_ = 0;
};

RadialTable::RadialTable(const std::function<double(double)>& f) : Prepared("") {
  std::string error = f ? Builder(*this, f).Run() : "f: no function";
  if (error.empty()) return;
  SetError(std::move(error));
  cells_.clear();
  entries_ = {};
}

}  // namespace microlane
