#include "microlane/interfaced.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/interfaced.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/interfaced-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct FacetBodyKernel {
  static constexpr std::string_view kId = "interfaced.facet_body";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_i, Vec<D> cos_o,
                              Vec<D> n_i, Vec<D> k) {
    Vec<D> unused;
    Precisely<FacetBodyOp, A>(d, out.v0, unused, cos_i, cos_o, n_i, k);
  }
};

FamilyCode FamilyOnTarget() { return Family<FacetBodyKernel>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* InterfacedTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace interfaced {

template <class T>
void FacetBody(std::size_t n, const T* cos_i, const T* cos_o, const Body<T>& body, T* f, Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(cos_o)
      .In(body.n_i)
      .In(body.k)
      .Out(f)
      .template Run<KernelIndex("interfaced.facet_body")>(InterfacedTable(), accuracy, n);
}

template void FacetBody(std::size_t, const float*, const float*, const Body<float>&, float*, Accuracy);
template void FacetBody(std::size_t, const double*, const double*, const Body<double>&, double*, Accuracy);

}  // namespace interfaced

}  // namespace microlane
#endif  // HWY_ONCE
