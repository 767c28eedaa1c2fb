#include "ui/work/store_thread.h"

namespace tarsus {

StoreThread::~StoreThread() {
  {
    const std::scoped_lock lock(mutex_);
    stopping_ = true;
  }
  wake_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

void StoreThread::start(StorePlace place,
                        StoreEnvironment environment,
                        std::function<void(Expected<Store>&)> opened) {
  if (thread_.joinable()) {
    thread_.join();  // of an attempt that failed
  }
  thread_ = std::thread([this,
                         place = std::move(place),
                         environment = std::move(environment),
                         opened = std::move(opened)] {
    auto store = Store::open(place, environment);
    opened(store);
    if (store) {
      run(*store);
    }
  });
}

void StoreThread::post(Task task) {
  {
    const std::scoped_lock lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  wake_.notify_one();
}

void StoreThread::run(Store& store) {
  while (true) {
    Task task;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
      if (tasks_.empty()) {
        return;
      }
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task(store);
  }
}

}  // namespace tarsus
