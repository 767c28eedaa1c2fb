#pragma once

#include <QStringList>
#include <QWidget>

namespace tarsus {

/// A page of the window. The shell asks it where it stands and gives it the focus.
class Screen : public QWidget {
  Q_OBJECT

 public:
  explicit Screen(QWidget* parent = nullptr) : QWidget(parent) {
    setObjectName(QStringLiteral("page"));
    setAttribute(Qt::WA_StyledBackground);
  }
  /// For the header: "Patients", "Margarete Holm". Empty: the screen stands without header.
  [[nodiscard]] virtual QStringList crumbs() const { return {}; }
  /// It has come to the front.
  virtual void entered() {}
  /// Ctrl+Enter: the one filled button.
  virtual void primary() {}
  /// Ctrl+F.
  virtual void search() {}
  /// Another screen comes to the front.
  virtual void left() {}
  /// The middle of the status bar.
  [[nodiscard]] virtual QString status() const { return {}; }
  /// Its left; empty: when all was last saved.
  [[nodiscard]] virtual QString saved() const { return {}; }
  /// The step of a visit that is shown, and the furthest that may be; -1: no visit.
  [[nodiscard]] virtual int step() const { return -1; }
  [[nodiscard]] virtual int reached() const { return -1; }
  /// A word in the header beside the help, and whether it tells of trouble.
  [[nodiscard]] virtual QString headerNote(bool* /*trouble*/) const { return {}; }
  /// A file or folder that was dropped; false: not for this screen.
  virtual bool takeFile(const QString& /*path*/) { return false; }

 signals:
  void crumbsChanged();
  void statusChanged();
};

}  // namespace tarsus
