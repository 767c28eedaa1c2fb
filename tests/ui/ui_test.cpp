#include "tests/ui/ui_test.h"

#include <QLabel>

namespace tarsus {

const auto* const kApplication = testing::AddGlobalTestEnvironment(new Application);

bool WindowTest::shows(const QString& words) const {
  for (const QLabel* label : window_->findChildren<QLabel*>()) {
    if (label->isVisible() && label->text().contains(words)) {
      return true;
    }
  }
  return false;
}

}  // namespace tarsus
