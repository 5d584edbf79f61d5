// The instruction sets this machine can run, and the choice among them.
#ifndef MICROLANE_TARGETS_H_
#define MICROLANE_TARGETS_H_

#include <string>
#include <string_view>
#include <vector>

namespace microlane {

// Names of the targets compiled in and supported here, best first. Thread-safe.
std::vector<std::string> SupportedTargets();

// The target that batch calls use. Initially the best, or the one that the environment variable
// MICROLANE_TARGET names. Thread-safe.
std::string ChosenTarget();

// Makes batch calls use `name` ("AVX3", "avx2", ...; "" or "best": the best). Empty on success, else a
// message that lists the known names; the choice is then unchanged. Thread-safe; calls already running finish
// on their target.
std::string ChooseTarget(std::string_view name);

// Message about a MICROLANE_TARGET that names no supported target (the best is used then), else empty.
std::string TargetEnvironmentError();

// Whether the target has a fused multiply-add, that is, which of the kernel list's bounds hold.
bool TargetHasFma(std::string_view name);

}  // namespace microlane

#endif  // MICROLANE_TARGETS_H_
