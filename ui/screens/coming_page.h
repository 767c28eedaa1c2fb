#pragma once

#include "ui/screens/visit_page.h"

namespace tarsus {

/// A step whose page is still to be built: says what will appear there.
class ComingPage : public VisitPage {
  Q_OBJECT

 public:
  ComingPage(VisitWork& work, const QString& icon, const QString& title, const QString& text);
};

}  // namespace tarsus
