// `microlane list`: the kernel list, for people or as JSON.
#include <fmt/core.h>

#include <memory>
#include <string>

#include "command.h"
#include "microlane/kernel_list.h"

namespace microlane {
namespace {

std::string Quoted(std::string_view text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + '"';
}

std::string_view MetricName(Metric metric) {
  switch (metric) {
    case Metric::kDirection:
      return "ulp of 1";
    case Metric::kConditioned:
      return "ulp times condition";
    case Metric::kExact:
      return "exact";
    case Metric::kUlp:
      break;
  }
  return "ulp";
}

void PrintJson() {
  fmt::print("[\n");
  for (std::size_t k = 0; k < kNumKernels; ++k) {
    const Kernel& kernel = kKernels[k];
    const Names inputs = Split(kernel.inputs), outputs = Split(kernel.outputs);
    fmt::print("  {{\"id\": {}, \"inputs\": [", Quoted(kernel.id));
    for (std::size_t i = 0; i < inputs.count; ++i) {
      const Input& input = FindInput(inputs.name[i]);
      fmt::print(R"({}{{"name": {}, "low": {}, "high": {}, "may_be_uniform": {}, "meaning": {}}})",
                 i == 0 ? "" : ", ", Quoted(input.name), input.low, input.high, i >= inputs.per_lane,
                 Quoted(input.meaning));
    }
    fmt::print("], \"outputs\": [");
    for (std::size_t i = 0; i < outputs.count; ++i) {
      const Output& output = FindOutput(outputs.name[i]);
      fmt::print(R"({}{{"name": {}, "unit": {}, "error": {}}})", i == 0 ? "" : ", ", Quoted(output.name),
                 Quoted(output.unit), Quoted(MetricName(MetricOf(kernel, output.name))));
    }
    const Bounds& bounds = kernel.bounds;
    fmt::print(
        "], \"source\": {}, \"note\": {}, \"has_transport\": {}, \"bounds\": {{\"high\": {}, \"standard\": "
        "{}, "
        "\"fast\": {}, \"standard_without_fma\": {}, \"double\": {}}}}}{}\n",
        Quoted(kernel.source), Quoted(kernel.note), kernel.has_transport, bounds.high, bounds.standard,
        bounds.fast, bounds.standard_nofma, bounds.double_lanes, k + 1 < kNumKernels ? "," : "");
  }
  fmt::print("]\n");
}

void PrintText() {
  std::size_t id_width = 0, inputs_width = 0, outputs_width = 0;
  for (const Kernel& kernel : kKernels) {
    id_width = std::max(id_width, kernel.id.size());
    inputs_width = std::max(inputs_width, kernel.inputs.size());
    outputs_width = std::max(outputs_width, kernel.outputs.size());
  }
  fmt::print("{:<{}}  {:<{}}  {:<{}}  {:>4} {:>5} {:>5} {:>7} {:>7}  {}\n", "kernel", id_width,
             "inputs | may be uniform", inputs_width, "outputs", outputs_width, "high", "std", "fast",
             "no FMA", "double", "source");
  for (const Kernel& kernel : kKernels) {
    const Bounds& bounds = kernel.bounds;
    fmt::print("{:<{}}  {:<{}}  {:<{}}  {:>4} {:>5} {:>5} {:>7} {:>7}  {}\n", kernel.id, id_width,
               kernel.inputs, inputs_width, kernel.outputs, outputs_width, bounds.high, bounds.standard,
               bounds.fast, bounds.standard_nofma, bounds.double_lanes, kernel.source);
  }
  fmt::print("{} kernels. Bounds in ULP: of float, and of double for double lanes; 4096 ULP are 2^-11.\n",
             kNumKernels);
}

}  // namespace

void AddList(CLI::App& app) {
  CLI::App* list = app.add_subcommand("list", "The kernels: inputs, outputs, declared error bounds, sources");
  auto json = std::make_shared<bool>(false);
  list->add_flag("--json", *json,
                 "As a JSON array, with the inputs' domains and the notes on special values");
  list->callback([json] { *json ? PrintJson() : PrintText(); });
}

}  // namespace microlane
