// The entry of a distribution's object. Includes no Highway.
#ifndef MICROLANE_SRC_NORMALS_CALL_H_
#define MICROLANE_SRC_NORMALS_CALL_H_

#include <cstddef>

#include "microlane/normals.h"
#include "src/dispatch.h"

namespace microlane {

template <Normals kNormals, class T>
void RunFrom(const NormalsCode<kNormals>&, std::size_t kernel, Accuracy accuracy, const Call<T>& call,
             std::size_t n) {
  RunFrom(NormalsTable<kNormals>(), kernel, accuracy, call, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_NORMALS_CALL_H_
