// `microlane quadrature`: error against run time of the kernels that integrate over normals, by the order.
#include "microlane/quadrature.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/targets.h"
#include "stopwatch.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::size_t kInputs = 8;  // wi, wo, alpha_x, alpha_y
constexpr int kOrders[] = {1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 24};

struct Request {
  std::vector<double> alphas = {0.05, 0.2, 0.5, 1, 2};
  std::string target;
  double ratio = 1, seconds = 0.03;
};

// Pairs of directions: from the normal to 85 degrees each, at every azimuth.
template <class T>
class Pairs {
 public:
  Pairs(double alpha_x, double alpha_y) {
    constexpr double kDegrees[] = {0, 20, 45, 60, 75, 85};
    constexpr double kAzimuths[] = {0, 10, 45, 90, 135, 170, 180, 200, 300};
    for (const double turned : {0.0, 0.7, 1.4}) {
      for (const double theta_i : kDegrees) {
        for (const double theta_o : kDegrees) {
          for (const double azimuth : kAzimuths) {
            Append(0, theta_i, turned);
            Append(3, theta_o, turned + azimuth * (kPi / 180));
          }
        }
      }
    }
    in_[6].assign(size(), static_cast<T>(alpha_x));
    in_[7].assign(size(), static_cast<T>(alpha_y));
    out_.resize(size());
  }

  std::size_t size() const { return in_[0].size(); }

  std::vector<T>& Eval(std::size_t kernel, const QuadratureRule& rule, Accuracy accuracy) {
    Call<T> call;
    for (std::size_t k = 0; k < kInputs; ++k) call.in[k] = in_[k].data();
    call.out[0] = out_.data();
    call.prepared = &rule;
    if constexpr (sizeof(T) == 4) {
      RunKernel(kernel, accuracy, call, size());
    } else {
      RunKernel(kernel, call, size());
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

  std::array<std::vector<T>, kInputs> in_;
  std::vector<T> out_;
};

void PrintKernel(std::size_t kernel, double alpha, const Request& request) {
  Pairs<double> doubles(alpha, alpha * request.ratio);
  Pairs<float> floats(alpha, alpha * request.ratio);
  const std::vector<double> exact =
      doubles.Eval(kernel, QuadratureRule(QuadratureRule::kMaxOrder), Accuracy::kStandard);
  for (const int order : kOrders) {
    const QuadratureRule rule(order);
    const std::vector<double>& got = doubles.Eval(kernel, rule, Accuracy::kStandard);
    double sum = 0, largest = 0;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      const double error = std::abs(got[i] / exact[i] - 1);
      sum += error * error;
      largest = std::max(largest, error);
    }
    fmt::print("{:<32} {:>5g} {:>5} {:>7} {:>9.1e} {:>9.1e}", kKernels[kernel].id, alpha, order,
               3 * order * order, std::sqrt(sum / static_cast<double>(exact.size())), largest);
    for (const Accuracy accuracy : kAccuracies) {
      const Timing time = Measure(request.seconds, [&] { floats.Eval(kernel, rule, accuracy); });
      fmt::print(" {:>8}", Short(time.min / static_cast<double>(floats.size())));
    }
    fmt::print("\n");
    std::fflush(stdout);
  }
}

void Run(const Request& request) {
  UseTarget(request.target);
  fmt::print("target {}, alpha_y = {:g} alpha_x, relative error against order {}; ns per lane\n",
             ChosenTarget(), request.ratio, QuadratureRule::kMaxOrder);
  fmt::print("{:<32} {:>5} {:>5} {:>7} {:>9} {:>9}", "kernel", "alpha", "order", "normals", "rms", "largest");
  for (const Accuracy accuracy : kAccuracies) fmt::print(" {:>8}", Name(accuracy));
  fmt::print("\n");
  for (std::size_t kernel = kFirstDiffuseKernel; kernel < kNumKernels; ++kernel) {
    if (kDiffuseQuantities[PlaceOfDiffuseKernel(kernel).quantity].joint != DielectricQuantity::kCorrelated)
      continue;
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
      "Errors are those of double lanes over 972 pairs of directions, each from the normal to 85 degrees; "
      "the order "
      "is that of\n"
      "the rule, of 3 order^2 normals.");
  quadrature->callback([request] { Run(*request); });
}

}  // namespace microlane
