// From a typed call to the library's: what the headers of the families are written with.
#ifndef MICROLANE_CALL_H_
#define MICROLANE_CALL_H_

#include <algorithm>
#include <cstddef>
#include <limits>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/prepared.h"

namespace microlane {

// Builds a Call from a public function's arguments, in the kernel list's order.
template <class T>
class CallBuilder {
 public:
  CallBuilder() {}  // NOLINT(modernize-use-equals-default): value initialisation would clear call_ first

  CallBuilder& In(const T* lanes) {
    call_.in[inputs_++] = lanes;
    return *this;
  }
  CallBuilder& In(const Directions<T>& v) { return In(v.x).In(v.y).In(v.z); }
  // The parameter must outlive the call.
  CallBuilder& In(const Parameter<T>& p) {
    call_.uniform[inputs_] = p.uniform();
    return In(p.data());
  }
  // The object must outlive the call.
  CallBuilder& In(const Prepared& prepared) {
    call_.prepared = &prepared;
    return *this;
  }
  CallBuilder& Out(T* lanes) {
    call_.out[outputs_++] = lanes;
    return *this;
  }
  CallBuilder& Out(const MutableDirections<T>& v) { return Out(v.x).Out(v.y).Out(v.z); }
  CallBuilder& With(Transport transport) {
    call_.transport = transport;
    return *this;
  }
  // kKernel: index in the kernel list; code: where RunFrom finds it. Of an object that is not ok, all is NaN.
  template <std::size_t kKernel, class Code>
  void Run(const Code& code, Accuracy accuracy, std::size_t n) const {
    static_assert(kKernel < kNumKernels, "the kernel list has no such quantity");
    if constexpr (TakesPrepared(kKernel)) {
      if (!call_.prepared->ok()) {
        FillWithNan(n);
        return;
      }
    }
    RunFrom(code, kKernel, accuracy, call_, n);
  }

  // NaN into n lanes of every output.
  void FillWithNan(std::size_t n) const {
    for (int k = 0; k < outputs_; ++k) std::fill_n(call_.out[k], n, std::numeric_limits<T>::quiet_NaN());
  }

 private:
  Call<T> call_;
  int inputs_ = 0, outputs_ = 0;
};

}  // namespace microlane

#endif  // MICROLANE_CALL_H_
