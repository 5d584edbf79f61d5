// The library's tables, as data for the oracle.
#include <memory>
#include <type_traits>

#include "microlane/albedo.h"
#include "microlane/prepared.h"
#include "microlane/radial_table.h"
#include "oracle/albedo.h"
#include "oracle/tabulated.h"

namespace microlane::oracle {
namespace {

template <class Table>
auto EntriesOf(std::size_t kernel, const double* values) {
  const auto table = std::static_pointer_cast<const Table>(Prepare(kernel, values));
  using Entries = std::remove_reference_t<decltype(table->entries())>;
  return table->ok() ? std::shared_ptr<Entries>(table, &table->entries()) : nullptr;
}

}  // namespace

std::shared_ptr<const AlbedoEntries> GivenEntries(std::size_t kernel, const double* values) {
  return EntriesOf<AlbedoTable>(kernel, values);
}

std::shared_ptr<const RadialEntries> GivenRadialEntries(std::size_t kernel, const double* values) {
  return EntriesOf<RadialTable>(kernel, values);
}

}  // namespace microlane::oracle
