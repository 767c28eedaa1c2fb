#include "ui/work/session.h"

#include "measurement/records/users.h"
#include "ui/work/demo_patient.h"

#include <QCoreApplication>
#include <QEvent>
#include <QRegularExpression>
#include <QSysInfo>

#include <algorithm>
#include <chrono>

namespace tarsus {
namespace {

constexpr int kFreeTries = 3;  ///< sign_in.h: the attempts after these have to wait
constexpr const char* kAdministrator = "Administrator";

std::int64_t systemNowMs() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

/// The seconds that sign_in.h asks to wait; its error says them in words only.
int secondsIn(const Error& error) {
  static const QRegularExpression digits(QStringLiteral("wait (\\d+) s"));
  const auto match = digits.match(QString::fromStdString(error.detail));
  return match.hasMatch() ? match.captured(1).toInt() : 0;
}

Expected<void> keepClinic(Store& store, const std::string& clinic) {
  return storeSettings(store).and_then([&](StoreSettings settings) -> Expected<void> {
    settings.values["clinic"] = clinic;
    const auto changed = changeStoreSettings(store, settings);
    return changed ? Expected<void>() : tl::unexpected(changed.error());
  });
}

struct Begun {
  std::string code;
  SignedIn who;
  Station station;
};

/// An administrator looks after the store and may not write in records (roles.h), so the one who
/// treats patients gets an account of their own beside it, with the same password to begin with.
Expected<SignedIn> makePerson(Store& store, const FirstRunInput& input) {
  if (input.role == Role::Administrator) {
    return store.who(Permission::Read);
  }
  return addUser(store, input.name, input.role, input.password).and_then([&](const User&) {
    return signIn(store, input.name, input.password);
  });
}

Expected<Begun> begun(Store& store,
                      const FirstRunInput& input,
                      const std::filesystem::path& folder) {
  const bool alone = input.role == Role::Administrator;
  auto code = firstRun(store, alone ? input.name : kAdministrator, input.password);
  if (!code) {
    return tl::unexpected(code.error());
  }
  if (auto kept = keepClinic(store, input.clinic); !kept) {
    return tl::unexpected(kept.error());
  }
  auto person = makePerson(store, input);
  if (!person) {
    return tl::unexpected(person.error());
  }
  if (input.demo && !alone) {
    if (auto made = addDemoPatient(store); !made) {
      return tl::unexpected(made.error());
    }
  }
  auto station = rememberStation(store, folder);
  if (!station) {
    return tl::unexpected(station.error());
  }
  return Begun{.code = std::move(*code), .who = std::move(*person), .station = std::move(*station)};
}

}  // namespace

Session::Session(SessionOptions options, QObject* parent)
    : QObject(parent), options_(std::move(options)) {
  if (!options_.now_ms) {
    options_.now_ms = systemNowMs;
  }
  idle_.setSingleShot(true);
  idle_.setInterval(options_.idle_ms);
  connect(&idle_, &QTimer::timeout, this, &Session::lock);
  QCoreApplication::instance()->installEventFilter(this);
}

Session::~Session() = default;

void Session::deliver(std::function<void()> act) {
  QMetaObject::invokeMethod(this, std::move(act), Qt::QueuedConnection);
}

void Session::enter(State state) {
  state_ = state;
  if (state == State::Open) {
    idle_.start();
  } else {
    idle_.stop();
  }
  emit stateChanged();
}

void Session::open() {
  enter(State::Opening);
  thread_.start({.folder = options_.folder, .postgres = std::nullopt},
                {.now_ms = options_.now_ms,
                 .station = QSysInfo::machineHostName().toStdString(),
                 .key_cost = options_.key_cost},
                [this](Expected<Store>& store) {
                  Expected<Station> station =
                      store ? readStation(*store, options_.folder)
                            : Expected<Station>(tl::unexpected(store.error()));
                  deliver([this, station] {
                    if (!station) {
                      problem_ = station.error();
                      enter(State::Failed);
                      return;
                    }
                    station_ = *station;
                    enter(station_.people.empty() ? State::New : State::Locked);
                  });
                });
}

void Session::firstRun(const FirstRunInput& input,
                       std::function<void(Expected<std::string>)> then) {
  ask<Begun>(
      Kind::Write,
      this,
      [input, folder = options_.folder](Store& store) { return begun(store, input, folder); },
      [this, then = std::move(then)](Expected<Begun> result) {
        if (!result) {
          then(tl::unexpected(result.error()));
          return;
        }
        ready_ = result->who;
        station_ = result->station;
        then(result->code);
      });
}

void Session::begin() {
  if (ready_) {
    who_ = std::exchange(ready_, std::nullopt);
    enter(State::Open);
  }
}

void Session::answerSignIn(Expected<SignedIn> user,
                           const std::string& name,
                           int failures,
                           const std::function<void(std::optional<SignInRefusal>)>& then) {
  Q_UNUSED(name)
  if (!user) {
    then(SignInRefusal{.error = user.error(),
                       .tries_left = std::max(0, kFreeTries - failures),
                       .wait_s = secondsIn(user.error())});
    return;
  }
  who_ = *user;
  then(std::nullopt);
  enter(State::Open);
}

void Session::signIn(const std::string& name,
                     const std::string& password,
                     std::function<void(std::optional<SignInRefusal>)> then) {
  thread_.post([this, name, password, then = std::move(then)](Store& store) {
    auto user = tarsus::signIn(store, name, password);
    const int failures = failedAttempts(store, name);
    auto station = user ? rememberStation(store, options_.folder)
                        : Expected<Station>(tl::unexpected(user.error()));
    deliver([this, name, user, failures, station, then] {
      if (station) {
        station_ = *station;
      }
      answerSignIn(user, name, failures, then);
    });
  });
}

void Session::resetPassword(const std::string& name,
                            const std::string& code,
                            const std::string& password,
                            std::function<void(std::optional<SignInRefusal>)> then) {
  thread_.post([this, name, code, password, then = std::move(then)](Store& store) {
    auto user = tarsus::resetPassword(store, name, code, password);
    deliver([this, name, user, then] { answerSignIn(user, name, 0, then); });
  });
}

void Session::lock() {
  if (state_ != State::Open) {
    return;
  }
  thread_.post([](Store& store) { store.lock(); });
  who_.reset();
  enter(State::Locked);
}

bool Session::eventFilter(QObject* watched, QEvent* event) {
  switch (event->type()) {
    case QEvent::KeyPress:
    case QEvent::MouseButtonPress:
    case QEvent::MouseMove:
    case QEvent::Wheel:
    case QEvent::TouchBegin:
      if (state_ == State::Open) {
        idle_.start();
      }
      break;
    default:
      break;
  }
  return QObject::eventFilter(watched, event);
}

}  // namespace tarsus
