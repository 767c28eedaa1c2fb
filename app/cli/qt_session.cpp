#include "app/cli/qt_session.h"

#include <QGuiApplication>

#include <cstdio>
#include <cstdlib>

namespace tarsus {

void startQt() {
  if (QGuiApplication::instance() != nullptr) {
    return;
  }
  ::setenv("QT_QPA_PLATFORM", "offscreen", 1);
  // Qt's hints on the session (a missing XDG_RUNTIME_DIR, say) are none of our user's business.
  qInstallMessageHandler([](QtMsgType type, const QMessageLogContext&, const QString& text) {
    if (type == QtCriticalMsg || type == QtFatalMsg) {
      std::fprintf(stderr, "%s\n", qPrintable(text));
    }
  });
  static int argc = 1;
  static char name[] = "tarsus-cli";
  static char* argv[] = {name, nullptr};
  static const QGuiApplication application(argc, argv);
}

}  // namespace tarsus
