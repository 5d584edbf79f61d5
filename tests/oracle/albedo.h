// Tables of kernels/microlane/albedo.h, whose entries are data: linear between them.
#ifndef MICROLANE_TESTS_ORACLE_ALBEDO_H_
#define MICROLANE_TESTS_ORACLE_ALBEDO_H_

#include <cstddef>
#include <memory>

#include "microlane/albedo_entries.h"
#include "oracle/real.h"

namespace microlane::oracle {

// The entries that kernel `kernel` of the list looks up, of the values of the inputs behind its second bar;
// null where they make none. They are part of the question, so whoever asks gives them: tests/tables.cc.
std::shared_ptr<const AlbedoEntries> GivenEntries(std::size_t kernel, const double* values);

// Node j of a table with cells of 1/32 of an octave above the offset c, as mu = (x - c)/(1 - c).
inline Real AlbedoNode(const AlbedoEntries& table, std::size_t j) {
  const Real c = table.offset, octave = ldexp(c, static_cast<int>(j / 32));
  return (octave * (1 + Real(j % 32) / 32) - c) / (1 - c);
}

// The node at or before |cosine|; that before the last for 1 and above.
inline std::size_t AlbedoNodeBefore(const AlbedoEntries& table, const Real& cosine) {
  const Real mu = abs(cosine);
  std::size_t low = 0, high = table.last;
  while (high - low > 1) {
    const std::size_t middle = (low + high) / 2;
    (AlbedoNode(table, middle) <= mu ? low : high) = middle;
  }
  return low;
}

// One of the table's curves at |cosine|.
inline Real AlbedoCurve(const AlbedoEntries& table, const float* entries, const Real& cosine) {
  const Real mu = abs(cosine) < 1 ? Real(abs(cosine)) : Real(1);
  const std::size_t j = AlbedoNodeBefore(table, mu);
  const Real mu0 = AlbedoNode(table, j), mu1 = AlbedoNode(table, j + 1);
  return entries[j] + (mu - mu0) / (mu1 - mu0) * (Real(entries[j + 1]) - entries[j]);
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_ALBEDO_H_
