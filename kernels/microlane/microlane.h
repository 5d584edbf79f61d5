// Everything a user of batch calls needs.
#ifndef MICROLANE_MICROLANE_H_
#define MICROLANE_MICROLANE_H_

#include "microlane/albedo.h"               // IWYU pragma: export
#include "microlane/beckmann.h"             // IWYU pragma: export
#include "microlane/coupled.h"              // IWYU pragma: export
#include "microlane/fresnel.h"              // IWYU pragma: export
#include "microlane/gaussian.h"             // IWYU pragma: export
#include "microlane/ggx.h"                  // IWYU pragma: export
#include "microlane/half_vector.h"          // IWYU pragma: export
#include "microlane/half_vector_density.h"  // IWYU pragma: export
#include "microlane/interfaced.h"           // IWYU pragma: export
#include "microlane/kernel_list.h"          // IWYU pragma: export
#include "microlane/masking.h"              // IWYU pragma: export
#include "microlane/material.h"             // IWYU pragma: export
#include "microlane/mean_fresnel.h"         // IWYU pragma: export
#include "microlane/packets.h"              // IWYU pragma: export
#include "microlane/phong.h"                // IWYU pragma: export
#include "microlane/prepared.h"             // IWYU pragma: export
#include "microlane/quadrature.h"           // IWYU pragma: export
#include "microlane/rough_dielectric.h"     // IWYU pragma: export
#include "microlane/rough_diffuse.h"        // IWYU pragma: export
#include "microlane/rough_reflector.h"      // IWYU pragma: export
#include "microlane/roughness.h"            // IWYU pragma: export
#include "microlane/student_t.h"            // IWYU pragma: export
#include "microlane/tabulated.h"            // IWYU pragma: export
#include "microlane/targets.h"              // IWYU pragma: export
#include "microlane/v_cavity.h"             // IWYU pragma: export

#endif  // MICROLANE_MICROLANE_H_
