#pragma once

#include <QFrame>

#include <functional>

class QHBoxLayout;
class QLabel;
class QPushButton;
class QVBoxLayout;

namespace tarsus {

/// What happened, what is safe, what to do: a panel in the middle of a view, over it and not apart
/// from it. Esc does the safe thing.
class ScanDialog : public QFrame {
  Q_OBJECT

 public:
  struct Act {
    QString text;
    std::function<void()> act;
    const char* name = "";
  };
  struct Words {
    QString id;  ///< the same panel is not built anew
    QString icon;
    QString title;
    QString text;
    QStringList steps;
    QString waiting;     ///< what is being waited for; empty: nothing
    QString technician;  ///< shown when asked for
    Act first;
    Act second;
    bool second_is_safe = false;  ///< of Esc and of the focus
  };

  /// @param over  the widget in whose middle it stands
  explicit ScanDialog(QWidget* over);
  void open(Words words);
  void close(const QString& id = {});  ///< empty: whatever is open
  [[nodiscard]] QString shown() const { return isHidden() ? QString() : words_.id; }

 protected:
  void keyPressEvent(QKeyEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void build();
  void place();
  QWidget* over_;
  QWidget* inside_ = nullptr;
  Words words_;
};

}  // namespace tarsus
