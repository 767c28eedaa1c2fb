#pragma once

#include "ui/screens/screen.h"

#include <array>

class QStackedWidget;

namespace tarsus {

class Note;
class ScanPage;
class Session;
class VisitPage;
class VisitWork;
struct Error;

/// A visit in five steps: scan, form, outline, review, report.
class VisitScreen : public Screen {
  Q_OBJECT

 public:
  enum Step { Scan, Form, Outline, Review, Report };
  static constexpr int kSteps = 5;

  explicit VisitScreen(Session& session, QWidget* parent = nullptr);
  ~VisitScreen() override;

  /// Reads the visit and goes to the first step that is not done.
  void open(const QString& visit_id);
  /// Forgets the visit; what was typed is saved.
  void close();
  /// What was typed goes to the records now.
  void save();
  /// A step that was not reached is not gone to.
  void goTo(int step);
  [[nodiscard]] int step() const override { return step_; }
  [[nodiscard]] int reached() const override;
  [[nodiscard]] VisitWork& work() { return *work_; }
  [[nodiscard]] ScanPage* scanPage() { return scan_; }
  [[nodiscard]] QString patientId() const;
  /// A scan folder or .oni that was dropped on the window.
  bool takeFile(const QString& path) override;

  void entered() override;
  void left() override;
  void primary() override;
  [[nodiscard]] QStringList crumbs() const override;
  [[nodiscard]] QString status() const override;
  [[nodiscard]] QString saved() const override;
  [[nodiscard]] QString headerNote(bool* trouble) const override;

 private:
  void setPage(Step step, VisitPage* page);
  void show(int step);
  void showProblem(const Error& error);

  VisitWork* work_ = nullptr;
  QStackedWidget* stack_ = nullptr;
  ScanPage* scan_ = nullptr;
  Note* problem_ = nullptr;
  Note* told_ = nullptr;
  std::array<VisitPage*, kSteps> pages_{};
  int step_ = 0;
  bool in_front_ = false;
};

}  // namespace tarsus
