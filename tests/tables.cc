// The library's tables, as data for the oracle.
#include <memory>

#include "microlane/albedo.h"
#include "microlane/prepared.h"
#include "oracle/albedo.h"

namespace microlane::oracle {

std::shared_ptr<const AlbedoEntries> GivenEntries(std::size_t kernel, const double* values) {
  const auto table = std::static_pointer_cast<const AlbedoTable>(Prepare(kernel, values));
  return table->ok() ? std::shared_ptr<const AlbedoEntries>(table, &table->entries()) : nullptr;
}

}  // namespace microlane::oracle
