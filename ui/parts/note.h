#pragma once

#include <QFrame>

class QLabel;

namespace tarsus {

/// A tinted line with an icon: what happened in bold, what to do after it.
class Note : public QFrame {
  Q_OBJECT

 public:
  enum class Kind { Warning, Danger };
  explicit Note(Kind kind, QWidget* parent = nullptr);
  /// Plain texts; both empty hides the note.
  void setText(const QString& what, const QString& then = {});
  [[nodiscard]] QString text() const;

 private:
  QLabel* what_ = nullptr;
};

}  // namespace tarsus
