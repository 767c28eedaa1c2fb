#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/base/job.h"

#include <QObject>
#include <QPointer>

#include <atomic>
#include <functional>
#include <memory>
#include <thread>

namespace tarsus {

/// One long piece of work beside the window: progress and result arrive in the window's thread.
class BackgroundJob : public QObject {
  Q_OBJECT

 public:
  explicit BackgroundJob(QObject* parent = nullptr) : QObject(parent) {}
  ~BackgroundJob() override { cancel(); }

  /// Cancels and waits for what was running; its result is dropped.
  template <typename Result>
  void start(std::function<Expected<Result>(const Job&)> work,
             std::function<void(Expected<Result>)> then) {
    cancel();
    thread_ = {};
    running_ = true;
    busy_ = true;
    const int round = ++round_;
    thread_ = std::jthread([this, round, work = std::move(work), then = std::move(then)](
                               const std::stop_token& stop) {
      const Job job{
          .stop = stop, .report = [this, round](std::string_view stage, double fraction) {
            tell(round, QString::fromUtf8(stage.data(), static_cast<int>(stage.size())), fraction);
          }};
      auto result = std::make_shared<Expected<Result>>(attempt<Result>(work, job));
      busy_ = false;
      QMetaObject::invokeMethod(
          this,
          [this, round, result, then] {
            if (round == round_) {
              running_ = false;
              then(std::move(*result));
            }
          },
          Qt::QueuedConnection);
    });
  }
  void cancel() {
    thread_.request_stop();
    if (running_) {
      ++round_;  // what still comes of it is not asked for any more
      running_ = false;
    }
  }
  [[nodiscard]] bool running() const { return running_; }
  /// Was cancelled and has not ended yet: to start now would wait for it.
  [[nodiscard]] bool windingDown() const { return busy_ && !running_; }

 signals:
  /// stage: short English name; fraction in [0, 1].
  void progressed(const QString& stage, double fraction);

 private:
  template <typename Result>
  static Expected<Result> attempt(const std::function<Expected<Result>(const Job&)>& work,
                                  const Job& job) {
    try {
      return work(job);
    } catch (const std::exception& bug) {
      return fail(ErrorCode::StoreFailed, std::string("a bug: ") + bug.what());
    }
  }
  void tell(int round, const QString& stage, double fraction) {
    QMetaObject::invokeMethod(
        this,
        [this, round, stage, fraction] {
          if (round == round_) {
            emit progressed(stage, fraction);
          }
        },
        Qt::QueuedConnection);
  }

  bool running_ = false;
  std::atomic<bool> busy_ = false;
  int round_ = 0;
  std::jthread thread_;  ///< last: joined before the rest is gone
};

}  // namespace tarsus
