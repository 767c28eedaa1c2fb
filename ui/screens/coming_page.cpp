#include "ui/screens/coming_page.h"

#include "ui/parts/controls.h"
#include "ui/parts/empty_place.h"

#include <QVBoxLayout>

namespace tarsus {

ComingPage::ComingPage(VisitWork& work,
                       const QString& icon,
                       const QString& title,
                       const QString& text)
    : VisitPage(work) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(24, 24, 24, 24);
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* inside = new QVBoxLayout(card);
  inside->addWidget(new EmptyPlace(icon, title, text));
  column->addWidget(card);
}

}  // namespace tarsus
