#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"
#include "ui/theme.h"

#include <QWidget>

#include <functional>
#include <memory>

class QLabel;
class QStackedWidget;
class QPushButton;

namespace tarsus {

class ModelLoader;
class ModelPanel;
class ModelView;
class ScaleBar;
class ViewTools;

/// The window: a start page, then one model with its facts. Opens files by argument, button, key
/// and drop.
class MainWindow : public QWidget {
  Q_OBJECT

 public:
  explicit MainWindow(const Theme& theme, QWidget* parent = nullptr);
  ~MainWindow() override;

  /// Begins to open a file; the result is shown when it is there, and announced.
  void open(const QString& path);
  /// Lets the user choose a file.
  void chooseFile();

  [[nodiscard]] const TexturedMesh* model() const { return model_.get(); }
  /// The sentence that is shown about a file that could not be opened; empty when there is none.
  [[nodiscard]] QString problem() const;

 signals:
  void modelShown();
  void modelRefused();

 protected:
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  QWidget* makeHeader();
  QWidget* makeStatus();
  QWidget* makeProblem();
  QWidget* makeModelPage();
  void makeActions();
  void addKey(const QString& name, const QKeySequence& key, std::function<void()> act);
  void showModel(const QString& path, std::shared_ptr<const TexturedMesh> model);
  void showProblem(const QString& path, const Error& error);
  void setTextured(bool textured);

  Theme theme_;
  std::shared_ptr<const TexturedMesh> model_;
  ModelLoader* loader_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  ModelView* view_ = nullptr;
  ModelPanel* panel_ = nullptr;
  ViewTools* tools_ = nullptr;
  ScaleBar* scale_bar_ = nullptr;
  QLabel* crumb_ = nullptr;
  QLabel* state_ = nullptr;
  QPushButton* open_ = nullptr;
  QWidget* problem_ = nullptr;
  QLabel* problem_title_ = nullptr;
  QLabel* problem_text_ = nullptr;
  QLabel* problem_detail_ = nullptr;
};

}  // namespace tarsus
