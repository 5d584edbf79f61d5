#include "microlane/masking.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/masking.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/masking-inl.h"
#include "microlane/student_t-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct VCavityKernel {
  static constexpr std::string_view kId = "masking.v_cavity";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = VCavityG1<A>(d, in...);
  }
};

struct ImplicitKernel {
  static constexpr std::string_view kId = "masking.implicit";
  template <Accuracy, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = ImplicitG1(d, in...);
  }
};

struct SchlickSmithKernel {
  static constexpr std::string_view kId = "masking.schlick_smith";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = SchlickSmithG1<A>(d, in...);
  }
};

struct KelemenKernel {
  static constexpr std::string_view kId = "masking.kelemen";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = KelemenG1<A>(d, in...);
  }
};

template <JointForm kForm>
struct JointKernel {
  static constexpr std::string_view kId = kForm == JointForm::kSeparable ? "masking.separable"
                                          : kForm == JointForm::kHeight  ? "masking.height_correlated"
                                          : kForm == JointForm::kDirection
                                              ? "masking.direction_correlated"
                                              : "masking.height_direction_correlated";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = JointG2<kForm, A>(d, in...);
  }
};

struct TransmissionKernel {
  static constexpr std::string_view kId = "masking.height_correlated_transmission";
  template <Accuracy, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = TransmissionG2(d, in...);
  }
};

struct StudentLambdaKernel {
  static constexpr std::string_view kId = "masking.student_lambda";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                              Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> gamma) {
    out.v0 = StudentT<kIsFloat<D>>::template Lambda<A>(d, vx, vy, vz, gamma, alpha_x, alpha_y);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<VCavityKernel, ImplicitKernel, SchlickSmithKernel, KelemenKernel,
                JointKernel<JointForm::kSeparable>, JointKernel<JointForm::kHeight>,
                JointKernel<JointForm::kDirection>, JointKernel<JointForm::kHeightDirection>,
                TransmissionKernel, StudentLambdaKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* MaskingTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace masking {

namespace {

// A form of no parameter.
template <std::size_t kKernel, class T>
void OfFacet(std::size_t n, const Directions<T>& v, const Directions<T>& m, T* g1, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).Out(g1).template Run<kKernel>(MaskingTable(), accuracy, n);
}

// A joint form.
template <std::size_t kKernel, class T>
void OfLambdas(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2, Accuracy accuracy) {
  CallBuilder<T>().In(lambda_i).In(lambda_o).Out(g2).template Run<kKernel>(MaskingTable(), accuracy, n);
}

// A joint form of the directions' azimuths too.
template <std::size_t kKernel, class T>
void OfAzimuths(std::size_t n, const T* lambda_i, const T* lambda_o, const Directions<T>& wi,
                const Directions<T>& wo, T* g2, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(lambda_i).In(lambda_o).In(wi.x).In(wi.y).In(wo.x).In(wo.y).Out(g2);
  call.template Run<kKernel>(MaskingTable(), accuracy, n);
}

}  // namespace

template <class T>
void VCavity(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, T* g1, Accuracy accuracy) {
  OfFacet<KernelIndex("masking.v_cavity")>(n, v, m, g1, accuracy);
}

template <class T>
void Implicit(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, T* g1, Accuracy accuracy) {
  OfFacet<KernelIndex("masking.implicit")>(n, v, m, g1, accuracy);
}

template <class T>
void Kelemen(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, T* g1, Accuracy accuracy) {
  OfFacet<KernelIndex("masking.kelemen")>(n, v, m, g1, accuracy);
}

template <class T>
void SchlickSmith(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, ParameterOf<T> alpha, T* g1,
                  Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(alpha).Out(g1).template Run<KernelIndex("masking.schlick_smith")>(
      MaskingTable(), accuracy, n);
}

template <class T>
void Separable(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2, Accuracy accuracy) {
  OfLambdas<KernelIndex("masking.separable")>(n, lambda_i, lambda_o, g2, accuracy);
}

template <class T>
void HeightCorrelated(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2, Accuracy accuracy) {
  OfLambdas<KernelIndex("masking.height_correlated")>(n, lambda_i, lambda_o, g2, accuracy);
}

template <class T>
void HeightCorrelatedTransmission(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2,
                                  Accuracy accuracy) {
  OfLambdas<KernelIndex("masking.height_correlated_transmission")>(n, lambda_i, lambda_o, g2, accuracy);
}

template <class T>
void StudentLambda(std::size_t n, DirectionsOf<T> v, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
                   ParameterOf<T> gamma, T* lambda, Accuracy accuracy) {
  CallBuilder<T>()
      .In(v)
      .In(alpha_x)
      .In(alpha_y)
      .In(gamma)
      .Out(lambda)
      .template Run<KernelIndex("masking.student_lambda")>(MaskingTable(), accuracy, n);
}

template <class T>
void DirectionCorrelated(std::size_t n, const T* lambda_i, const T* lambda_o, DirectionsOf<T> wi,
                         DirectionsOf<T> wo, T* g2, Accuracy accuracy) {
  OfAzimuths<KernelIndex("masking.direction_correlated")>(n, lambda_i, lambda_o, wi, wo, g2, accuracy);
}

template <class T>
void HeightDirectionCorrelated(std::size_t n, const T* lambda_i, const T* lambda_o, DirectionsOf<T> wi,
                               DirectionsOf<T> wo, T* g2, Accuracy accuracy) {
  OfAzimuths<KernelIndex("masking.height_direction_correlated")>(n, lambda_i, lambda_o, wi, wo, g2, accuracy);
}

#define MICROLANE_INSTANTIATE(T)                                                                             \
  template void VCavity(std::size_t, Directions<T>, Directions<T>, T*, Accuracy);                            \
  template void Implicit(std::size_t, Directions<T>, Directions<T>, T*, Accuracy);                           \
  template void Kelemen(std::size_t, Directions<T>, Directions<T>, T*, Accuracy);                            \
  template void SchlickSmith(std::size_t, Directions<T>, Directions<T>, Parameter<T>, T*, Accuracy);         \
  template void Separable(std::size_t, const T*, const T*, T*, Accuracy);                                    \
  template void HeightCorrelated(std::size_t, const T*, const T*, T*, Accuracy);                             \
  template void HeightCorrelatedTransmission(std::size_t, const T*, const T*, T*, Accuracy);                 \
  template void StudentLambda(std::size_t, Directions<T>, Parameter<T>, Parameter<T>, Parameter<T>, T*,      \
                              Accuracy);                                                                     \
  template void DirectionCorrelated(std::size_t, const T*, const T*, Directions<T>, Directions<T>, T*,       \
                                    Accuracy);                                                               \
  template void HeightDirectionCorrelated(std::size_t, const T*, const T*, Directions<T>, Directions<T>, T*, \
                                          Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace masking

}  // namespace microlane
#endif  // HWY_ONCE
