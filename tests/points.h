// Inputs for every entry of the kernel list: adversarial random points, structured grids and the rows of the
// stiff and extreme cases.
#ifndef MICROLANE_TESTS_POINTS_H_
#define MICROLANE_TESTS_POINTS_H_

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "microlane/kernel_list.h"

namespace microlane {

// One value for each input, in the kernel list's order; 0 beyond the last.
using Point = std::array<double, kMaxInputs>;

enum class Values {
  kFloats,   // every value is a float
  kDoubles,  // any double
};

// splitmix64: a stream of numbers for each pair of seed and index.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t index = 0) : state_(Mix(seed) + Mix(~index)) {}

  std::uint64_t Bits() { return Mix(state_ += 0x9E3779B97F4A7C15u); }
  // In [0, 1), a multiple of 2^-53.
  double Uniform() { return static_cast<double>(Bits() >> 11) * 0x1p-53; }
  bool Chance(double probability) { return Uniform() < probability; }
  int Index(int count) { return static_cast<int>(Uniform() * count); }
  double Sign() { return Chance(0.5) ? 1 : -1; }
  double LogUniform(double low, double high) {
    const double from = std::log2(low);
    return std::exp2(from + Uniform() * (std::log2(high) - from));
  }

 private:
  static std::uint64_t Mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

// Every value an input can take, by its place in kInputs; what a point of any kernel is cut from.
using Scene = std::array<double, sizeof(kInputs) / sizeof(kInputs[0])>;

// A seed of a kernel's name, so that its points stay the same whatever else the list holds: FNV-1a.
constexpr std::uint64_t SeedOf(std::string_view id) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const char c : id) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001B3u;
  return hash;
}

// Random points of one kernel, where it is hard: lobes, their edges and tails, grazing, mirrored, opposite
// and refracted pairs, critical and Brewster's angles, indices near 1, edges of the random numbers. Values
// are within the domains of the kernel list, directions are unit vectors to a few roundings. A point depends
// on the kernel's id, the seed and its index alone.
class RandomPoints {
 public:
  RandomPoints(std::size_t kernel, std::uint64_t seed, Values values = Values::kFloats);
  Point operator()(std::uint64_t index) const;

 private:
  std::size_t kernel_;
  std::uint64_t seed_;
  Values values_;
};

// How many times fewer points than others a kernel takes whose oracle is slow: it sums over normals, or finds
// visible slopes and inverse functions step by step.
constexpr std::size_t OracleCost(std::size_t kernel) {
  const std::string_view id = kKernels[kernel].id;
  const auto has = [&](std::string_view part) { return id.find(part) != id.npos; };
  if (TakesPrepared(kernel) && (has("mean_fresnel") || has("rough_diffuse") || has("interfaced_body"))) {
    return 10;
  }
  if (has("beckmann") || has("tabulated"))
    return has("sample_visible") || has("sample_with") ? 10 : has("sample") ? 3 : 1;
  return 1;
}

// About `count` points, evenly spread over the product of a few dozen values of each quantity.
std::vector<Point> GridPoints(std::size_t kernel, std::size_t count);

// One input of a row of the stiff and extreme cases.
struct ExtremeCase {
  std::string_view row;   // the id of the row
  std::string_view what;  // which of its cases
  Point in;
};

// The rows that apply to a kernel, each with all its cases.
std::vector<ExtremeCase> ExtremeCases(std::size_t kernel);

// `in` with one to three of its values moved by a few floats (or doubles) or by a small factor, directions
// kept unit vectors to a few roundings and values within their domains.
Point Perturbed(std::size_t kernel, const Point& in, Random& random, Values values);

}  // namespace microlane

#endif  // MICROLANE_TESTS_POINTS_H_
