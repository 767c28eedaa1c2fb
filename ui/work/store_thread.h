#pragma once

#include "measurement/records/store.h"
#include "reconstruction/base/error.h"

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>

namespace tarsus {

/// The records' own thread: a Store belongs to the thread that opened it, and no window waits for
/// it. Tasks are done one after the other, in order; those still waiting at the end are done too,
/// so that nothing that was confirmed is lost.
class StoreThread {
 public:
  using Task = std::function<void(Store&)>;

  StoreThread() = default;
  StoreThread(const StoreThread&) = delete;
  StoreThread& operator=(const StoreThread&) = delete;
  ~StoreThread();

  /// @param opened  is called in that thread with what came of it
  void start(StorePlace place,
             StoreEnvironment environment,
             std::function<void(Expected<Store>&)> opened);
  /// Tasks before start(), or after it failed, are never done.
  void post(Task task);

 private:
  void run(Store& store);

  std::mutex mutex_;
  std::condition_variable wake_;
  std::deque<Task> tasks_;
  bool stopping_ = false;
  std::thread thread_;
};

}  // namespace tarsus
