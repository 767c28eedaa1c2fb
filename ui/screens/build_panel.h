#pragma once

#include <QTimer>
#include <QWidget>

#include <array>

class QGridLayout;
class QLabel;
class QProgressBar;
class QPushButton;
class QStackedWidget;

namespace tarsus {

class Chip;
class Note;
class StageMark;
class VisitWork;

/// The model as it is built: picture, progress, stages; then how good the scan was.
class BuildPanel : public QWidget {
  Q_OBJECT

 public:
  explicit BuildPanel(VisitWork& work);
  void reset();
  void enter();
  void pressContinue();

 signals:
  void continued();
  void scanWanted();

 private:
  struct Row {
    StageMark* mark = nullptr;
    QLabel* name = nullptr;
    QLabel* value = nullptr;
  };

  [[nodiscard]] QWidget* makeBuild();
  [[nodiscard]] QWidget* makeQuality();
  void show();
  void showStages();
  void showQuality();
  void showPicture();
  void ask(bool asking);

  VisitWork& work_;
  QTimer clock_;
  QLabel* picture_ = nullptr;
  QLabel* title_ = nullptr;
  QLabel* percent_ = nullptr;
  QProgressBar* bar_ = nullptr;
  QLabel* left_ = nullptr;
  std::array<Row, 5> stages_;
  QWidget* stage_box_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QWidget* question_ = nullptr;
  QPushButton* stop_ = nullptr;
  QWidget* quality_ = nullptr;
  Chip* verdict_ = nullptr;
  std::array<Row, 4> facts_;
  QLabel* sentence_ = nullptr;
  QPushButton* again_ = nullptr;
  QPushButton* continue_ = nullptr;
  const void* pictured_ = nullptr;
  bool asking_ = false;
};

}  // namespace tarsus
