#pragma once

#include "ui/screens/screen.h"

class QLabel;
class QLineEdit;
class QListView;
class QPushButton;
class QStackedWidget;

namespace tarsus {

class Chip;
class ChoiceRow;
class EmptyPlace;
class Note;
class PatientListModel;
class ReviewModel;
class Session;

/// Find a patient; the physician sees what waits.
class PatientsScreen : public Screen {
  Q_OBJECT

 public:
  explicit PatientsScreen(Session& session, QWidget* parent = nullptr);
  void entered() override;
  void primary() override;
  void search() override;
  [[nodiscard]] QStringList crumbs() const override { return {tr("Patients")}; }
  [[nodiscard]] QString status() const override;
  /// Forgets all names: somebody has locked.
  void forget();
  [[nodiscard]] PatientListModel* model() { return model_; }

 signals:
  void patientChosen(const QString& id);
  void newPatient();

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

 private:
  [[nodiscard]] QWidget* makeLeft();
  [[nodiscard]] QWidget* makeBar();
  [[nodiscard]] QWidget* makeList();
  [[nodiscard]] QWidget* makeReview();
  void loadReview();
  void loadDemo();
  void showCounts();
  void openRow(int row);
  [[nodiscard]] bool isPhysician() const;

  Session& session_;
  PatientListModel* model_ = nullptr;
  ReviewModel* review_model_ = nullptr;
  QWidget* bar_ = nullptr;
  QLineEdit* search_ = nullptr;
  ChoiceRow* filter_ = nullptr;
  QPushButton* new_ = nullptr;
  QPushButton* empty_new_ = nullptr;
  QPushButton* empty_demo_ = nullptr;
  QListView* list_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  QWidget* list_page_ = nullptr;
  EmptyPlace* none_ = nullptr;
  EmptyPlace* no_match_ = nullptr;
  Note* problem_ = nullptr;
  QWidget* review_ = nullptr;
  QListView* review_list_ = nullptr;
  QStackedWidget* review_pages_ = nullptr;
  QPushButton* review_oldest_ = nullptr;
  Chip* review_count_ = nullptr;
};

}  // namespace tarsus
