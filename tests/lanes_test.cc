// What every kernel promises about lanes and memory, whatever it computes: the rows tail, lane-independence,
// nan-in, alias, unaligned and flush of the stiff and extreme cases.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cfenv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <type_traits>
#include <vector>

#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/targets.h"
#include "points.h"

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace microlane {
namespace {

constexpr std::size_t kMostLanes = 16;  // of float, on any target here

template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t, std::uint64_t>;

template <class T>
Bits<T> BitsOf(T value) {
  Bits<T> bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

// Every kernel in one accuracy.
struct Mode {
  std::string_view name;
  Accuracy accuracy;
  bool double_lanes;
};
constexpr Mode kModes[] = {{"high", Accuracy::kHigh, false},
                           {"standard", Accuracy::kStandard, false},
                           {"fast", Accuracy::kFast, false},
                           {"double", Accuracy::kStandard, true}};

void RunMode(std::size_t kernel, const Mode& mode, const Call<float>& call, std::size_t n) {
  RunKernel(kernel, mode.accuracy, call, n);
}
void RunMode(std::size_t kernel, const Mode&, const Call<double>& call, std::size_t n) {
  RunKernel(kernel, call, n);
}

class TargetScope {
 public:
  explicit TargetScope(const std::string& target) : before_(ChosenTarget()) {
    EXPECT_EQ(ChooseTarget(target), "");
  }
  ~TargetScope() { ChooseTarget(before_); }

 private:
  const std::string before_;
};

// One array for each input or output.
template <class T>
using Arrays = std::vector<std::vector<T>>;

std::size_t NumInputs(std::size_t kernel) { return Split(kKernels[kernel].inputs).count; }
std::size_t NumOutputs(std::size_t kernel) { return Split(kKernels[kernel].outputs).count; }
std::size_t NumPerLane(std::size_t kernel) { return Split(kKernels[kernel].inputs).per_lane; }

template <class T>
Arrays<T> InputsOf(std::size_t kernel, std::size_t n, std::uint64_t seed = 21) {
  Arrays<T> in(NumInputs(kernel), std::vector<T>(n));
  const RandomPoints points(kernel, seed);
  for (std::size_t j = 0; j < n; ++j) {
    const Point point = points(j);
    for (std::size_t k = 0; k < in.size(); ++k) in[k][j] = static_cast<T>(point[k]);
  }
  return in;
}

template <class T>
Call<T> CallOf(const Arrays<T>& in, Arrays<T>& out) {
  Call<T> call;
  for (std::size_t k = 0; k < in.size(); ++k) call.in[k] = in[k].data();
  for (std::size_t i = 0; i < out.size(); ++i) call.out[i] = out[i].data();
  return call;
}

template <class T>
Arrays<T> Results(std::size_t kernel, const Mode& mode, const Arrays<T>& in) {
  Arrays<T> out(NumOutputs(kernel), std::vector<T>(in[0].size()));
  RunMode(kernel, mode, CallOf(in, out), in[0].size());
  return out;
}

template <class T>
std::string Where(std::size_t kernel, const Mode& mode, const Arrays<T>& in, std::size_t lane) {
  std::string text =
      std::string(kKernels[kernel].id) + " " + std::string(mode.name) + " " + ChosenTarget() + " at";
  for (const std::vector<T>& values : in) {
    char value[40];
    std::snprintf(value, sizeof value, " %a", static_cast<double>(values[lane]));
    text += value;
  }
  return text;
}

// Calls check(kernel, mode, T(0)) for every kernel and accuracy on every target.
template <class Check>
void ForEveryKernel(const Check& check) {
  for (const std::string& target : SupportedTargets()) {
    const TargetScope scope(target);
    for (std::size_t kernel = 0; kernel < kNumKernels; ++kernel) {
      for (const Mode& mode : kModes) {
        if (mode.double_lanes) {
          check(kernel, mode, 0.0);
        } else {
          check(kernel, mode, 0.0F);
        }
      }
    }
  }
}

template <class T>
bool SameBits(const T* a, const T* b, std::size_t n) {
  return n == 0 || std::memcmp(a, b, n * sizeof(T)) == 0;
}

// Up to `most` elements between two pages that may not be touched: they end where one begins, or begin where
// one ends.
template <class T>
class GuardedArray {
 public:
  GuardedArray(std::size_t most, bool at_end)
      : at_end_(at_end), page_(static_cast<std::size_t>(sysconf(_SC_PAGESIZE))) {
    inner_ = (most * sizeof(T) + page_ - 1) / page_ * page_;
    untouched_.assign(inner_, kCanary);
    void* all = mmap(nullptr, inner_ + 2 * page_, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    EXPECT_NE(all, MAP_FAILED);
    base_ = static_cast<unsigned char*>(all);
    EXPECT_EQ(mprotect(base_ + page_, inner_, PROT_READ | PROT_WRITE), 0);
    Resize(most);
  }
  ~GuardedArray() { munmap(base_, inner_ + 2 * page_); }
  GuardedArray(const GuardedArray&) = delete;
  GuardedArray& operator=(const GuardedArray&) = delete;

  // n elements, and nothing else, may be touched from now on.
  void Resize(std::size_t n) {
    n_ = n;
    begin_ = at_end_ ? inner_ - n * sizeof(T) : 0;
    std::memcpy(base_ + page_, untouched_.data(), inner_);
  }

  T* data() { return reinterpret_cast<T*>(base_ + page_ + begin_); }

  // Whether what lies between the elements and the far page is as it was.
  bool RestUntouched() const {
    const std::size_t end = begin_ + n_ * sizeof(T);
    return std::memcmp(base_ + page_, untouched_.data(), begin_) == 0 &&
           std::memcmp(base_ + page_ + end, untouched_.data(), inner_ - end) == 0;
  }

 private:
  static constexpr unsigned char kCanary = 0xA5;
  bool at_end_;
  std::size_t n_ = 0, page_, inner_, begin_ = 0;
  std::vector<unsigned char> untouched_;
  unsigned char* base_;
};

template <class T>
std::vector<std::unique_ptr<GuardedArray<T>>> GuardedArrays(std::size_t count, std::size_t most,
                                                            bool at_end) {
  std::vector<std::unique_ptr<GuardedArray<T>>> arrays;
  for (std::size_t k = 0; k < count; ++k) {
    arrays.push_back(std::make_unique<GuardedArray<T>>(most, at_end));
  }
  return arrays;
}

std::vector<std::size_t> Sizes() {
  std::vector<std::size_t> sizes;
  for (std::size_t n = 0; n <= 2 * kMostLanes + 1; ++n) sizes.push_back(n);
  for (const std::size_t n : {63, 64, 65, 127, 129, 257}) sizes.push_back(n);
  return sizes;
}

TEST(Lanes, TailTouchesExactlyNLanes) {
  constexpr std::size_t kMost = 257;
  std::size_t calls = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kMost);
    const Arrays<T> expected = Results(kernel, mode, in);
    for (const bool at_end : {true, false}) {
      const auto guarded_in = GuardedArrays<T>(in.size(), kMost, at_end);
      const auto guarded_out = GuardedArrays<T>(expected.size(), kMost, at_end);
      for (const std::size_t n : Sizes()) {
        Call<T> call;
        for (std::size_t k = 0; k < in.size(); ++k) {
          guarded_in[k]->Resize(n);
          std::copy(in[k].begin(), in[k].begin() + static_cast<std::ptrdiff_t>(n), guarded_in[k]->data());
          call.in[k] = guarded_in[k]->data();
        }
        for (std::size_t i = 0; i < expected.size(); ++i) {
          guarded_out[i]->Resize(n);
          call.out[i] = guarded_out[i]->data();
        }
        RunMode(kernel, mode, call, n);
        ++calls;
        for (std::size_t i = 0; i < expected.size(); ++i) {
          ASSERT_TRUE(guarded_out[i]->RestUntouched())
              << kKernels[kernel].id << " " << mode.name << " n = " << n;
          ASSERT_TRUE(SameBits(call.out[i], expected[i].data(), n))
              << "depends on n = " << n << ": " << kKernels[kernel].id << " " << mode.name << " "
              << ChosenTarget();
        }
        for (std::size_t k = 0; k < in.size(); ++k) {
          ASSERT_TRUE(guarded_in[k]->RestUntouched());
          ASSERT_TRUE(SameBits(call.in[k], in[k].data(), n)) << "input written";
        }
      }
    }
  });
  std::printf("[points] tail: %zu calls between guard pages\n", calls);
}

TEST(Lanes, NoLanesTouchNothing) {
  std::size_t calls = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    RunMode(kernel, mode, Call<T>(), 0);  // every pointer is null
    ++calls;
  });
  std::printf("[points] tail: %zu calls with n = 0 and null pointers\n", calls);
}

TEST(Lanes, UnalignedGivesTheSameBits) {
  constexpr std::size_t kLanes = 2 * kMostLanes + 5;
  std::size_t calls = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kLanes);
    const Arrays<T> expected = Results(kernel, mode, in);
    // All arrays at one offset from a multiple of 64 bytes, and each at its own.
    for (std::size_t step = 0; step < 128 / sizeof(T); ++step) {
      struct alignas(64) Storage {
        T values[kLanes + 64 / sizeof(T)];
      };
      std::vector<Storage> storage(in.size() + expected.size());
      const auto place = [&](std::size_t array) {
        const std::size_t offset = step < 64 / sizeof(T) ? step : 5 * array + step;
        return storage[array].values + offset % (64 / sizeof(T));
      };
      Call<T> call;
      for (std::size_t k = 0; k < in.size(); ++k) {
        std::copy(in[k].begin(), in[k].end(), place(k));
        call.in[k] = place(k);
      }
      for (std::size_t i = 0; i < expected.size(); ++i) call.out[i] = place(in.size() + i);
      RunMode(kernel, mode, call, kLanes);
      ++calls;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_TRUE(SameBits(call.out[i], expected[i].data(), kLanes))
            << kKernels[kernel].id << " " << mode.name << " " << ChosenTarget() << " offset "
            << step * sizeof(T);
      }
    }
  });
  std::printf("[points] unaligned: %zu calls, offsets 0 to 63 bytes\n", calls);
}

TEST(Lanes, IndependentOfOtherLanesAndOfPosition) {
  constexpr std::size_t kValues = 24;
  std::size_t tried = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    using Limits = std::numeric_limits<T>;
    const Arrays<T> values = InputsOf<T>(kernel, kValues);
    const Arrays<T> expected = Results(kernel, mode, values);
    const Arrays<T> others = InputsOf<T>(kernel, kMostLanes, 99);
    const T junk[] = {Limits::quiet_NaN(), Limits::infinity(), -Limits::infinity(), T(0),
                      Limits::max(),       Limits::lowest(),   Limits::denorm_min()};
    constexpr std::size_t kJunk = sizeof(junk) / sizeof(junk[0]);
    for (std::size_t kind = 0; kind <= kJunk; ++kind) {
      for (std::size_t j = 0; j < kValues; ++j) {
        const std::size_t position = (j + kind) % kMostLanes;
        Arrays<T> in = others;
        for (std::size_t k = 0; k < in.size(); ++k) {
          if (kind < kJunk) std::fill(in[k].begin(), in[k].end(), junk[kind]);
          in[k][position] = values[k][j];
        }
        const Arrays<T> got = Results(kernel, mode, in);
        ++tried;
        for (std::size_t i = 0; i < got.size(); ++i) {
          ASSERT_EQ(BitsOf(got[i][position]), BitsOf(expected[i][j]))
              << "lane " << position << " among others of kind " << kind << ": "
              << Where(kernel, mode, values, j);
        }
      }
    }
  });
  std::printf("[points] lane-independence: %zu values, each among NaN, infinities, zeros and garbage\n",
              tried);
}

TEST(Lanes, EveryPositionGivesTheSameBits) {
  constexpr std::size_t kLanes = 4 * kMostLanes;
  std::size_t tried = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kLanes);
    const Arrays<T> expected = Results(kernel, mode, in);
    for (std::size_t shift = 1; shift <= kMostLanes; ++shift) {
      Arrays<T> rotated = in;
      for (std::vector<T>& values : rotated) {
        std::rotate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(shift), values.end());
      }
      const Arrays<T> got = Results(kernel, mode, rotated);
      for (std::size_t i = 0; i < got.size(); ++i) {
        for (std::size_t j = 0; j < kLanes; ++j) {
          ASSERT_EQ(BitsOf(got[i][j]), BitsOf(expected[i][(j + shift) % kLanes]))
              << Where(kernel, mode, rotated, j);
          ++tried;
        }
      }
    }
  });
  std::printf("[points] lane-independence: %zu values in every position\n", tried);
}

TEST(Lanes, NanInGivesNanInThatLaneAlone) {
  constexpr std::size_t kLanes = kMostLanes;
  constexpr std::uint64_t kBatches = 8;
  std::size_t tried = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Names inputs = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
    std::set<std::string> bad;
    for (std::uint64_t batch = 0; batch < kBatches; ++batch) {
      const Arrays<T> in = InputsOf<T>(kernel, kLanes, 40 + batch);
      const Arrays<T> expected = Results(kernel, mode, in);
      for (std::size_t k = 0; k < in.size(); ++k) {
        Arrays<T> with_nan = in;
        const std::size_t lane = (3 * k + batch) % kLanes;
        with_nan[k][lane] = std::numeric_limits<T>::quiet_NaN();
        const Arrays<T> got = Results(kernel, mode, with_nan);
        ++tried;
        for (std::size_t i = 0; i < got.size(); ++i) {
          for (std::size_t j = 0; j < kLanes; ++j) {
            // 0 is right where the other inputs make it 0 by definition.
            const bool good = j != lane ? BitsOf(got[i][j]) == BitsOf(expected[i][j])
                                        : std::isnan(got[i][j]) || (got[i][j] == 0 && expected[i][j] == 0);
            if (good) continue;
            bad.insert(j != lane ? "another lane changes"
                                 : std::string(inputs.name[k]) + " NaN leaves " +
                                       std::string(outputs.name[i]) + " a number");
          }
        }
      }
    }
    std::string all;
    for (const std::string& text : bad) all += "; " + text;
    EXPECT_TRUE(bad.empty()) << kKernels[kernel].id << " " << mode.name << " " << ChosenTarget() << all;
  });
  std::printf("[points] nan-in: %zu batches with one NaN\n", tried);
}

TEST(Lanes, OutputsMayAliasInputs) {
  constexpr std::size_t kLanes = 5 * kMostLanes + 3;
  std::size_t calls = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kLanes);
    const Arrays<T> expected = Results(kernel, mode, in);
    // Output i over input i + shift, as far as there are inputs; the others apart.
    for (std::size_t shift = 0; shift < in.size(); ++shift) {
      Arrays<T> over = in, apart(expected.size(), std::vector<T>(kLanes));
      Call<T> call = CallOf(over, apart);
      for (std::size_t i = 0; i < std::min(expected.size(), in.size()); ++i) {
        call.out[i] = over[(i + shift) % in.size()].data();
      }
      RunMode(kernel, mode, call, kLanes);
      ++calls;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        ASSERT_TRUE(SameBits(call.out[i], expected[i].data(), kLanes))
            << "output " << i << ", shift " << shift << ": " << kKernels[kernel].id << " " << mode.name << " "
            << ChosenTarget();
      }
    }
  });
  std::printf("[points] alias: %zu calls with outputs over inputs\n", calls);
}

TEST(Lanes, UniformParametersGiveTheBitsOfPerLaneOnes) {
  constexpr std::size_t kLanes = 3 * kMostLanes + 7;
  std::size_t calls = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const std::size_t per_lane = NumPerLane(kernel), parameters = NumInputs(kernel) - per_lane;
    const Arrays<T> source = InputsOf<T>(kernel, kLanes);
    for (std::size_t set = 1; set < (std::size_t{1} << parameters); ++set) {
      for (const std::size_t from : {0, 1, 2, 3}) {
        Arrays<T> in = source;
        Arrays<T> out(NumOutputs(kernel), std::vector<T>(kLanes));
        for (std::size_t k = 0; k < parameters; ++k) {
          if ((set >> k & 1) == 0) continue;
          std::fill(in[per_lane + k].begin(), in[per_lane + k].end(), source[per_lane + k][from]);
        }
        const Arrays<T> expected = Results(kernel, mode, in);
        Call<T> call = CallOf(in, out);
        // The one value stands at the end of a page.
        std::vector<std::unique_ptr<GuardedArray<T>>> one_value;
        for (std::size_t k = 0; k < parameters; ++k) {
          if ((set >> k & 1) == 0) continue;
          one_value.push_back(std::make_unique<GuardedArray<T>>(1, true));
          one_value.back()->data()[0] = source[per_lane + k][from];
          call.uniform[per_lane + k] = true;
          call.in[per_lane + k] = one_value.back()->data();
        }
        RunMode(kernel, mode, call, kLanes);
        ++calls;
        for (std::size_t i = 0; i < out.size(); ++i) {
          for (std::size_t j = 0; j < kLanes; ++j) {
            ASSERT_EQ(BitsOf(out[i][j]), BitsOf(expected[i][j]))
                << "set " << set << ": " << Where(kernel, mode, in, j);
          }
        }
      }
    }
  });
  std::printf("[points] uniform: %zu calls\n", calls);
}

// FNV-1a over the bits of every output.
template <class T>
std::uint64_t Hash(const Arrays<T>& out) {
  std::uint64_t hash = 0xCBF29CE484222325u;
  for (const std::vector<T>& values : out) {
    for (const T value : values) {
      for (std::size_t byte = 0; byte < sizeof(T); ++byte) {
        hash = (hash ^ (BitsOf(value) >> (8 * byte) & 0xFF)) * 0x100000001B3u;
      }
    }
  }
  return hash;
}

template <class T>
void CompareTargets(std::size_t kernel, const Mode& mode, const std::vector<std::string>& targets,
                    std::size_t n) {
  Arrays<T> in = InputsOf<T>(kernel, n, 5);
  for (const ExtremeCase& extreme : ExtremeCases(kernel)) {
    for (std::size_t k = 0; k < in.size(); ++k) in[k].push_back(static_cast<T>(extreme.in[k]));
  }
  Arrays<T> first;
  for (const std::string& target : targets) {
    const TargetScope scope(target);
    const Arrays<T> got = Results(kernel, mode, in);
    std::printf("%s %016llx ", target.c_str(), static_cast<unsigned long long>(Hash(got)));
    if (first.empty()) first = got;
    std::size_t different = 0, where = 0;
    for (std::size_t i = 0; i < got.size(); ++i) {
      for (std::size_t j = 0; j < got[i].size(); ++j) {
        if (BitsOf(got[i][j]) != BitsOf(first[i][j]) && different++ == 0) where = j;
      }
    }
    EXPECT_EQ(different, 0u) << "of " << in[0].size() << " lanes differ from " << targets.front()
                             << ", first: " << Where(kernel, mode, in, where);
  }
}

TEST(Lanes, TargetsWithFmaAgreeBitForBit) {
  constexpr std::size_t kPoints = 20000;
  std::vector<std::string> targets;
  for (const std::string& target : SupportedTargets()) {
    if (TargetHasFma(target)) targets.push_back(target);
  }
  for (std::size_t kernel = 0; kernel < kNumKernels; ++kernel) {
    for (const Mode& mode : kModes) {
      if (mode.accuracy == Accuracy::kFast) continue;
      std::printf("[points] %s %s: %zu points and the extremes, ", std::string(kKernels[kernel].id).c_str(),
                  std::string(mode.name).c_str(), kPoints);
      if (mode.double_lanes) {
        CompareTargets<double>(kernel, mode, targets, kPoints);
      } else {
        CompareTargets<float>(kernel, mode, targets, kPoints);
      }
      std::printf("\n");
    }
  }
}

// Distance in floats, or doubles, of two finite numbers.
template <class T>
double Distance(T a, T b) {
  const auto ordinal = [](T x) {
    using Signed = std::make_signed_t<Bits<T>>;
    const auto bits = static_cast<Signed>(BitsOf(std::abs(x)));
    return static_cast<double>(std::signbit(x) ? -bits : bits);
  };
  return std::abs(ordinal(a) - ordinal(b));
}

#if defined(__SSE2__)
constexpr unsigned kFlushToZero = 0x8000, kDenormalsAreZero = 0x0040, kExceptionFlags = 0x003F;

// Sets the control word for as long as it lives.
class ControlScope {
 public:
  explicit ControlScope(unsigned control) : before_(_mm_getcsr()) { _mm_setcsr(control); }
  ~ControlScope() { _mm_setcsr(before_); }

 private:
  const unsigned before_;
};

TEST(Lanes, FlushingOfTheHostIsLeftAsFound) {
  constexpr std::size_t kLanes = 2000;
  std::size_t tried = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kLanes);
    for (const unsigned flags : {kFlushToZero, kDenormalsAreZero, kFlushToZero | kDenormalsAreZero}) {
      const unsigned control = (_mm_getcsr() | flags) & ~kExceptionFlags;
      const ControlScope scope(control);
      const Arrays<T> got = Results(kernel, mode, in);
      EXPECT_EQ(_mm_getcsr() & ~kExceptionFlags, control) << kKernels[kernel].id;
      for (std::size_t i = 0; i < got.size(); ++i) {
        for (std::size_t j = 0; j < kLanes; ++j) {
          ASSERT_TRUE(std::isfinite(got[i][j])) << Where(kernel, mode, in, j);
          ++tried;
        }
      }
    }
  });
  std::printf("[points] flush: %zu values with FTZ, DAZ and both\n", tried);
}

// With the host's flushing on, results that are normal numbers, of inputs that are, stay where they were.
TEST(Lanes, FlushingChangesSubnormalsAlone) {
  constexpr std::size_t kLanes = 2000;
  std::size_t tried = 0;
  double largest = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kLanes);
    const Arrays<T> expected = Results(kernel, mode, in);
    Arrays<T> got;
    {
      const ControlScope scope(_mm_getcsr() | kFlushToZero | kDenormalsAreZero);
      got = Results(kernel, mode, in);
    }
    const Bounds& bounds = kKernels[kernel].bounds;
    const double bound = mode.double_lanes                  ? bounds.double_lanes
                         : mode.accuracy == Accuracy::kFast ? static_cast<double>(bounds.fast)
                                                            : static_cast<double>(bounds.standard);
    const Names outputs = Split(kKernels[kernel].outputs);
    for (std::size_t j = 0; j < kLanes; ++j) {
      bool normal = true;
      for (const std::vector<T>& values : in) normal &= std::fpclassify(values[j]) != FP_SUBNORMAL;
      if (!normal) continue;
      for (std::size_t i = 0; i < got.size(); ++i) {
        if (std::abs(expected[i][j]) < 4 * std::numeric_limits<float>::min()) continue;
        const bool of_unit_vector = MetricOf(kKernels[kernel], outputs.name[i]) == Metric::kDirection;
        const double distance = of_unit_vector ? std::abs(static_cast<double>(got[i][j]) - expected[i][j]) /
                                                     static_cast<double>(std::numeric_limits<T>::epsilon())
                                               : Distance(got[i][j], expected[i][j]);
        largest = std::max(largest, distance);
        ASSERT_LE(distance, bound) << got[i][j] << " against " << expected[i][j] << ": "
                                   << Where(kernel, mode, in, j);
        ++tried;
      }
    }
  });
  std::printf("[points] flush: %zu normal values, largest change %g ulp\n", tried, largest);
}
#endif  // __SSE2__

TEST(Lanes, RoundingModeOfTheHostIsLeftAsFound) {
  constexpr std::size_t kLanes = 2000;
  std::size_t tried = 0;
  ForEveryKernel([&](std::size_t kernel, const Mode& mode, auto zero) {
    using T = decltype(zero);
    const Arrays<T> in = InputsOf<T>(kernel, kLanes);
    for (const int rounding : {FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
      ASSERT_EQ(std::fesetround(rounding), 0);
      const Arrays<T> got = Results(kernel, mode, in);
      const int after = std::fegetround();
      std::fesetround(FE_TONEAREST);
      EXPECT_EQ(after, rounding) << kKernels[kernel].id;
      for (std::size_t i = 0; i < got.size(); ++i) {
        for (std::size_t j = 0; j < kLanes; ++j) {
          ASSERT_TRUE(std::isfinite(got[i][j])) << "mode " << rounding << ": " << Where(kernel, mode, in, j);
          ++tried;
        }
      }
    }
  });
  std::printf("[points] flush: %zu values in the other rounding modes\n", tried);
}

// Several threads, while another switches among targets whose results agree bit for bit.
TEST(Lanes, CallsFromSeveralThreadsGiveTheSameBits) {
  constexpr std::size_t kLanes = 500, kThreads = 4;
  std::vector<Arrays<float>> in, expected;
  for (std::size_t kernel = 0; kernel < kNumKernels; ++kernel) {
    in.push_back(InputsOf<float>(kernel, kLanes));
    expected.push_back(Results(kernel, kModes[1], in.back()));
  }
  const TargetScope scope(ChosenTarget());
  std::vector<std::size_t> different(kThreads, 0);
  std::vector<std::thread> threads;
  threads.reserve(kThreads);
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      for (int repeat = 0; repeat < 20; ++repeat) {
        for (std::size_t i = 0; i < kNumKernels; ++i) {
          const std::size_t kernel = (i + t * 13) % kNumKernels;
          const Arrays<float> got = Results(kernel, kModes[1], in[kernel]);
          for (std::size_t o = 0; o < got.size(); ++o) {
            different[t] += !SameBits(got[o].data(), expected[kernel][o].data(), kLanes);
          }
        }
      }
    });
  }
  for (int i = 0; i < 1000; ++i) {
    for (const std::string& target : SupportedTargets()) {
      if (TargetHasFma(target)) ChooseTarget(target);
    }
    std::this_thread::yield();
  }
  for (std::thread& thread : threads) thread.join();
  for (std::size_t t = 0; t < kThreads; ++t) EXPECT_EQ(different[t], 0u) << "thread " << t;
  std::printf("[points] threads: %zu calls in %zu threads\n", kThreads * 20 * kNumKernels, kThreads);
}

}  // namespace
}  // namespace microlane
