// A distribution of slopes that the user gives as a radial function, in batches: the calls of normals.h with
// a RadialTable before the roughness. Errors are those declared for tabulated.<id>, against the table's
// entries; of those themselves the table says. Of a table that is not ok, all is NaN. Heitz 2014 Eqs. 65,
// 73, 87.
#ifndef MICROLANE_TABULATED_H_
#define MICROLANE_TABULATED_H_

#include "microlane/normals.h"
#include "microlane/radial_table.h"

namespace microlane {

template <class T>
using RadialTableOf = RadialTable;  // the same for all T

using tabulated = ShapeInvariantCalls<Normals::kTabulated, RadialTableOf>;

}  // namespace microlane

#endif  // MICROLANE_TABULATED_H_
