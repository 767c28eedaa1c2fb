#include "reconstruction/base/parallel.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <exception>
#include <mutex>

namespace tarsus {

void parallelFor(int count, const std::function<void(int)>& body) {
  std::exception_ptr first_exception;
  std::mutex exception_mutex;
  const auto guarded = [&](int i) {
    try {
      body(i);
    } catch (...) {
      const std::scoped_lock lock(exception_mutex);
      if (!first_exception) {
        first_exception = std::current_exception();
      }
    }
  };
  tbb::parallel_for(0, count, guarded, tbb::simple_partitioner());
  if (first_exception) {
    std::rethrow_exception(first_exception);
  }
}

struct ThreadLimit::Control {
  tbb::global_control limit;
};

ThreadLimit::ThreadLimit(int threads)
    : control_(new Control{tbb::global_control(tbb::global_control::max_allowed_parallelism,
                                               static_cast<std::size_t>(threads))}) {}
ThreadLimit::~ThreadLimit() = default;

}  // namespace tarsus
