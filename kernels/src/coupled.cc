#include "microlane/coupled.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/coupled.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/coupled-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <bool kValue, bool kPdf>
struct CoupledKernel {
  static constexpr std::string_view kId = kValue && kPdf ? "coupled.eval_pdf"
                                          : kValue       ? "coupled.eval"
                                                         : "coupled.pdf";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, V... v) {
    Coupled<kValue, kPdf, A>(d, static_cast<const AlbedoTable&>(*options.prepared), out.v0,
                             kValue ? out.v1 : out.v0, v...);
  }
};

struct SampleKernel {
  static constexpr std::string_view kId = "coupled.sample";
  template <Accuracy, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, V... v) {
    HWY_ALIGN T<D> in[sizeof...(V)][hn::MaxLanes(D())];
    HWY_ALIGN T<D> drawn[6][hn::MaxLanes(D())];
    std::size_t i = 0;
    (hn::Store(v, d, in[i++]), ...);
    SampleCoupled(d, static_cast<const AlbedoTable&>(*options.prepared), in, drawn);
    out.v0 = hn::Load(d, drawn[0]);
    out.v1 = hn::Load(d, drawn[1]);
    out.v2 = hn::Load(d, drawn[2]);
    out.v3 = hn::Load(d, drawn[3]);
    out.v4 = hn::Load(d, drawn[4]);
    out.v5 = hn::Load(d, drawn[5]);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<CoupledKernel<true, false>, CoupledKernel<false, true>, CoupledKernel<true, true>,
                SampleKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* CoupledTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace coupled {
namespace {

// NaN with a table of another lobe than the model's.
template <std::size_t kKernel, class T>
void RunWith(const AlbedoTable& table, CallBuilder<T>& call, Accuracy accuracy, std::size_t n) {
  call.In(table);
  if (IsWardLobe(table.lobe())) {
    call.template Run<kKernel>(CoupledTable(), accuracy, n);
  } else {
    call.FillWithNan(n);
  }
}

}  // namespace

template <class T>
void Eval(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> k,
          const AlbedoTable& table, T* f_cos, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(wi).In(wo).In(k).Out(f_cos);
  RunWith<KernelIndex("coupled.eval")>(table, call, accuracy, n);
}

template <class T>
void Pdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> k,
         const AlbedoTable& table, T* pdf, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(wi).In(wo).In(k).Out(pdf);
  RunWith<KernelIndex("coupled.pdf")>(table, call, accuracy, n);
}

template <class T>
void EvalPdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> k,
             const AlbedoTable& table, T* f_cos, T* pdf, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(wi).In(wo).In(k).Out(f_cos).Out(pdf);
  RunWith<KernelIndex("coupled.eval_pdf")>(table, call, accuracy, n);
}

template <class T>
void Sample(std::size_t n, const DirectionsOf<T>& wi, const T* u1, const T* u2, const T* u3, ParameterOf<T> k,
            const AlbedoTable& table, const DielectricSamples<T>& samples, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(wi).In(u1).In(u2).In(u3).In(k);
  call.Out(samples.wo).Out(samples.weight).Out(samples.pdf).Out(samples.lobe);
  RunWith<KernelIndex("coupled.sample")>(table, call, accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                          \
  template void Eval(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,         \
                     const AlbedoTable&, T*, Accuracy);                                                   \
  template void Pdf(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,          \
                    const AlbedoTable&, T*, Accuracy);                                                    \
  template void EvalPdf(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,      \
                        const AlbedoTable&, T*, T*, Accuracy);                                            \
  template void Sample(std::size_t, const DirectionsOf<T>&, const T*, const T*, const T*, ParameterOf<T>, \
                       const AlbedoTable&, const DielectricSamples<T>&, Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace coupled

}  // namespace microlane
#endif  // HWY_ONCE
