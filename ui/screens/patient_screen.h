#pragma once

#include "ui/screens/screen.h"
#include "ui/work/patient_summary.h"

class QBoxLayout;
class QGridLayout;
class QLabel;
class QPushButton;
class QScrollArea;
class QStackedWidget;
class QVBoxLayout;

namespace tarsus {

class AreaChart;
class FootMap;
class Note;
class Session;
class VisitCard;
class WoundForm;

/// How is this wound doing, and what next.
class PatientScreen : public Screen {
  Q_OBJECT

 public:
  explicit PatientScreen(Session& session, QWidget* parent = nullptr);
  /// Reads the patient; the page fills when the answer is there.
  void open(const QString& patient_id);
  void primary() override;
  [[nodiscard]] QStringList crumbs() const override;
  [[nodiscard]] FootMap* map() { return map_; }
  [[nodiscard]] const PatientSummary& summary() const { return summary_; }
  [[nodiscard]] const QString& id() const { return id_; }
  void forget();

 signals:
  /// A draft is to be worked on, perhaps one that was just begun.
  void visitChosen(const QString& visit_id);
  void loaded();

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  [[nodiscard]] QWidget* makeLeft();
  [[nodiscard]] QWidget* makeWounds();
  [[nodiscard]] QWidget* makeRight();
  [[nodiscard]] QWidget* makeFigures();
  [[nodiscard]] QWidget* makeVisits();
  [[nodiscard]] QWidget* makeFoot();
  void load();
  void show();
  void showWoundRows();
  void showWound();
  void showVisit(std::size_t index);
  void showKnown();
  void placeAt(FootSide side, const QString& place);
  void endPlacing();
  void addWoundHere(FootSide side, const WoundFields& fields);
  void startVisit();
  void refuse(const QString& what, const Error& error);
  [[nodiscard]] const WoundSummary* wound() const;
  [[nodiscard]] const VisitSummary* draft() const;

  Session& session_;
  PatientSummary summary_;
  QString id_;
  std::string wound_id_;
  bool busy_ = false;
  QLabel* name_ = nullptr;
  QLabel* born_ = nullptr;
  FootMap* map_ = nullptr;
  QPushButton* place_ = nullptr;
  QScrollArea* left_ = nullptr;
  QWidget* rows_box_ = nullptr;
  QVBoxLayout* wound_rows_ = nullptr;
  WoundForm* form_ = nullptr;
  QWidget* known_card_ = nullptr;
  QGridLayout* known_ = nullptr;
  QLabel* title_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  QWidget* visits_page_ = nullptr;
  QLabel* area_title_ = nullptr;
  QLabel* area_ = nullptr;
  QLabel* range_ = nullptr;
  QLabel* since_last_title_ = nullptr;
  QLabel* since_last_ = nullptr;
  QLabel* since_baseline_ = nullptr;
  QLabel* advance_ = nullptr;
  QWidget* changes_ = nullptr;
  QWidget* advance_box_ = nullptr;
  AreaChart* chart_ = nullptr;
  QWidget* strip_ = nullptr;
  std::vector<VisitCard*> cards_;
  Note* note_ = nullptr;
  Note* problem_ = nullptr;
  QPushButton* start_ = nullptr;
  QPushButton* continue_ = nullptr;
};

}  // namespace tarsus
