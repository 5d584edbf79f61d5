// GGX in batches: the calls of normals.h, with visible normals. Walter 2007 Eqs. 33-36; Heitz 2014 Eqs.
// 70-72, 84-86.
#ifndef MICROLANE_GGX_H_
#define MICROLANE_GGX_H_

#include "microlane/normals.h"

namespace microlane {

using ggx = ShapeInvariantCalls<Normals::kGgx>;

}  // namespace microlane

#endif  // MICROLANE_GGX_H_
