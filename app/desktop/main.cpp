#include "app/user_folders.h"
#include "app/version.h"
#include "ui/look/look.h"
#include "ui/main_window.h"
#include "ui/scene/model_view.h"
#include "ui/screens/model_screen.h"

#include <QApplication>
#include <QCommandLineParser>
#include <QTimer>

#include <cstdio>
#include <exception>

namespace {

/// Saves a picture of the window once it shows its result, and ends the program: for the manual and
/// for tests.
void saveAndQuit(tarsus::MainWindow& window, const QString& file) {
  QTimer::singleShot(
      1500, &window, [&window, file] { QCoreApplication::exit(window.grab().save(file) ? 0 : 1); });
}

int run(QApplication& application) {
  QCommandLineParser parser;
  parser.setApplicationDescription(
      QCoreApplication::translate("main",
                                  "Shows a foot model. Research software. Not a medical "
                                  "device."));
  parser.addHelpOption();
  parser.addVersionOption();
  parser.addPositionalArgument(QStringLiteral("model"),
                               QCoreApplication::translate("main", "a model.ply to open"),
                               QStringLiteral("[model.ply]"));
  QCommandLineOption screenshot(QStringLiteral("screenshot"), {}, QStringLiteral("file"));
  screenshot.setFlags(QCommandLineOption::HiddenFromHelp);
  parser.addOption(screenshot);
  parser.process(application);

  tarsus::Look::instance().set(tarsus::ThemeChoice::Light, 100);
  tarsus::MainWindow window(
      {.folder = tarsus::userDataFolder() / "records", .now_ms = {}, .key_cost = {}});
  if (parser.isSet(screenshot)) {
    const QString file = parser.value(screenshot);
    if (parser.positionalArguments().isEmpty()) {
      saveAndQuit(window, file);
    }
    for (const auto signal :
         {&tarsus::ModelScreen::modelShown, &tarsus::ModelScreen::modelRefused}) {
      QObject::connect(
          window.modelScreen(), signal, &window, [&window, file] { saveAndQuit(window, file); });
    }
  }
  window.show();
  window.start();
  if (!parser.positionalArguments().isEmpty()) {
    window.openModel(parser.positionalArguments().constFirst());
  }
  return QApplication::exec();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    tarsus::prepareGraphics();
#if QT_VERSION < QT_VERSION_CHECK(6, 0, 0)
    QApplication::setAttribute(Qt::AA_EnableHighDpiScaling);
    QApplication::setAttribute(Qt::AA_UseHighDpiPixmaps);
#endif
    QApplication::setHighDpiScaleFactorRoundingPolicy(
        Qt::HighDpiScaleFactorRoundingPolicy::PassThrough);
    QApplication application(argc, argv);
    QApplication::setApplicationName(QStringLiteral("Tarsus"));
    QApplication::setApplicationVersion(QStringLiteral(TARSUS_VERSION));
    return run(application);
  } catch (const std::exception& bug) {
    std::fprintf(stderr, "tarsus: a bug stopped the program, please report it: %s\n", bug.what());
    return 3;
  }
}
