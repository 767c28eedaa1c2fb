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
  /// The middle of the status bar.
  [[nodiscard]] virtual QString status() const { return {}; }

 signals:
  void crumbsChanged();
  void statusChanged();
};

}  // namespace tarsus
