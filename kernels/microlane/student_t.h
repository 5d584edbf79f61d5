// Student-T, also called GTR, in batches: the calls of normals.h with gamma, from 1.55 to 1e10, before the
// roughness. Slopes of density 1/(pi alpha_x alpha_y) (1 + (x^2/alpha_x^2 + y^2/alpha_y^2)/(gamma -
// 1))^-gamma: GGX at gamma = 2, Beckmann as gamma grows, longer tails below 2. d'Eon 2023; Burley 2012.
#ifndef MICROLANE_STUDENT_T_H_
#define MICROLANE_STUDENT_T_H_

#include "microlane/normals.h"

namespace microlane {

using student_t = ShapeInvariantCalls<Normals::kStudentT, Parameter>;

}  // namespace microlane

#endif  // MICROLANE_STUDENT_T_H_
