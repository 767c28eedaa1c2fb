#pragma once

#include "ui/work/session.h"

#include <QWidget>

#include <functional>
#include <vector>

class QKeySequence;
class QStackedWidget;

namespace tarsus {

class GateScreen;
class Header;
class ModelScreen;
class NewPatientScreen;
class PatientScreen;
class PatientsScreen;
class Screen;
class StatusBar;
class VisitScreen;

/// The window: header, one screen at a time, status bar; where one came from, and the keys that
/// are the same everywhere. While nobody works the gate stands over it all, and the screen under it
/// is kept for the one who comes back.
class MainWindow : public QWidget {
  Q_OBJECT

 public:
  explicit MainWindow(SessionOptions options, QWidget* parent = nullptr);
  ~MainWindow() override;

  /// Opens the records; until then the window says that it does.
  void start();
  /// Opens a model file, on a screen of its own that needs nobody signed in.
  void openModel(const QString& path);

  [[nodiscard]] Session& session() { return *session_; }
  [[nodiscard]] ModelScreen* modelScreen() { return model_; }
  [[nodiscard]] PatientsScreen* patientsScreen() { return patients_; }
  [[nodiscard]] PatientScreen* patientScreen() { return patient_; }
  [[nodiscard]] VisitScreen* visitScreen() { return visit_; }
  [[nodiscard]] Screen* currentScreen() const;
  void showPatient(const QString& id);
  void showVisit(const QString& visit_id);
  void back();

 protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  void makeScreens();
  void makeKeys();
  void addKey(const QString& name, const QKeySequence& key, std::function<void()> act);
  void go(Screen* screen);
  void bring(Screen* screen);
  void follow();
  void forget();
  void showFrame();
  void goToCrumb(int index);
  void lock();

  Session* session_ = nullptr;
  Header* header_ = nullptr;
  StatusBar* status_ = nullptr;
  QStackedWidget* stack_ = nullptr;
  GateScreen* gate_ = nullptr;
  PatientsScreen* patients_ = nullptr;
  NewPatientScreen* new_patient_ = nullptr;
  PatientScreen* patient_ = nullptr;
  ModelScreen* model_ = nullptr;
  VisitScreen* visit_ = nullptr;
  QString saved_;
  Screen* kept_ = nullptr;  ///< under the gate
  std::string kept_for_;    ///< whose it is
  std::vector<Screen*> history_;
};

}  // namespace tarsus
