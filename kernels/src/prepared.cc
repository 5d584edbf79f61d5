#include "microlane/prepared.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "microlane/albedo.h"
#include "microlane/kernel_list.h"
#include "microlane/quadrature.h"

namespace microlane {
namespace {

std::shared_ptr<const Prepared> Make(bool is_rule, const std::vector<double>& values) {
  if (is_rule) return std::make_shared<const QuadratureRule>(values[0]);
  return std::make_shared<const AlbedoTable>(WardLobe(values[0], values[1]));
}

struct Kept {
  bool is_rule;
  std::vector<double> values;
  std::shared_ptr<const Prepared> prepared;
};

}  // namespace

std::shared_ptr<const Prepared> Prepare(std::size_t kernel, const double* values) {
  constexpr std::size_t kLimit = 128;
  static std::mutex mutex;
  static std::deque<Kept> last;
  const Names inputs = Split(kKernels[kernel].inputs);
  const bool is_rule = inputs.name[inputs.columns] == "order";
  const std::vector<double> wanted(values, values + (inputs.count - inputs.columns));
  const std::lock_guard<std::mutex> lock(mutex);
  const auto found = std::find_if(last.begin(), last.end(), [&](const Kept& kept) {
    return kept.is_rule == is_rule && kept.values == wanted;
  });
  if (found != last.end()) return found->prepared;
  std::shared_ptr<const Prepared> made = Make(is_rule, wanted);
  if (!made->ok()) return made;  // NaN equals nothing
  if (last.size() == kLimit) last.pop_back();
  last.push_front({is_rule, wanted, std::move(made)});
  return last.front().prepared;
}

}  // namespace microlane
