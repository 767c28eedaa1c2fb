#pragma once

#include <functional>
#include <memory>

namespace tarsus {

/// Calls body(i) for each i in [0, count), on all cores. The result must not depend on the order:
/// each i writes only what is its own. Sums go into one slot per i and are added up afterwards in
/// order, so that the bits do not depend on the number of threads.
/// An exception thrown by body is rethrown here (one of them, if several).
void parallelFor(int count, const std::function<void(int)>& body);

/// While it lives, parallelFor uses at most so many threads (of the processor's).
class ThreadLimit {
 public:
  explicit ThreadLimit(int threads);
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;
  ~ThreadLimit();

 private:
  struct Control;
  std::unique_ptr<Control> control_;
};

}  // namespace tarsus
