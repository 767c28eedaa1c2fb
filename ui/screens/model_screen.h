#pragma once

#include "reconstruction/base/error.h"
#include "reconstruction/scene/mesh.h"
#include "ui/screens/screen.h"

#include <functional>
#include <memory>

class QKeySequence;
class QLabel;
class QStackedWidget;
class QPushButton;

namespace tarsus {

class ModelLoader;
class ModelPanel;
class ModelView;
class ScaleBar;
class ViewTools;

/// A model file alone, with its facts: no patient, nothing kept.
class ModelScreen : public Screen {
  Q_OBJECT

 public:
  explicit ModelScreen(QWidget* parent = nullptr);
  ~ModelScreen() override;

  /// Begins to open a file; the result is shown when it is there, and announced.
  void open(const QString& path);
  /// Lets the user choose a file.
  void chooseFile();

  [[nodiscard]] const TexturedMesh* model() const { return model_.get(); }
  /// The sentence that is shown about a file that could not be opened; empty when there is none.
  [[nodiscard]] QString problem() const;
  [[nodiscard]] QStringList crumbs() const override { return crumbs_; }
  [[nodiscard]] QString status() const override { return status_; }

 signals:
  void modelShown();
  void modelRefused();

 private:
  QWidget* makeProblem();
  QWidget* makeModelPage();
  void makeKeys();
  void addKey(const QString& name, const QKeySequence& key, std::function<void()> act);
  void showModel(const QString& path, std::shared_ptr<const TexturedMesh> model);
  void showProblem(const QString& path, const Error& error);
  void setTextured(bool textured);
  void setStatus(const QString& text);

  std::shared_ptr<const TexturedMesh> model_;
  QStringList crumbs_;
  QString status_;
  ModelLoader* loader_ = nullptr;
  QStackedWidget* pages_ = nullptr;
  ModelView* view_ = nullptr;
  ModelPanel* panel_ = nullptr;
  ViewTools* tools_ = nullptr;
  ScaleBar* scale_bar_ = nullptr;
  QWidget* problem_ = nullptr;
  QLabel* problem_title_ = nullptr;
  QLabel* problem_text_ = nullptr;
  QLabel* problem_detail_ = nullptr;
};

}  // namespace tarsus
