#include "textbook_accuracy.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include "microlane/kernel_list.h"
#include "oracle/oracle.h"
#include "points.h"
#include "textbook.h"
#include "ulp.h"

namespace microlane {
namespace {

// A lobe chosen closer to the decision than this may be either.
constexpr double kExcusedMargin = 1e-5;

TextbookError Judge(std::size_t kernel, const std::vector<Point>& points, std::size_t begin,
                    std::size_t end) {
  const Names inputs = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
  const bool samples = outputs.name[outputs.count - 1] == "lobe";
  TextbookError error;
  double sum = 0;
  for (std::size_t j = begin; j < end; ++j) {
    float in[kMaxInputs], out[kMaxOutputs];
    Call<float> call;
    for (std::size_t k = 0; k < inputs.count; ++k) {
      in[k] = static_cast<float>(points[j][k]);
      call.in[k] = &in[k];
    }
    for (std::size_t k = 0; k < outputs.count; ++k) call.out[k] = &out[k];
    textbook::Run(kernel, call, 1);

    oracle::Result truth = oracle::Evaluate(kernel, points[j].data());
    if (samples && std::isfinite(out[5]) && truth.margin < kExcusedMargin && truth.exact[5] != out[5]) {
      truth =
          oracle::Evaluate(kernel, points[j].data(), oracle::Transport::kRadiance, static_cast<int>(out[5]));
    }
    bool finite = true;
    double largest = 0;
    for (std::size_t k = 0; k < outputs.count; ++k) {
      finite = finite && std::isfinite(out[k]);
      if (std::isfinite(out[k]))
        largest = std::max(largest, UlpError(out[k], truth.exact[k], truth.scale[k]));
    }
    ++error.points;
    error.nan_count += finite ? 0 : 1;
    error.max_ulp = std::max(error.max_ulp, largest);
    sum += largest;
  }
  error.mean_ulp = sum / static_cast<double>(std::max<std::uint64_t>(error.points, 1));
  return error;
}

}  // namespace

TextbookError& TextbookError::operator+=(const TextbookError& other) {
  const double sum =
      mean_ulp * static_cast<double>(points) + other.mean_ulp * static_cast<double>(other.points);
  points += other.points;
  nan_count += other.nan_count;
  max_ulp = std::max(max_ulp, other.max_ulp);
  mean_ulp = sum / static_cast<double>(std::max<std::uint64_t>(points, 1));
  return *this;
}

TextbookError MeasureTextbook(std::size_t kernel, const std::vector<Point>& points) {
  const std::size_t threads = std::max(1u, std::thread::hardware_concurrency());
  std::vector<TextbookError> parts(threads);
  std::vector<std::thread> workers;
  for (std::size_t t = 0; t < threads; ++t) {
    workers.emplace_back([&, t] {
      parts[t] = Judge(kernel, points, points.size() * t / threads, points.size() * (t + 1) / threads);
    });
  }
  for (std::thread& worker : workers) worker.join();
  TextbookError total;
  for (const TextbookError& part : parts) total += part;
  return total;
}

}  // namespace microlane
