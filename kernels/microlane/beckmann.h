// Beckmann in batches: the calls of normals.h. Walter 2007 Eqs. 25-29; Heitz 2014 Eqs. 67-69, 81-83.
#ifndef MICROLANE_BECKMANN_H_
#define MICROLANE_BECKMANN_H_

#include <cstddef>

#include "microlane/normals.h"

namespace microlane {

struct beckmann : ShapeInvariantCalls<Normals::kBeckmann> {
  // G1 by a rational function, within 0.313% of the exact one and at most 1. Errors are against the rational
  // function. Walter 2007 Eq. 27, stretched. beckmann.G1_rational.
  template <class T>
  static void G1Rational(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m,
                         ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, T* g1,
                         Accuracy accuracy = Accuracy::kStandard) {
    Run<KernelIndex("beckmann.G1_rational")>(CallBuilder<T>().In(v).In(m).In(alpha_x).In(alpha_y).Out(g1),
                                             accuracy, n);
  }

  // SampleNormal with both alphas widened by 1.2 - 0.2 sqrt(|cos_i|), which tames the weights at grazing; pdf
  // is that of the widened D. Walter 2007 section 5.3. beckmann.sample_normal_widened.
  template <class T>
  static void SampleNormalWidened(std::size_t n, const T* u1, const T* u2, const T* cos_i,
                                  ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, MutableDirections<T> m,
                                  T* pdf, Accuracy accuracy = Accuracy::kStandard) {
    Run<KernelIndex("beckmann.sample_normal_widened")>(
        CallBuilder<T>().In(u1).In(u2).In(cos_i).In(alpha_x).In(alpha_y).Out(m).Out(pdf), accuracy, n);
  }

 private:
  template <std::size_t kKernel, class T>
  static void Run(const CallBuilder<T>& call, Accuracy accuracy, std::size_t n) {
    call.template Run<kKernel>(NormalsCode<Normals::kBeckmann>(), accuracy, n);
  }
};

}  // namespace microlane

#endif  // MICROLANE_BECKMANN_H_
