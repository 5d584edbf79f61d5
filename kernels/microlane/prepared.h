// What a call takes whole: an object made once from checked parameters and taken by any number of calls.
#ifndef MICROLANE_PREPARED_H_
#define MICROLANE_PREPARED_H_

#include <cstddef>
#include <memory>
#include <string>
#include <utility>

namespace microlane {

class Prepared {
 public:
  bool ok() const { return error_.empty(); }
  // What is wrong with the parameters, else empty; then the object holds nothing, and what is computed with
  // it is NaN.
  const std::string& error() const { return error_; }

 protected:
  explicit Prepared(std::string error) : error_(std::move(error)) {}
  void SetError(std::string error) { error_ = std::move(error); }
  ~Prepared() = default;
  Prepared(const Prepared&) = default;
  Prepared& operator=(const Prepared&) = default;

 private:
  std::string error_;
};

// For tools and tests, which are driven by the kernel list: the object that kernel `kernel` takes, of the
// values of the inputs behind the list's second bar. The last ones made are kept and given again.
// Thread-safe.
std::shared_ptr<const Prepared> Prepare(std::size_t kernel, const double* values);

}  // namespace microlane

#endif  // MICROLANE_PREPARED_H_
