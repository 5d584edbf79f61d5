#include "src/dispatch.h"

#include <cctype>
#include <cstdlib>

#include "hwy/highway.h"
#include "microlane/targets.h"

namespace microlane {
namespace {

std::size_t TableIndex(std::int64_t target) {
  if ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0) return 0;  // one target: HWY_EXPORT makes a table of one
  hwy::ChosenTarget chosen;
  chosen.Update(target);
  return chosen.GetIndex();
}

std::int64_t TargetByName(std::string_view name) {
  std::string upper(name);
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    if (upper.empty() || upper == "BEST" || upper == hwy::TargetName(target)) return target;
  }
  return 0;
}

std::string UnknownTarget(std::string_view name) {
  std::string message = "unknown target '" + std::string(name) + "'; this machine runs:";
  for (const std::string& known : SupportedTargets()) message += " " + known;
  return message;
}

std::int64_t InitialTarget() {
  const char* name = std::getenv("MICROLANE_TARGET");
  const std::int64_t target = name != nullptr ? TargetByName(name) : 0;
  return target != 0 ? target : TargetByName("best");
}

// The first use makes the initial choice, of target and index.
std::atomic<std::int64_t>& Chosen() {
  static std::atomic<std::int64_t> chosen = [] {
    const std::int64_t target = InitialTarget();
    chosen_table_index.store(TableIndex(target), std::memory_order_relaxed);
    return target;
  }();
  return chosen;
}

}  // namespace

std::atomic<std::size_t> chosen_table_index{kNotChosen};

std::size_t ChooseInitialTarget() {
  Chosen();
  return chosen_table_index.load(std::memory_order_relaxed);
}

std::vector<std::string> SupportedTargets() {
  std::vector<std::string> names;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets())
    names.emplace_back(hwy::TargetName(target));
  return names;
}

std::string ChosenTarget() { return hwy::TargetName(Chosen().load()); }

std::string ChooseTarget(std::string_view name) {
  const std::int64_t target = TargetByName(name);
  if (target == 0) return UnknownTarget(name);
  Chosen().store(target);
  chosen_table_index.store(TableIndex(target));
  return "";
}

std::string TargetEnvironmentError() {
  const char* name = std::getenv("MICROLANE_TARGET");
  return name == nullptr || TargetByName(name) != 0 ? "" : "MICROLANE_TARGET: " + UnknownTarget(name);
}

bool TargetHasFma(std::string_view name) {
  const std::int64_t target = TargetByName(name);
#if HWY_ARCH_X86
  return target != 0 && target <= HWY_AVX2;
#else
  return target != HWY_SCALAR && target != HWY_EMU128;
#endif
}

}  // namespace microlane
