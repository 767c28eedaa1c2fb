#pragma once

#include <QString>
#include <QWidget>

namespace tarsus {

class VisitWork;

/// One step of a visit. All steps share one VisitWork; a page reads it when it is entered.
class VisitPage : public QWidget {
  Q_OBJECT

 public:
  explicit VisitPage(VisitWork& work) : work_(work) {}
  /// Another visit was opened, or none is any more: forget what was shown.
  virtual void reset() {}
  /// It has come to the front, with the visit read.
  virtual void enter() {}
  /// Another step or another screen comes to the front.
  virtual void leave() {}
  /// Ctrl+Enter: the one filled button.
  virtual void primary() {}
  /// The middle and the left of the status bar; empty: as usual.
  [[nodiscard]] virtual QString status() const { return {}; }
  [[nodiscard]] virtual QString saved() const { return {}; }
  /// A word about the camera in the header, and whether it is one of trouble.
  [[nodiscard]] virtual QString headerNote(bool* /*trouble*/) const { return {}; }

 signals:
  void statusChanged();
  /// 0 to 4.
  void stepWanted(int step);

 protected:
  [[nodiscard]] VisitWork& work() const { return work_; }

 private:
  VisitWork& work_;
};

}  // namespace tarsus
