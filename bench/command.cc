#include "command.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "microlane/kernel_list.h"
#include "microlane/targets.h"

namespace microlane {

void Fail(std::string_view message) {
  std::fflush(stdout);
  std::string line(message);
  while (!line.empty() && line.back() == '\n') line.pop_back();
  std::replace(line.begin(), line.end(), '\n', ' ');
  fmt::print(stderr, "microlane: {}\n", line);
  std::exit(kFailure);
}

void FailWithoutCommand(const CLI::App& app, std::string_view given) {
  std::string message = given.empty() ? "which command?" : fmt::format("unknown command '{}';", given);
  message += " there are:";
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    message += " " + command->get_name();
  }
  Fail(message);
}

void UseTarget(const std::string& target, std::string_view others) {
  if (target.empty()) others = "";
  const std::string message = target.empty() ? TargetEnvironmentError() : ChooseTarget(target);
  if (!message.empty()) Fail(fmt::format("{}{}", message, others));
}

std::string_view Name(Accuracy accuracy) {
  return accuracy == Accuracy::kHigh ? "high" : accuracy == Accuracy::kFast ? "fast" : "standard";
}

Accuracy ParseAccuracy(std::string_view name) {
  for (const Accuracy accuracy : kAccuracies) {
    if (Name(accuracy) == name) return accuracy;
  }
  Fail(fmt::format("unknown accuracy '{}'; there are: high standard fast", name));
}

std::vector<std::size_t> SelectKernels(const std::vector<std::string>& ids) {
  std::vector<std::size_t> selected;
  for (std::size_t k = 0; ids.empty() && k < kNumKernels; ++k) selected.push_back(k);
  for (const std::string& id : ids) {
    const std::size_t before = selected.size();
    for (std::size_t k = 0; k < kNumKernels; ++k) {
      const std::string_view known = kKernels[k].id;
      if (known == id || known.substr(0, known.find('.')) == id) selected.push_back(k);
    }
    if (selected.size() == before) {
      Fail(fmt::format("unknown kernel '{}'; `microlane list` names them all", id));
    }
  }
  return selected;
}

std::string RefuseNegative(const std::string& text) {
  return !text.empty() && text[0] == '-' ? fmt::format("{} is negative", text) : "";
}

std::string Short(double value) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  const double magnitude = std::abs(value);
  if (magnitude >= 1e5) return fmt::format("{:.1e}", value);
  if (magnitude > 0 && magnitude < 1e-3) return fmt::format("{:.0e}", value);
  const int decimals = magnitude >= 100 || magnitude == 0 ? 0 : magnitude >= 10 ? 1 : magnitude >= 1 ? 2 : 3;
  return fmt::format("{:.{}f}", value, decimals);
}

std::string BoundText(double bound) {
  int exponent;
  const bool power = std::frexp(bound, &exponent) == 0.5;
  return power && bound > 1e5 ? fmt::format("2^{}", exponent - 1) : fmt::format("{:g}", bound);
}

}  // namespace microlane
