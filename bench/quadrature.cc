// `microlane quadrature`: error against run time of the kernels that integrate over normals, by the order.
#include "microlane/quadrature.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/targets.h"
#include "stopwatch.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kOrders[] = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24};

struct Request {
  std::vector<double> alphas = {0.05, 0.2, 0.5, 1, 2};
  std::string target;
  double ratio = 1, seconds = 0.03;
};

// Index 1.5, albedo 0.8, gold at 633 nm, f0 = 0.04.
double FacetParameter(std::string_view name) {
  return name == "eta" || name == "n_i" ? 1.5
         : name == "k"                  ? 0.8
         : name == "n"                  ? 0.18
         : name == "kappa"              ? 3.4
                                        : 0.04;
}

// Pairs of directions, wi or v and wo: from the normal to 85 degrees each, at every azimuth.
template <class T>
class Pairs {
 public:
  Pairs(std::size_t kernel, double alpha_x, double alpha_y) : kernel_(kernel) {
    constexpr double kDegrees[] = {0, 20, 45, 60, 75, 85};
    constexpr double kAzimuths[] = {0, 10, 45, 90, 135, 170, 180, 200, 300};
    for (const double turned : {0.0, 0.7, 1.4}) {
      for (const double theta_i : kDegrees) {
        for (const double theta_o : kDegrees) {
          for (const double azimuth : kAzimuths) {
            Append(0, theta_i, turned);
            if (inputs_.per_lane > 3) Append(3, theta_o, turned + azimuth * (kPi / 180));
          }
        }
      }
    }
    for (std::size_t k = inputs_.per_lane; k < inputs_.columns; ++k) {
      const std::string_view name = inputs_.name[k];
      in_[k].assign(size(), static_cast<T>(name == "alpha_x"   ? alpha_x
                                           : name == "alpha_y" ? alpha_y
                                                               : FacetParameter(name)));
    }
    out_.resize(size());
  }

  std::size_t size() const { return in_[0].size(); }
  const std::vector<T>& Input(std::string_view name) const {
    std::size_t k = 0;
    while (inputs_.name[k] != name) ++k;
    return in_[k];
  }

  std::vector<T>& Eval(const QuadratureRule& rule, Accuracy accuracy) {
    Call<T> call;
    for (std::size_t k = 0; k < inputs_.columns; ++k) call.in[k] = in_[k].data();
    call.out[0] = out_.data();
    call.prepared = &rule;
    if constexpr (sizeof(T) == 4) {
      RunKernel(kernel_, accuracy, call, size());
    } else {
      RunKernel(kernel_, call, size());
    }
    return out_;
  }

 private:
  void Append(std::size_t first, double degrees, double azimuth) {
    const double theta = degrees * (kPi / 180);
    in_[first].push_back(static_cast<T>(std::sin(theta) * std::cos(azimuth)));
    in_[first + 1].push_back(static_cast<T>(std::sin(theta) * std::sin(azimuth)));
    in_[first + 2].push_back(static_cast<T>(std::cos(theta)));
  }

  std::size_t kernel_;
  Names inputs_ = Split(kKernels[kernel_].inputs);
  std::array<std::vector<T>, kMaxInputs> in_;
  std::vector<T> out_;
};

// One random normal for each pair of directions, several times: the sampler's call and then the estimator's.
class RandomNormals {
 public:
  static constexpr std::size_t kRepeats = 16;

  RandomNormals(const DiffuseKernelPlace& place, bool visible, const Pairs<float>& pairs)
      : sampler_(NormalKernel(place.normals,
                              visible ? NormalQuantity::kSampleVisible : NormalQuantity::kSampleNormal,
                              RoughnessKind::kAnisotropic)),
        estimator_(DiffuseKernel({place.normals, place.scatterer,
                                  FindDiffuseQuantity(DielectricQuantity::kEvalNormal,
                                                      DielectricQuantity::kCorrelated, visible)})),
        pairs_(pairs.size()) {
    std::mt19937_64 random(28);
    std::uniform_real_distribution<float> uniform;
    for (std::vector<float>& u : u_) {
      u.resize(size());
      for (float& x : u) x = std::min(uniform(random), 0x1.fffffep-1f);
    }
    const Names inputs = Split(kKernels[estimator_].inputs);
    for (std::size_t k = 0; k < inputs.count; ++k) {
      if (inputs.name[k][0] == 'm') continue;
      const std::vector<float>& values = pairs.Input(inputs.name[k]);
      for (std::size_t i = 0; i < kRepeats; ++i) in_[k].insert(in_[k].end(), values.begin(), values.end());
    }
    for (std::vector<float>& m : m_) m.resize(size());
    out_.resize(size());
  }

  std::size_t size() const { return kRepeats * pairs_; }
  std::string_view id() const { return kKernels[estimator_].id; }

  const std::vector<float>& Eval(Accuracy accuracy) {
    const Names sampler = Split(kKernels[sampler_].inputs), estimator = Split(kKernels[estimator_].inputs);
    Call<float> call;
    for (std::size_t k = 0; k < sampler.count; ++k) {
      const std::string_view name = sampler.name[k];
      call.in[k] = name == "u1"         ? u_[0].data()
                   : name == "u2"       ? u_[1].data()
                   : name[0] == 'v'     ? in_[name[1] - 'x'].data()
                   : name.back() == 'x' ? in_[estimator.per_lane].data()
                                        : in_[estimator.per_lane + 1].data();
    }
    for (std::size_t k = 0; k < 4; ++k) call.out[k] = m_[k].data();
    RunKernel(sampler_, accuracy, call, size());
    for (std::size_t k = 0; k < estimator.count; ++k) {
      call.in[k] = estimator.name[k][0] == 'm' ? m_[estimator.name[k][1] - 'x'].data() : in_[k].data();
    }
    call.out[0] = out_.data();
    RunKernel(estimator_, accuracy, call, size());
    return out_;
  }

 private:
  std::size_t sampler_, estimator_, pairs_;
  std::array<std::vector<float>, 2> u_;
  std::array<std::vector<float>, 4> m_;  // and its density
  std::array<std::vector<float>, kMaxInputs> in_;
  std::vector<float> out_;
};

// The standard deviation of one estimate, relative to the value, in place of an error.
void PrintEstimator(const DiffuseKernelPlace& place, bool visible, double alpha, const Pairs<float>& pairs,
                    const std::vector<double>& exact, const Request& request) {
  RandomNormals normals(place, visible, pairs);
  const std::vector<float>& got = normals.Eval(Accuracy::kStandard);
  double sum = 0, largest = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    double of_pair = 0;
    for (std::size_t k = 0; k < RandomNormals::kRepeats; ++k) {
      const double error = static_cast<double>(got[k * exact.size() + i]) / exact[i] - 1;
      of_pair += error * error / static_cast<double>(RandomNormals::kRepeats);
    }
    sum += of_pair;
    largest = std::max(largest, std::sqrt(of_pair));
  }
  fmt::print("{:<48} {:>5g} {:>5} {:>7} {:>9.1e} {:>9.1e}", normals.id(), alpha, "-", 1,
             std::sqrt(sum / static_cast<double>(exact.size())), largest);
  for (const Accuracy accuracy : kAccuracies) {
    const Timing time = Measure(request.seconds, [&] { normals.Eval(accuracy); });
    fmt::print(" {:>8}", Short(time.min / static_cast<double>(normals.size())));
  }
  fmt::print("\n");
  std::fflush(stdout);
}

int NormalsPerOrder2(std::size_t kernel) {
  if (kernel < kFirstMeanFresnelKernel) return 3;
  return PlaceOfMeanFresnelKernel(kernel).normals == Normals::kGgx ? 2 : 1;
}

void PrintKernel(std::size_t kernel, double alpha, const Request& request) {
  Pairs<double> doubles(kernel, alpha, alpha * request.ratio);
  Pairs<float> floats(kernel, alpha, alpha * request.ratio);
  const std::vector<double> exact =
      doubles.Eval(QuadratureRule(QuadratureRule::kMaxOrder), Accuracy::kStandard);
  for (const int order : kOrders) {
    const QuadratureRule rule(order);
    const std::vector<double>& got = doubles.Eval(rule, Accuracy::kStandard);
    double sum = 0, largest = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double error = std::abs(got[i] / exact[i] - 1);
      sum += error * error;
      largest = std::max(largest, error);
    }
    fmt::print("{:<48} {:>5g} {:>5} {:>7} {:>9.1e} {:>9.1e}", kKernels[kernel].id, alpha, order,
               NormalsPerOrder2(kernel) * order * order, std::sqrt(sum / static_cast<double>(exact.size())),
               largest);
    for (const Accuracy accuracy : kAccuracies) {
      const Timing time = Measure(request.seconds, [&] { floats.Eval(rule, accuracy); });
      fmt::print(" {:>8}", Short(time.min / static_cast<double>(floats.size())));
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
  if (kernel >= kFirstMeanFresnelKernel) return;
  for (const bool visible : {false, true}) {
    PrintEstimator(PlaceOfDiffuseKernel(kernel), visible, alpha, floats, exact, request);
  }
}

void Run(const Request& request) {
  UseTarget(request.target);
  fmt::print("target {}, alpha_y = {:g} alpha_x, relative error against order {}; ns per lane\n",
             ChosenTarget(), request.ratio, QuadratureRule::kMaxOrder);
  fmt::print("{:<48} {:>5} {:>5} {:>7} {:>9} {:>9}", "kernel", "alpha", "order", "normals", "rms", "largest");
  for (const Accuracy accuracy : kAccuracies) fmt::print(" {:>8}", Name(accuracy));
  fmt::print("\n");
  for (std::size_t kernel = kFirstDiffuseKernel; kernel < kNumKernels; ++kernel) {
    if (!TakesPrepared(kernel) || kKernels[kernel].id.find("separable") != std::string_view::npos) continue;
    for (const double alpha : request.alphas) PrintKernel(kernel, alpha, request);
  }
}

}  // namespace

void AddQuadrature(CLI::App& app) {
  CLI::App* quadrature = app.add_subcommand(
      "quadrature", "Error against run time of integrals over microfacet normals, by the order");
  auto request = std::make_shared<Request>();
  quadrature->add_option("--alpha", request->alphas, "Roughness along x (the default: 0.05 0.2 0.5 1 2)")
      ->check(CLI::Range(1e-5, 1e2))
      ->type_name("FLOAT");
  quadrature->add_option("--ratio", request->ratio, "alpha_y over alpha_x (the default: 1)")
      ->check(CLI::Range(0.01, 1.0))
      ->type_name("FLOAT");
  quadrature->add_option("--target", request->target,
                         "An instruction set of this machine (the default: the best)");
  quadrature
      ->add_option("--seconds", request->seconds, "How long to repeat each measurement (the default: 0.03)")
      ->check(RefuseNegative);
  quadrature->footer(
      "Rows of one_normal and one_visible_normal are of one random normal, with the time of drawing it: "
      "their "
      "errors are\n"
      "standard deviations. Other errors are those of double lanes over 972 pairs of directions, each from "
      "the normal to 85 degrees; "
      "the order "
      "is that of\n"
      "the rule. Facets are of index 1.5, over a body of albedo 0.8, of gold, or of f0 = 0.04.");
  quadrature->callback([request] { Run(*request); });
}

}  // namespace microlane
