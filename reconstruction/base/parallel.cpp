#include "reconstruction/base/parallel.h"

#include <exception>
#include <mutex>

namespace tarsus {

void parallelFor(int count, const std::function<void(int)>& body) {
  std::exception_ptr first_exception;
  std::mutex exception_mutex;
#pragma omp parallel for schedule(dynamic)
  for (int i = 0; i < count; ++i) {
    try {
      body(i);
    } catch (...) {
      const std::scoped_lock lock(exception_mutex);
      if (!first_exception) {
        first_exception = std::current_exception();
      }
    }
  }
  if (first_exception) {
    std::rethrow_exception(first_exception);
  }
}

}  // namespace tarsus
