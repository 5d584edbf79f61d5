// Views of a batch in structure-of-arrays form, and the choices that go with every batch call.
#ifndef MICROLANE_PACKETS_H_
#define MICROLANE_PACKETS_H_

#include <cstddef>
#include <type_traits>

namespace microlane {

// See kernel_list.h for the error bound of each kernel in each accuracy.
enum class Accuracy {
  kHigh,      // computed in double lanes, rounded once to float
  kStandard,  // float lanes, IEEE division and square root
  kFast,      // float lanes, approximate reciprocals and roots: relative error at most 2^-11
};

// What flows from wi to wo. Radiance: the BSDF of Walter 2007 Eq. 21 as printed, with its eta^2, for light
// that comes from wi. Importance: its adjoint, without eta^2, for paths traced from the camera, where wi
// points back along the path and wo towards the light.
enum class Transport { kRadiance, kImportance };

// n directions as three arrays of n components each, in the shading frame (z along the normal), pointing away
// from the surface. No alignment is needed.
template <class T>
struct Directions {
  const T* x;
  const T* y;
  const T* z;
};
template <class T>
Directions(const T*, const T*, const T*) -> Directions<T>;

template <class T>
struct MutableDirections {
  T* x;
  T* y;
  T* z;

  operator Directions<T>() const { return {x, y, z}; }  // NOLINT(google-explicit-constructor)
};
template <class T>
MutableDirections(T*, T*, T*) -> MutableDirections<T>;

// One parameter: a single value for the batch, or an array with one value per lane.
template <class T>
class Parameter {
 public:
  // Any number: 0 is no null pointer.
  template <class Number, class = std::enable_if_t<std::is_arithmetic_v<Number>>>
  Parameter(Number value) : value_(static_cast<T>(value)) {}  // NOLINT(google-explicit-constructor)
  Parameter(const T* lanes) : lanes_(lanes) {}                // NOLINT(google-explicit-constructor)
  bool uniform() const { return lanes_ == nullptr; }
  const T* data() const { return uniform() ? &value_ : lanes_; }

 private:
  T value_ = 0;
  const T* lanes_ = nullptr;
};

namespace packets_internal {
template <class View>
struct NotDeduced {
  using Type = View;
};
}  // namespace packets_internal

// How batch functions take a view: T is deduced from their outputs alone, so whatever converts to the view
// will do (braces, literals, pointers, MutableDirections for Directions).
template <class T>
using DirectionsOf = typename packets_internal::NotDeduced<Directions<T>>::Type;
template <class T>
using ParameterOf = typename packets_internal::NotDeduced<Parameter<T>>::Type;

class Prepared;  // prepared.h

// One batch call by position, as the kernel list orders inputs and outputs. Only the pointers that the kernel
// has are set and read: clearing the others would cost more than a short batch.
template <class T>
struct Call {
  const T* in[13];
  bool uniform[13] = {};  // in[k] is one value; only for inputs behind the list's '|'
  T* out[6];              // an output may be the same array as an input; other overlap is not allowed
  Transport transport = Transport::kRadiance;
  const Prepared* prepared = nullptr;  // of kernels with inputs behind the list's second bar
};

}  // namespace microlane

#endif  // MICROLANE_PACKETS_H_
