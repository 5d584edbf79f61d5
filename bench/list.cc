// `microlane list`: the kernel list, for people or as JSON.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

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

void PrintJson(const std::vector<std::size_t>& kernels) {
  fmt::print("[\n");
  for (const std::size_t k : kernels) {
    const Kernel& kernel = kKernels[k];
    const Names inputs = Split(kernel.inputs), outputs = Split(kernel.outputs);
    fmt::print(R"(  {{"id": {}, "inputs": [)", Quoted(kernel.id));
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
    fmt::print(R"(], "source": {}, "note": {}, "has_transport": {}, "bounds": )", Quoted(kernel.source),
               Quoted(kernel.note), kernel.has_transport);
    fmt::print(R"({{"high": {}, "standard": {}, "fast": {}, "standard_without_fma": {}, "double": {}}}}}{})",
               bounds.high, bounds.standard, bounds.fast, bounds.standard_nofma, bounds.double_lanes,
               k == kernels.back() ? "\n" : ",\n");
  }
  fmt::print("]\n");
}

void PrintTable(const std::vector<std::size_t>& kernels) {
  std::size_t id_width = 0, inputs_width = 0, outputs_width = 0;
  for (const std::size_t k : kernels) {
    id_width = std::max(id_width, kKernels[k].id.size());
    inputs_width = std::max(inputs_width, kKernels[k].inputs.size());
    outputs_width = std::max(outputs_width, kKernels[k].outputs.size());
  }
  fmt::print("{:<{}}  {:<{}}  {:<{}}  {:^34}\n", "", id_width, "", inputs_width, "", outputs_width,
             "largest error, ULP");
  fmt::print("{:<{}}  {:<{}}  {:<{}}  {:>4} {:>8} {:>5} {:>6} {:>7}  {}\n", "kernel", id_width,
             "inputs | may be uniform", inputs_width, "outputs", outputs_width, "high", "standard", "fast",
             "no FMA", "double", "source");
  for (const std::size_t k : kernels) {
    const Kernel& kernel = kKernels[k];
    const Bounds& bounds = kernel.bounds;
    fmt::print("{:<{}}  {:<{}}  {:<{}}  {:>4} {:>8} {:>5} {:>6} {:>7}  {}\n", kernel.id, id_width,
               kernel.inputs, inputs_width, kernel.outputs, outputs_width, BoundText(bounds.high),
               BoundText(bounds.standard), BoundText(bounds.fast), BoundText(bounds.standard_nofma),
               BoundText(bounds.double_lanes), kernel.source);
  }
  fmt::print("\n{:<9}  {:>7} to {:<5}  {}\n", "input", "", "", "meaning");
  for (const Input& input : kInputs) {
    fmt::print("{:<9}  {:>7g} to {:<5g}  {}\n", input.name, input.low, input.high, input.meaning);
  }
  fmt::print(
      "\n{} kernels. The declared bounds are in ULP of float, those of double lanes in ULP of double; 4096 "
      "ULP are 2^-11.\n"
      "`no FMA` is standard on targets without a fused multiply-add. `microlane list ID` defines a kernel.\n",
      kernels.size());
}

void PrintDefinition(const Kernel& kernel) {
  const Names inputs = Split(kernel.inputs), outputs = Split(kernel.outputs);
  fmt::print("{}\n  {}\n", kernel.id, kernel.source);
  if (!kernel.note.empty()) fmt::print("  {}\n", kernel.note);
  if (kernel.has_transport) fmt::print("  Takes radiance or importance transport.\n");
  for (std::size_t i = 0; i < inputs.count; ++i) {
    const Input& input = FindInput(inputs.name[i]);
    fmt::print("  {:<3} {:<9} {:>7g} to {:<5g} {:<15} {}\n", i == 0 ? "in" : "", input.name, input.low,
               input.high, i >= inputs.per_lane ? "may be uniform" : "", input.meaning);
  }
  for (std::size_t i = 0; i < outputs.count; ++i) {
    const Output& output = FindOutput(outputs.name[i]);
    fmt::print("  {:<3} {:<9} {}; error in {}\n", i == 0 ? "out" : "", output.name, output.unit,
               MetricName(MetricOf(kernel, output.name)));
  }
  const Bounds& bounds = kernel.bounds;
  fmt::print("  largest error: high {}, standard {}, fast {}, standard without FMA {}, double lanes {}\n",
             BoundText(bounds.high), BoundText(bounds.standard), BoundText(bounds.fast),
             BoundText(bounds.standard_nofma), BoundText(bounds.double_lanes));
}

}  // namespace

void AddList(CLI::App& app) {
  CLI::App* list = app.add_subcommand("list", "The kernels: inputs, outputs, declared error bounds, sources");
  auto ids = std::make_shared<std::vector<std::string>>();
  auto json = std::make_shared<bool>(false);
  list->add_option("ID", *ids, "Kernels, or families such as `ggx`, to define (the default: a table of all)");
  list->add_flag("--json", *json, "As a JSON array");
  list->callback([ids, json] {
    const std::vector<std::size_t> kernels = SelectKernels(*ids);
    if (*json) {
      PrintJson(kernels);
    } else if (ids->empty()) {
      PrintTable(kernels);
    } else {
      for (const std::size_t kernel : kernels) PrintDefinition(kKernels[kernel]);
    }
  });
}

}  // namespace microlane
