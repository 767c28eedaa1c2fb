#pragma once

#include <QStringList>
#include <QWidget>

class QHBoxLayout;
class QLabel;
class QToolButton;

namespace tarsus {

class Chip;
class StepBar;

/// The bar on top: mark, where one is (each part before the last goes back to it), the steps of a
/// visit while there is one, help, and who works.
class Header : public QWidget {
  Q_OBJECT

 public:
  explicit Header(QWidget* parent = nullptr);
  void setCrumbs(const QStringList& crumbs);
  /// Empty: nobody, and nothing to lock.
  void setPerson(const QString& name, const QString& role);
  /// Shows the way to the help pages.
  void setHelp(bool there_is_help);
  /// A word beside the help, such as the camera's; empty: none.
  void setNote(const QString& text, bool trouble);
  [[nodiscard]] StepBar* steps() { return steps_; }

 signals:
  void crumbClicked(int index);
  void helpClicked();
  void openModelClicked();
  void lockClicked();

 protected:
  void resizeEvent(QResizeEvent* event) override;

 private:
  void showCrumbs();

  QStringList shown_crumbs_;
  QHBoxLayout* crumbs_ = nullptr;
  StepBar* steps_ = nullptr;
  Chip* note_ = nullptr;
  QToolButton* help_ = nullptr;
  QToolButton* person_ = nullptr;
};

}  // namespace tarsus
