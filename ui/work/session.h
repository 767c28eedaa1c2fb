#pragma once

#include "measurement/records/sign_in.h"
#include "ui/work/station.h"
#include "ui/work/store_thread.h"

#include <QObject>
#include <QPointer>
#include <QTimer>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

namespace tarsus {

struct SessionOptions {
  std::filesystem::path folder;  ///< of the records
  ClockMs now_ms;                ///< none: the system's
  KeyCost key_cost;
  int idle_ms = 5 * 60 * 1000;  ///< without a key or a mouse it locks itself
};

/// What the first start is told.
struct FirstRunInput {
  std::string name;
  Role role = Role::Nurse;
  std::string clinic;
  std::string password;
  bool demo = false;
};

/// Why nobody was signed in.
struct SignInRefusal {
  Error error;
  int tries_left = 0;  ///< before the next one has to wait
  int wait_s = 0;
};

/// Who works, on which records. Everything that touches the records is done in their own thread;
/// answers come back to the window's.
class Session : public QObject {
  Q_OBJECT

 public:
  enum class State { Opening, New, Locked, Open, Failed };
  enum class Kind { Read, Write };

  explicit Session(SessionOptions options, QObject* parent = nullptr);
  ~Session() override;

  /// Opens the records, making them where there are none; stateChanged follows.
  void open();
  [[nodiscard]] State state() const { return state_; }
  [[nodiscard]] const std::optional<SignedIn>& who() const { return who_; }
  [[nodiscard]] bool mayEdit() const {
    return who_ && isAllowed(who_->role, Permission::EditRecords);
  }
  /// Who may sign in, and where; known before anybody did.
  [[nodiscard]] const Station& station() const { return station_; }
  [[nodiscard]] const Error& problem() const { return problem_; }
  [[nodiscard]] const std::filesystem::path& folder() const { return options_.folder; }
  [[nodiscard]] std::int64_t nowMs() const { return options_.now_ms(); }

  /// Administrator and, for a nurse or a physician, an account of their own; answers with the
  /// recovery code. begin() then goes on.
  void firstRun(const FirstRunInput& input, std::function<void(Expected<std::string>)> then);
  /// The recovery code was kept: the work begins.
  void begin();
  void signIn(const std::string& name,
              const std::string& password,
              std::function<void(std::optional<SignInRefusal>)> then);
  /// By the recovery code.
  void resetPassword(const std::string& name,
                     const std::string& code,
                     const std::string& password,
                     std::function<void(std::optional<SignInRefusal>)> then);
  void lock();

  /// Does `work(store)` in the records' thread and hands the result to `then`, unless `receiver` is
  /// gone by then. A Write that went well announces saved().
  template <typename Result>
  void ask(Kind kind,
           QObject* receiver,
           std::function<Expected<Result>(Store&)> work,
           std::function<void(Expected<Result>)> then) {
    thread_.post([this,
                  kind,
                  alive = QPointer<QObject>(receiver),
                  work = std::move(work),
                  then = std::move(then)](Store& store) {
      store.vault().touch();
      auto result = std::make_shared<Expected<Result>>(attempt<Result>(work, store));
      deliver([this, kind, alive, result, then] {
        if (!*result && result->error().code == ErrorCode::StoreLocked) {
          lock();
        }
        if (*result && kind == Kind::Write) {
          emit saved();
        }
        if (alive) {
          then(std::move(*result));
        }
      });
    });
  }

 signals:
  void stateChanged();
  void saved();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  template <typename Result>
  static Expected<Result> attempt(const std::function<Expected<Result>(Store&)>& work,
                                  Store& store) {
    try {
      return work(store);
    } catch (const std::exception& bug) {
      return fail(ErrorCode::StoreFailed, std::string("a bug: ") + bug.what());
    }
  }
  void deliver(std::function<void()> act);
  void enter(State state);
  void answerSignIn(Expected<SignedIn> user,
                    const std::string& name,
                    int failures,
                    const std::function<void(std::optional<SignInRefusal>)>& then);

  SessionOptions options_;
  State state_ = State::Opening;
  Station station_;
  std::optional<SignedIn> who_;
  std::optional<SignedIn> ready_;  ///< after the first run, until the code is kept
  Error problem_;
  QTimer idle_;
  StoreThread thread_;  ///< last: it ends before what its tasks speak to
};

}  // namespace tarsus
