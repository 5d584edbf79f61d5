// The coupled specular-matte model of Kelemen 2001 in batches: Ward's P_H over a dielectric (Eqs. 3, 4), and
// a matte part k s (1 - a(theta)) (1 - a(theta')) that takes what the specular albedo a leaves (Eqs. 6, 7),
// both from one table.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, against the formulas with the table's entries; NaN in gives
// NaN out in that lane. Of a table that is not ok, or not of a WardLobe, all is NaN.
//
// Light comes from wi and leaves to wo on the same side of the surface, above or below; 0 otherwise. k, the
// colour of the matte part, lies in [0, 1]; at 1 nothing is lost.
#ifndef MICROLANE_COUPLED_H_
#define MICROLANE_COUPLED_H_

#include <cstddef>

#include "microlane/albedo.h"
#include "microlane/packets.h"
#include "microlane/rough_dielectric.h"

namespace microlane::coupled {

// f |cos(theta_o)|. coupled.eval.
template <class T>
void Eval(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> k,
          const AlbedoTable& table, T* f_cos, Accuracy accuracy = Accuracy::kStandard);

// The density with which Sample finds wo: its integral is the probability that it finds any. coupled.pdf.
template <class T>
void Pdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> k,
         const AlbedoTable& table, T* pdf, Accuracy accuracy = Accuracy::kStandard);

// Both in one call. coupled.eval_pdf.
template <class T>
void EvalPdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> k,
             const AlbedoTable& table, T* f_cos, T* pdf, Accuracy accuracy = Accuracy::kStandard);

// Directions from uniform numbers in [0, 1): u3 chooses the specular part (lobe 1) with probability a(wi),
// the matte one (lobe 2) with k (1 - a(wi)), or none (lobe 0, and every output 0). pdf is the density of both
// parts together, weight f |cos(theta_o)| over it. coupled.sample.
template <class T>
void Sample(std::size_t n, const DirectionsOf<T>& wi, const T* u1, const T* u2, const T* u3, ParameterOf<T> k,
            const AlbedoTable& table, const DielectricSamples<T>& samples,
            Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::coupled

#endif  // MICROLANE_COUPLED_H_
