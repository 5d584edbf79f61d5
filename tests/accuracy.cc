#include "accuracy.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <mutex>
#include <optional>
#include <thread>

#include "microlane/kernels.h"
#include "microlane/scalar/evaluate.h"
#include "microlane/targets.h"
#include "oracle/oracle.h"
#include "ulp.h"

namespace microlane {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::size_t kChunk = 512;
constexpr std::size_t kParents = 8;  // worst points kept for each output

bool IsScalar(const AccuracyOptions& options) {
  return options.target == "scalar" || options.target == "scalar-double";
}
bool IsDouble(const AccuracyOptions& options) {
  return options.target == "scalar-double" || (options.double_lanes && options.target != "scalar");
}

scalar::Transport Scalar(Transport transport) {
  return transport == Transport::kRadiance ? scalar::Transport::kRadiance : scalar::Transport::kImportance;
}
oracle::Transport Oracle(Transport transport) {
  return transport == Transport::kRadiance ? oracle::Transport::kRadiance : oracle::Transport::kImportance;
}

// A decision closer than this may turn out either way.
double ExcusedMargin(const AccuracyOptions& options) {
  if (IsDouble(options)) return 1e-12;
  if (!IsScalar(options) && options.accuracy == Accuracy::kFast) return 0x1p-9;
  return 1e-5;
}

struct Candidate {
  double ulp = -1;
  Point in{};
  Transport transport = Transport::kRadiance;
};

// What is known of one output.
struct Tally {
  double sum = 0;
  std::uint64_t correct = 0;
  WorstCase worst;
  std::vector<Candidate> parents;  // the worst, largest error first

  void Offer(const Candidate& candidate) {
    if (!(candidate.ulp > 0) || (parents.size() == kParents && candidate.ulp <= parents.back().ulp)) return;
    const auto place = std::find_if(parents.begin(), parents.end(),
                                    [&](const Candidate& p) { return p.ulp < candidate.ulp; });
    parents.insert(place, candidate);
    if (parents.size() > kParents) parents.pop_back();
  }
};

struct Tallies {
  Tally output[kMaxOutputs];
  double relative = 0;  // largest, of kUlp outputs that are normal floats
  std::uint64_t points = 0, searched = 0, judged = 0, nans = 0, infinities = 0, excused = 0, undetermined = 0;

  void Add(const Tallies& other) {
    for (std::size_t i = 0; i < kMaxOutputs; ++i) {
      Tally& to = output[i];
      const Tally& from = other.output[i];
      to.sum += from.sum;
      to.correct += from.correct;
      if (from.worst.ulp > to.worst.ulp) to.worst = from.worst;
      for (const Candidate& candidate : from.parents) to.Offer(candidate);
    }
    relative = std::max(relative, other.relative);
    points += other.points;
    searched += other.searched;
    judged += other.judged;
    nans += other.nans;
    infinities += other.infinities;
    excused += other.excused;
    undetermined += other.undetermined;
  }
};

// ulp(scale) of a float result, as UlpError has it.
double FloatUlp(double scale) {
  int exponent;
  std::frexp(scale, &exponent);
  return std::ldexp(1.0, std::max(exponent - 1, -126) - 23);
}

// What the oracle said of a list of points.
using Memo = std::vector<std::optional<oracle::Result>>;

template <class T>
void ComputeAs(std::size_t kernel, const AccuracyOptions& options, const Point* points, std::size_t n,
               Transport transport, std::vector<T>* out) {
  const std::size_t num_inputs = Split(kKernels[kernel].inputs).count;
  const std::size_t num_outputs = Split(kKernels[kernel].outputs).count;
  for (std::size_t i = 0; i < num_outputs; ++i) out[i].resize(n);
  if (IsScalar(options)) {
    T in[kMaxInputs], result[kMaxOutputs];
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = 0; k < kMaxInputs; ++k) in[k] = static_cast<T>(points[j][k]);
      scalar::Evaluate(kernel, in, result, Scalar(transport));
      for (std::size_t i = 0; i < num_outputs; ++i) out[i][j] = result[i];
    }
    return;
  }
  std::vector<T> in[kMaxInputs];
  Call<T> call;
  call.transport = transport;
  for (std::size_t k = 0; k < num_inputs; ++k) {
    in[k].resize(n);
    for (std::size_t j = 0; j < n; ++j) in[k][j] = static_cast<T>(points[j][k]);
    call.in[k] = in[k].data();
  }
  for (std::size_t i = 0; i < num_outputs; ++i) call.out[i] = out[i].data();
  if constexpr (sizeof(T) == 4) {
    RunKernel(kernel, options.accuracy, call, n);
  } else {
    RunKernel(kernel, call, n);
  }
}

// The error of points of one kernel under one set of options.
class Judge {
 public:
  Judge(std::size_t kernel, const AccuracyOptions& options)
      : kernel_(kernel),
        options_(options),
        names_(Split(kKernels[kernel].inputs)),
        outputs_(Split(kKernels[kernel].outputs)),
        margin_(ExcusedMargin(options)),
        bound_(DeclaredBound(kernel, options)),
        samples_(outputs_.name[outputs_.count - 1] == "lobe") {
    for (std::size_t i = 0; i < outputs_.count; ++i) {
      metric_[i] = MetricOf(kKernels[kernel], outputs_.name[i]);
    }
  }

  std::size_t num_outputs() const { return outputs_.count; }

  // `errors`, if given, takes the error of each output of each point, which then counts in the worst cases
  // only; `memo` has a place for each.
  void Run(const Point* points, std::size_t n, Transport transport, std::uint64_t first_index,
           Tallies& tallies, std::array<double, kMaxOutputs>* errors = nullptr,
           std::optional<oracle::Result>* memo = nullptr) const {
    if (IsDouble(options_)) {
      RunAs<double>(points, n, transport, first_index, tallies, errors, memo);
    } else {
      RunAs<float>(points, n, transport, first_index, tallies, errors, memo);
    }
  }

 private:
  template <class T>
  void RunAs(const Point* points, std::size_t n, Transport transport, std::uint64_t first_index,
             Tallies& tallies, std::array<double, kMaxOutputs>* errors,
             std::optional<oracle::Result>* memo) const {
    std::vector<T> out[kMaxOutputs];
    ComputeAs(kernel_, options_, points, n, transport, out);
    for (std::size_t j = 0; j < n; ++j) {
      T got[kMaxOutputs] = {};
      for (std::size_t i = 0; i < outputs_.count; ++i) got[i] = out[i][j];
      JudgePoint(points[j], transport, first_index + j, got, tallies, errors ? errors[j].data() : nullptr,
                 memo ? memo + j : nullptr);
    }
  }

  template <class T>
  void JudgePoint(const Point& in, Transport transport, std::uint64_t index, const T* got, Tallies& tallies,
                  double* errors, std::optional<oracle::Result>* memo) const {
    ++tallies.points;
    tallies.searched += errors != nullptr;
    bool nan = false, infinite = false;
    for (std::size_t i = 0; i < outputs_.count; ++i) {
      nan |= std::isnan(got[i]);
      infinite |= std::isinf(got[i]);
    }
    tallies.nans += nan;
    tallies.infinities += infinite;

    double error[kMaxOutputs] = {};
    bool correct[kMaxOutputs] = {};
    bool near_worst = nan || infinite || index % options_.oracle_share == 0;
    if constexpr (sizeof(T) == 4) {
      near_worst |= !Estimate(in, transport, got, error, correct);
      for (std::size_t i = 0; i < outputs_.count; ++i) {
        near_worst |= error[i] > 0.99 * std::max(tallies.output[i].worst.ulp, 0.4);
      }
    } else {
      near_worst = true;
    }
    if (near_worst) Truth(in, transport, got, tallies, error, correct, memo);
    for (std::size_t i = 0; i < outputs_.count; ++i) {
      const double magnitude = std::abs(static_cast<double>(got[i]));
      if (sizeof(T) == 4 && metric_[i] == Metric::kUlp && magnitude >= 0x1p-126 && std::isfinite(magnitude)) {
        tallies.relative = std::max(tallies.relative, error[i] * FloatUlp(magnitude) / magnitude);
      }
      if (errors != nullptr) {
        errors[i] = error[i];
        continue;
      }
      Tally& tally = tallies.output[i];
      tally.sum += error[i];
      tally.correct += correct[i];
      tally.Offer({error[i], in, transport});
    }
  }

  // Errors by the scalar code in double; false where it cannot tell.
  bool Estimate(const Point& in, Transport transport, const float* got, double* error, bool* correct) const {
    double reference[kMaxOutputs];
    scalar::Evaluate(kernel_, in.data(), reference, Scalar(transport));
    if (samples_ && static_cast<double>(got[5]) != reference[5]) return false;
    for (std::size_t i = 0; i < outputs_.count; ++i) {
      const double kappa =
          samples_ && reference[5] != 0 ? Kappa(in, reference, outputs_.name[i] == "weight") : 1;
      const double exact = reference[i];
      if (!(std::abs(exact) <= static_cast<double>(std::numeric_limits<float>::max()))) return false;
      const double scale = metric_[i] == Metric::kDirection     ? 1
                           : metric_[i] == Metric::kConditioned ? exact * kappa
                                                                : exact;
      if (metric_[i] == Metric::kConditioned && kappa > 0.5 * LargestKappa<float>()) return false;
      error[i] = std::abs(static_cast<double>(got[i]) - exact) / FloatUlp(scale);
      correct[i] = got[i] == static_cast<float>(exact);
    }
    return true;
  }

  // Where a value within its bound may be off by an eighth or more, to first order, no digit is determined.
  template <class T>
  double LargestKappa() const {
    const double bound = std::isfinite(bound_) ? bound_ : 16;
    return 0.25 / (std::numeric_limits<T>::epsilon() * std::max(bound, 1.0));
  }

  // Between the direction that a sampler gave and the one it should have.
  template <class T>
  static double Distance2(const T* got, const oracle::Result& truth) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      const double difference = static_cast<double>(got[i]) - static_cast<double>(truth.exact[i]);
      sum += difference * difference;
    }
    return sum;
  }

  // Metric::kConditioned's, from a sample's wi, wo and eta, no more than the oracle's; without an
  // interface 1.
  double Kappa(const Point& in, const double* out, bool of_weight) const {
    if (names_.name[names_.count - 1] != "eta") return 1;
    const double eta = in[names_.count - 1], e = out[5] == 2 ? eta : 1;
    const double hx = in[0] + e * out[0], hy = in[1] + e * out[1], hz = in[2] + e * out[2];
    const double h2 = hx * hx + hy * hy + hz * hz;
    if (!(h2 > 1e-12)) return 1;
    const double c = std::abs(in[0] * hx + in[1] * hy + in[2] * hz) / std::sqrt(h2);
    const double g2 = (eta - 1) * (eta + 1) + c * c;
    double of_wo = 1 + 1 / std::abs(out[2]);
    if (of_weight && names_.name[names_.count - 2] == "alpha_y") {
      const double alpha_x = in[names_.count - 3], alpha_y = in[names_.count - 2];
      of_wo += (alpha_x + alpha_y) / std::hypot(out[2], alpha_x * out[0], alpha_y * out[1]);
    }
    return (1 + 1 / c) * (1 + c * c / std::abs(g2)) * of_wo;
  }

  template <class T>
  void Truth(const Point& in, Transport transport, const T* got, Tallies& tallies, double* error,
             bool* correct, std::optional<oracle::Result>* memo) const {
    ++tallies.judged;
    oracle::Result truth =
        memo != nullptr && *memo ? **memo : oracle::Evaluate(kernel_, in.data(), Oracle(transport));
    if (memo != nullptr && !*memo) *memo = truth;
    if (samples_ && !std::isnan(got[5]) && truth.exact[5] != static_cast<double>(got[5]) &&
        truth.margin < margin_) {
      ++tallies.excused;
      if (got[5] == 0 || truth.exact[5] == 0) return;  // there is nothing to compare with
      truth = oracle::Evaluate(kernel_, in.data(), Oracle(transport), static_cast<int>(got[5]));
    }
    if (truth.facet_margin < margin_ && !std::isnan(got[0])) {
      const oracle::Result other = oracle::Evaluate(kernel_, in.data(), Oracle(transport), -1, true);
      if (Distance2(got, other) < Distance2(got, truth)) {
        ++tallies.excused;
        truth = other;
      }
    }
    const double limit = LargestKappa<T>();
    for (std::size_t i = 0; i < outputs_.count; ++i) {
      error[i] = UlpError(got[i], truth.exact[i], truth.scale[i]);
      if (metric_[i] == Metric::kConditioned && std::isfinite(got[i]) &&
          (truth.scale[i] > limit * truth.exact[i] || truth.curvature[i] > limit)) {
        ++tallies.undetermined;
        error[i] = 0;
      }
      correct[i] = CorrectlyRounded(got[i], truth.exact[i]);
      WorstCase& worst = tallies.output[i].worst;
      if (error[i] > worst.ulp) {
        worst = {error[i], in, transport, static_cast<double>(got[i]), static_cast<double>(truth.exact[i])};
      }
    }
  }

  const std::size_t kernel_;
  const AccuracyOptions& options_;
  const Names names_, outputs_;
  const double margin_, bound_;
  const bool samples_;
  Metric metric_[kMaxOutputs] = {};
};

// Chooses a target for as long as it lives.
class TargetScope {
 public:
  explicit TargetScope(const AccuracyOptions& options) : before_(ChosenTarget()) {
    if (!IsScalar(options)) ChooseTarget(options.target);
  }
  ~TargetScope() { ChooseTarget(before_); }

 private:
  const std::string before_;
};

// Calls work(chunk, tallies) for chunk = 0 ... count - 1 on several threads and adds up.
template <class Work>
void ForChunks(const AccuracyOptions& options, std::uint64_t count, Tallies& total, const Work& work,
               std::uint64_t done_before, std::uint64_t all) {
  std::atomic<std::uint64_t> next{0}, done{0};
  std::mutex mutex;
  const auto run = [&](bool reports) {
    Tallies mine;
    for (std::uint64_t chunk; (chunk = next++) < count;) {
      work(chunk, mine);
      ++done;
      if (reports && options.progress) options.progress(done_before + done * kChunk, all);
    }
    if (!reports) mpfr_free_cache2(MPFR_FREE_LOCAL_CACHE);  // this thread's
    const std::lock_guard<std::mutex> lock(mutex);
    total.Add(mine);
  };
  const unsigned wanted = options.threads != 0 ? options.threads : std::thread::hardware_concurrency();
  std::vector<std::thread> threads;
  for (std::uint64_t i = 1; i < std::min<std::uint64_t>(wanted, count); ++i) threads.emplace_back(run, false);
  run(true);
  for (std::thread& thread : threads) thread.join();
}

Transport TransportOf(std::size_t kernel, std::uint64_t chunk) {
  return kKernels[kernel].has_transport && chunk % 4 == 3 ? Transport::kImportance : Transport::kRadiance;
}

// Each point in every transport. `memo` is empty, or from an earlier call with the same points.
void RunList(std::size_t kernel, const AccuracyOptions& options, const Judge& judge,
             const std::vector<Point>& points, Tallies& total, Memo* memo = nullptr) {
  const std::size_t parts = (points.size() + kChunk - 1) / kChunk;
  const std::size_t transports = kKernels[kernel].has_transport ? 2 : 1;
  if (memo != nullptr) memo->resize(points.size() * transports);
  ForChunks(
      options, parts * transports, total,
      [&](std::uint64_t chunk, Tallies& tallies) {
        const std::size_t which = chunk / parts, begin = chunk % parts * kChunk;
        judge.Run(&points[begin], std::min(kChunk, points.size() - begin),
                  which == 0 ? Transport::kRadiance : Transport::kImportance, begin, tallies, nullptr,
                  memo != nullptr ? &(*memo)[which * points.size() + begin] : nullptr);
      },
      0, 0);
}

// point(0) ... point(count - 1); of kernels with a transport every fourth chunk takes importance.
void RunFunction(std::size_t kernel, const AccuracyOptions& options, const Judge& judge,
                 const std::function<Point(std::uint64_t)>& point, std::uint64_t count, Tallies& total) {
  ForChunks(
      options, (count + kChunk - 1) / kChunk, total,
      [&](std::uint64_t chunk, Tallies& tallies) {
        const std::uint64_t begin = chunk * kChunk;
        const std::size_t n = std::min<std::uint64_t>(kChunk, count - begin);
        Point points[kChunk];
        for (std::size_t j = 0; j < n; ++j) points[j] = point(begin + j);
        judge.Run(points, n, TransportOf(kernel, chunk), begin, tallies);
      },
      0, count);
}

// From the worst points of each output, keeps what makes the error larger.
void Search(std::size_t kernel, const AccuracyOptions& options, const Judge& judge, std::uint64_t points,
            Tallies& total) {
  struct Climber {
    Candidate candidate;
    std::size_t output;
  };
  std::vector<Climber> climbers;
  for (std::size_t i = 0; i < judge.num_outputs(); ++i) {
    for (const Candidate& candidate : total.output[i].parents) climbers.push_back({candidate, i});
  }
  if (climbers.empty()) return;
  constexpr std::size_t kChildren = 64;
  const std::uint64_t rounds = points / (kChildren * climbers.size()) + 1;
  ForChunks(
      options, climbers.size(), total,
      [&](std::uint64_t index, Tallies& tallies) {
        Climber climber = climbers[index];
        std::array<double, kMaxOutputs> errors[kChildren];
        Point children[kChildren];
        for (std::uint64_t round = 0; round < rounds; ++round) {
          Random random(options.seed ^ 0x5EA4C4, round * climbers.size() + index);
          for (Point& child : children) {
            child = Perturbed(kernel, climber.candidate.in, random, options.values);
          }
          judge.Run(children, kChildren, climber.candidate.transport, 1, tallies, errors);
          for (std::size_t j = 0; j < kChildren; ++j) {
            if (errors[j][climber.output] > climber.candidate.ulp) {
              climber.candidate.ulp = errors[j][climber.output];
              climber.candidate.in = children[j];
            }
          }
        }
      },
      0, 0);
}

AccuracyReport MakeReport(std::size_t kernel, const AccuracyOptions& options, const Tallies& total) {
  const Names outputs = Split(kKernels[kernel].outputs);
  AccuracyReport report;
  report.points = total.points;
  report.judged = total.judged;
  report.nan_count = total.nans;
  report.inf_count = total.infinities;
  report.max_relative = total.relative;
  report.lobes_excused = total.excused;
  report.undetermined = total.undetermined;
  const double points = static_cast<double>(std::max<std::uint64_t>(total.points - total.searched, 1));
  for (std::size_t i = 0; i < outputs.count; ++i) {
    const Tally& tally = total.output[i];
    report.outputs.push_back({std::string(outputs.name[i]), std::max(tally.worst.ulp, 0.0),
                              tally.sum / points, static_cast<double>(tally.correct) / points, tally.worst});
    if (tally.worst.ulp > report.max_ulp) {
      report.max_ulp = tally.worst.ulp;
      report.worst_output = i;
    }
  }
  report.bound = DeclaredBound(kernel, options);
  report.ok = report.max_ulp <= report.bound && report.nan_count == 0 && report.inf_count == 0;
  return report;
}

}  // namespace

double DeclaredBound(std::size_t kernel, const AccuracyOptions& options) {
  const Bounds& bounds = kKernels[kernel].bounds;
  if (IsScalar(options)) return kInfinity;
  if (options.double_lanes) return bounds.double_lanes;
  switch (options.accuracy) {
    case Accuracy::kHigh:
      return static_cast<double>(bounds.high);
    case Accuracy::kFast:
      return static_cast<double>(bounds.fast);
    case Accuracy::kStandard:
      break;
  }
  const std::string target = options.target.empty() ? "best" : options.target;
  return static_cast<double>(TargetHasFma(target) ? bounds.standard : bounds.standard_nofma);
}

AccuracyReport MeasureAccuracy(std::size_t kernel, const AccuracyOptions& options) {
  const TargetScope scope(options);
  const Judge judge(kernel, options);
  Tallies total;
  RunFunction(kernel, options, judge, RandomPoints(kernel, options.seed, options.values), options.samples,
              total);
  RunList(kernel, options, judge, GridPoints(kernel, options.grid), total);
  Search(kernel, options, judge, options.samples / 10, total);
  if (options.extremes) {
    std::vector<Point> points;
    for (const ExtremeCase& extreme : ExtremeCases(kernel)) points.push_back(extreme.in);
    RunList(kernel, options, judge, points, total);
  }
  return MakeReport(kernel, options, total);
}

std::vector<AccuracyReport> MeasureAccuracy(std::size_t kernel, const std::vector<AccuracyOptions>& options,
                                            const std::vector<Point>& points) {
  std::vector<AccuracyReport> reports;
  Memo memo;
  for (const AccuracyOptions& one : options) {
    const TargetScope scope(one);
    const Judge judge(kernel, one);
    Tallies total;
    RunList(kernel, one, judge, points, total, &memo);
    reports.push_back(MakeReport(kernel, one, total));
  }
  return reports;
}

AccuracyReport MeasureAccuracy(std::size_t kernel, const AccuracyOptions& options,
                               const std::function<Point(std::uint64_t)>& point, std::uint64_t count) {
  const TargetScope scope(options);
  const Judge judge(kernel, options);
  Tallies total;
  RunFunction(kernel, options, judge, point, count, total);
  return MakeReport(kernel, options, total);
}

std::vector<std::array<double, kMaxOutputs>> Compute(std::size_t kernel, const AccuracyOptions& options,
                                                     const std::vector<Point>& points, Transport transport) {
  const TargetScope scope(options);
  std::vector<std::array<double, kMaxOutputs>> results(points.size());
  const auto compute = [&](auto zero) {
    std::vector<decltype(zero)> out[kMaxOutputs];
    ComputeAs(kernel, options, points.data(), points.size(), transport, out);
    for (std::size_t i = 0; i < kMaxOutputs; ++i) {
      for (std::size_t j = 0; j < out[i].size(); ++j) results[j][i] = static_cast<double>(out[i][j]);
    }
  };
  if (IsDouble(options)) {
    compute(0.0);
  } else {
    compute(0.0f);
  }
  return results;
}

std::vector<AccuracyOptions> AllAccuracies(const std::string& target) {
  std::vector<AccuracyOptions> all(4);
  for (AccuracyOptions& options : all) options.target = target;
  all[0].accuracy = Accuracy::kHigh;
  all[2].accuracy = Accuracy::kFast;
  all[3].double_lanes = true;
  return all;
}

std::string AccuracyName(const AccuracyOptions& options) {
  if (IsScalar(options)) return options.target;
  if (options.double_lanes) return "double";
  return options.accuracy == Accuracy::kHigh   ? "high"
         : options.accuracy == Accuracy::kFast ? "fast"
                                               : "standard";
}

std::string Describe(std::size_t kernel, const Point& in) {
  const Names names = Split(kKernels[kernel].inputs);
  std::string text;
  for (std::size_t i = 0; i < names.count; ++i) {
    char value[48];
    std::snprintf(value, sizeof value, "%s%.*s=%a", i == 0 ? "" : " ", static_cast<int>(names.name[i].size()),
                  names.name[i].data(), in[i]);
    text += value;
  }
  return text;
}

std::string Describe(std::size_t kernel, const AccuracyOptions& options, const AccuracyReport& report) {
  const OutputReport& output = report.outputs[report.worst_output];
  const std::string target = IsScalar(options) || !options.target.empty() ? options.target : ChosenTarget();
  char text[400];
  std::snprintf(
      text, sizeof text, "%s %s %s: %llu points, max %.4g ulp (bound %g), mean %.3g, nan %llu, inf %llu, ",
      std::string(kKernels[kernel].id).c_str(), AccuracyName(options).c_str(), target.c_str(),
      static_cast<unsigned long long>(report.points), report.max_ulp, report.bound, output.mean_ulp,
      static_cast<unsigned long long>(report.nan_count), static_cast<unsigned long long>(report.inf_count));
  std::string line = text;
  if (report.lobes_excused + report.undetermined != 0) {
    line += "other lobe " + std::to_string(report.lobes_excused) + ", undetermined " +
            std::to_string(report.undetermined) + ", ";
  }
  std::snprintf(text, sizeof text, "worst %s got %a (%g) exact %a (%g)%s at ", output.name.c_str(),
                output.worst.got, output.worst.got, output.worst.exact, output.worst.exact,
                output.worst.transport == Transport::kImportance ? " importance" : "");
  return line + text + Describe(kernel, output.worst.in);
}

}  // namespace microlane
