// `microlane eval`: one kernel over lanes read as CSV.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/scalar/evaluate.h"
#include "microlane/targets.h"
#include "oracle/oracle.h"
#include "ulp.h"

namespace microlane {
namespace {

constexpr std::size_t kChunk = 4096;  // lanes per call

struct EvalOptions {
  std::string id, accuracy, target, transport = "radiance", input;
  bool decimal = false, double_lanes = false;
};

std::string_view Trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

float ParseNumber(const char* text, char** end, float) { return std::strtof(text, end); }
double ParseNumber(const char* text, char** end, double) { return std::strtod(text, end); }

// Lanes from CSV: blank lines and lines that begin with # are skipped, the first other line names the
// columns.
template <class T>
class Reader {
 public:
  Reader(std::istream& stream, std::size_t kernel)
      : stream_(stream), kernel_(kKernels[kernel]), inputs_(Split(kernel_.inputs)), columns_(inputs_.count) {
    if (!NextLine()) {
      Fail(fmt::format("no header line; kernel {} has the inputs {}", kernel_.id, InputNames()));
    }
    ReadHeader();
  }

  // Up to kChunk lanes into columns(); false at the end.
  bool ReadChunk() {
    for (auto& column : columns_) column.clear();
    while (columns_[0].size() < kChunk && NextLine()) ReadLane();
    return !columns_[0].empty();
  }

  const std::vector<std::vector<T>>& columns() const { return columns_; }

 private:
  [[noreturn]] void FailHere(const std::string& message) {
    Fail(fmt::format("line {}: {}", number_, message));
  }

  std::string InputNames() const {
    std::string names;
    for (std::size_t k = 0; k < inputs_.count; ++k) {
      names += (k == 0 ? "" : " ") + std::string(inputs_.name[k]);
    }
    return names;
  }

  bool NextLine() {
    while (std::getline(stream_, line_)) {
      ++number_;
      const std::string_view text = Trimmed(line_);
      if (!text.empty() && text[0] != '#') return true;
    }
    if (stream_.bad()) Fail(fmt::format("cannot read the input after line {}", number_));
    return false;
  }

  // Fields of line_, each ended by a 0 in place of its comma.
  void SplitFields() {
    fields_.clear();
    std::size_t begin = 0;
    for (;;) {
      const std::size_t comma = line_.find(',', begin);
      fields_.push_back(line_.data() + begin);
      if (comma == std::string::npos) break;
      line_[comma] = '\0';
      begin = comma + 1;
    }
  }

  void ReadHeader() {
    SplitFields();
    for (const char* field : fields_) {
      const std::string_view name = Trimmed(field);
      std::size_t k = 0;
      while (k < inputs_.count && inputs_.name[k] != name) ++k;
      if (k == inputs_.count) {
        FailHere(
            fmt::format("unknown column '{}'; kernel {} has the inputs {}", name, kernel_.id, InputNames()));
      }
      for (const std::size_t seen : order_) {
        if (seen == k) FailHere(fmt::format("column '{}' appears twice", name));
      }
      order_.push_back(k);
    }
    for (std::size_t k = 0; k < inputs_.count; ++k) {
      bool found = false;
      for (const std::size_t seen : order_) found = found || seen == k;
      if (!found) FailHere(fmt::format("column '{}' is missing", inputs_.name[k]));
    }
  }

  void ReadLane() {
    SplitFields();
    if (fields_.size() != order_.size()) {
      FailHere(fmt::format("{} field{} where the header has {}", fields_.size(),
                           fields_.size() == 1 ? "" : "s", order_.size()));
    }
    for (std::size_t f = 0; f < fields_.size(); ++f) {
      const std::string_view text = Trimmed(fields_[f]);
      const std::string_view name = inputs_.name[order_[f]];
      char* end = nullptr;
      const T value = ParseNumber(fields_[f], &end, T{});
      if (text.empty() || end != text.data() + text.size()) {
        FailHere(fmt::format("{}: '{}' is not a number", name, text));
      }
      if (std::isinf(value) && text.find_first_of("iI") == std::string_view::npos) {
        FailHere(fmt::format("{}: '{}' is too large", name, text));
      }
      columns_[order_[f]].push_back(value);
    }
  }

  std::istream& stream_;
  const Kernel& kernel_;
  const Names inputs_;
  std::vector<std::vector<T>> columns_;  // in the kernel list's order
  std::vector<std::size_t> order_;       // the input that each field is
  std::string line_;
  std::vector<const char*> fields_;
  std::size_t number_ = 0;
};

template <class Number>
void Append(fmt::memory_buffer& buffer, Number value, bool decimal) {
  const auto out = fmt::appender(buffer);
  if (std::isnan(value)) {
    fmt::format_to(out, "nan");
  } else if (decimal || std::isinf(value)) {
    fmt::format_to(out, "{}", value);
  } else {
    char text[40];
    std::snprintf(text, sizeof text, "%a", static_cast<double>(value));
    fmt::format_to(out, "{}", static_cast<const char*>(text));
  }
}

template <class T>
void RunLanes(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  if constexpr (sizeof(T) == 4) {
    RunKernel(kernel, accuracy, call, n);
  } else {
    (void)accuracy;
    RunKernel(kernel, call, n);
  }
}

// Reads T, computes and prints Number.
template <class T, class Number, class Run>
void EvalLanes(const EvalOptions& options, std::size_t kernel, std::istream& stream, const Run& run) {
  const Names outputs = Split(kKernels[kernel].outputs);
  Reader<T> reader(stream, kernel);
  for (std::size_t k = 0; k < outputs.count; ++k) fmt::print("{}{}", k == 0 ? "" : ",", outputs.name[k]);
  fmt::print("\n");
  std::vector<std::vector<Number>> results(outputs.count, std::vector<Number>(kChunk));
  fmt::memory_buffer buffer;
  while (reader.ReadChunk()) {
    const std::size_t n = reader.columns()[0].size();
    run(reader.columns(), results, n);
    buffer.clear();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < outputs.count; ++k) {
        if (k > 0) buffer.push_back(',');
        Append(buffer, results[k][i], options.decimal);
      }
      buffer.push_back('\n');
    }
    if (std::fwrite(buffer.data(), 1, buffer.size(), stdout) != buffer.size()) {
      Fail("cannot write to standard output");
    }
  }
}

template <class T>
void EvalOnTarget(const EvalOptions& options, std::size_t kernel, Transport transport, std::istream& stream) {
  const Accuracy accuracy = options.accuracy.empty() ? Accuracy::kStandard : ParseAccuracy(options.accuracy);
  EvalLanes<T, T>(options, kernel, stream, [&](const auto& in, auto& out, std::size_t n) {
    Call<T> call;
    call.transport = transport;
    for (std::size_t k = 0; k < in.size(); ++k) call.in[k] = in[k].data();
    for (std::size_t k = 0; k < out.size(); ++k) call.out[k] = out[k].data();
    RunLanes(kernel, accuracy, call, n);
  });
}

// One lane after the other, by function(inputs, outputs) on arrays of Number.
template <class T, class Number, class Function>
void EvalOneByOne(const EvalOptions& options, std::size_t kernel, std::istream& stream,
                  const Function& function) {
  EvalLanes<T, Number>(options, kernel, stream, [&](const auto& in, auto& out, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) {
      Number inputs[kMaxInputs] = {}, outputs[kMaxOutputs] = {};
      for (std::size_t k = 0; k < in.size(); ++k) inputs[k] = static_cast<Number>(in[k][i]);
      function(inputs, outputs);
      for (std::size_t k = 0; k < out.size(); ++k) out[k][i] = outputs[k];
    }
  });
}

template <class T>
void EvalDouble(const EvalOptions& options, std::size_t kernel, Transport transport, std::istream& stream) {
  const bool radiance = transport == Transport::kRadiance;
  if (options.target == "oracle") {
    EvalOneByOne<T, double>(options, kernel, stream, [&](const double* in, double* out) {
      const oracle::Result result = oracle::Evaluate(
          kernel, in, radiance ? oracle::Transport::kRadiance : oracle::Transport::kImportance);
      for (std::size_t k = 0; k < Split(kKernels[kernel].outputs).count; ++k) {
        out[k] = Rounded<double>(result.exact[k]);
      }
    });
  } else {
    EvalOneByOne<T, double>(options, kernel, stream, [&](const double* in, double* out) {
      scalar::Evaluate(kernel, in, out,
                       radiance ? scalar::Transport::kRadiance : scalar::Transport::kImportance);
    });
  }
}

void PrintTargets() {
  for (const std::string& name : SupportedTargets()) {
    fmt::print("{}{}\n", name, name == ChosenTarget() ? " (chosen)" : "");
  }
  fmt::print("scalar\nscalar-double\noracle\n");
}

void Eval(const EvalOptions& options) {
  if (options.target == "list") {
    UseTarget("");
    PrintTargets();
    return;
  }
  if (options.id.empty()) Fail("eval: which kernel? `microlane list` names them all");
  const std::size_t kernel = KernelIndex(options.id);
  if (kernel == kNumKernels) {
    Fail(fmt::format("unknown kernel '{}'; `microlane list` names them all", options.id));
  }
  if (options.transport != "radiance" && options.transport != "importance") {
    Fail(fmt::format("unknown transport '{}'; there are: radiance importance", options.transport));
  }
  const Transport transport = options.transport == "radiance" ? Transport::kRadiance : Transport::kImportance;
  const bool is_scalar = options.target == "scalar" || options.target == "scalar-double";
  const bool is_oracle = options.target == "oracle";
  if (!options.accuracy.empty()) {
    ParseAccuracy(options.accuracy);
    if (is_scalar || is_oracle) {
      Fail(fmt::format("--accuracy does not apply to the target {}", options.target));
    }
    if (options.double_lanes) Fail("--accuracy does not apply to double lanes, which have one");
  }
  if (!is_scalar && !is_oracle) {
    UseTarget(options.target, "; others: scalar scalar-double oracle");
  }

  std::ifstream file;
  if (!options.input.empty() && options.input != "-") {
    file.open(options.input);
    if (!file || std::filesystem::is_directory(options.input))
      Fail(fmt::format("cannot read {}", options.input));
  }
  std::ios::sync_with_stdio(false);
  std::istream& stream = file.is_open() ? file : std::cin;

  if (is_oracle || options.target == "scalar-double" || (is_scalar && options.double_lanes)) {
    options.double_lanes ? EvalDouble<double>(options, kernel, transport, stream)
                         : EvalDouble<float>(options, kernel, transport, stream);
  } else if (is_scalar) {
    EvalOneByOne<float, float>(options, kernel, stream, [&](const float* in, float* out) {
      scalar::Evaluate(
          kernel, in, out,
          transport == Transport::kRadiance ? scalar::Transport::kRadiance : scalar::Transport::kImportance);
    });
  } else {
    options.double_lanes ? EvalOnTarget<double>(options, kernel, transport, stream)
                         : EvalOnTarget<float>(options, kernel, transport, stream);
  }
}

}  // namespace

void AddEval(CLI::App& app) {
  CLI::App* eval = app.add_subcommand("eval", "One kernel over lanes read as CSV");
  auto options = std::make_shared<EvalOptions>();
  eval->add_option("ID", options->id, "The kernel, as `microlane list` names it");
  eval->add_option("--accuracy", options->accuracy, "high, standard (the default) or fast");
  eval->add_option(
      "--target", options->target,
      "An instruction set of this machine (the default: the best), or scalar, scalar-double, oracle; "
      "`list` lists them. scalar-double and oracle print doubles");
  eval->add_option("--transport", options->transport, "radiance (the default) or importance");
  eval->add_option("--input", options->input, "The CSV file (the default: standard input)");
  eval->add_flag("--decimal", options->decimal, "Print the shortest decimal numbers instead of hex floats");
  eval->add_flag("--double", options->double_lanes, "Read doubles and compute in double lanes");
  eval->footer(
      "The first line names the kernel's inputs, in any order; each line after it is one lane. Blank lines "
      "and lines\n"
      "that begin with # are skipped. Numbers are decimal or C hex floats, and are rounded once to float, "
      "whatever the\n"
      "target, so that all targets see the same input (to double with --double).");
  eval->callback([options] { Eval(*options); });
}

}  // namespace microlane
