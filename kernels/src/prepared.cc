#include "microlane/prepared.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <mutex>
#include <string_view>
#include <utility>
#include <vector>

#include "microlane/albedo.h"
#include "microlane/kernel_list.h"
#include "microlane/quadrature.h"
#include "microlane/radial_table.h"

namespace microlane {
namespace {

// what: the first of the inputs that the object is made of.
std::shared_ptr<const Prepared> Make(std::string_view what, const std::vector<double>& values) {
  if (what == "order") return std::make_shared<const QuadratureRule>(values[0]);
  if (what == "m") return std::make_shared<const AlbedoTable>(WardLobe(values[0], values[1]));
  const double gamma = values[0];
  return std::make_shared<const RadialTable>(
      [&](double r) { return std::exp(-gamma * std::log1p(r * r / (gamma - 1))); });
}

struct Kept {
  std::string_view what;
  std::vector<double> values;
  std::shared_ptr<const Prepared> prepared;
};

}  // namespace

std::shared_ptr<const Prepared> Prepare(std::size_t kernel, const double* values) {
  constexpr std::size_t kLimit = 128;
  static std::mutex mutex;
  static std::deque<Kept> last;
  const Names inputs = Split(kKernels[kernel].inputs);
  const std::string_view what = inputs.name[inputs.columns];
  const std::vector<double> wanted(values, values + (inputs.count - inputs.columns));
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = std::find_if(
      last.begin(), last.end(), [&](const Kept& kept) { return kept.what == what && kept.values == wanted; });
  if (found != last.end()) return found->prepared;
  std::shared_ptr<const Prepared> made = Make(what, wanted);
  if (!made->ok()) return made;  // NaN equals nothing
  if (last.size() == kLimit) last.pop_back();
  last.push_front({what, wanted, std::move(made)});
  return last.front().prepared;
}

}  // namespace microlane
