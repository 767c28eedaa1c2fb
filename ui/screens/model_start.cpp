#include "ui/screens/model_start.h"

#include "ui/parts/controls.h"

#include <QFontDatabase>
#include <QHBoxLayout>
#include <QVBoxLayout>

namespace tarsus {
namespace {

/// A step with its number and the command that does it.
QWidget* makeStep(const QString& text, const QString& command) {
  auto* step = new QWidget;
  auto* layout = new QVBoxLayout(step);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  layout->addWidget(makeLabel(text, TypeRole::Base));
  QFrame* well = makeFrame(QStringLiteral("well"));
  auto* inside = new QHBoxLayout(well);
  inside->setContentsMargins(12, 10, 12, 10);
  QLabel* label = makeLabel(command, TypeRole::Base);
  QFont font = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  font.setPixelSize(13);
  label->setFont(font);
  label->setWordWrap(false);
  label->setTextInteractionFlags(Qt::TextSelectableByMouse);
  inside->addWidget(label);
  layout->addWidget(well);
  return step;
}

}  // namespace

ModelStart::ModelStart(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("page"));
  setAttribute(Qt::WA_StyledBackground);
  QFrame* card = makeFrame(QStringLiteral("card"));
  card->setFixedWidth(560);
  auto* inside = new QVBoxLayout(card);
  inside->setContentsMargins(32, 28, 32, 28);
  inside->setSpacing(16);
  inside->addWidget(makeLabel(tr("No model open"), TypeRole::Title));
  inside->addWidget(
      makeLabel(tr("Open a model.ply, or drop one anywhere in this window."), TypeRole::Base));
  auto* row = new QHBoxLayout;
  row->addStretch();
  QPushButton* open = makeButton(tr("Open a model"), QStringLiteral("primary"));
  open->setMinimumWidth(160);
  connect(open, &QPushButton::clicked, this, &ModelStart::openRequested);
  row->addWidget(open);
  inside->addLayout(row);
  inside->addWidget(makeFrame(QStringLiteral("line")));
  inside->addWidget(makeLabel(tr("How to make one"), TypeRole::Heading));
  inside->addWidget(makeStep(tr("From a recorded scan folder:"),
                             QStringLiteral("tarsus-cli reconstruct SCAN OUT")));
  inside->addWidget(makeStep(tr("Without a camera, from a simulated foot:"),
                             QStringLiteral("tarsus-cli demo OUT")));
  inside->addWidget(makeLabel(tr("Both write model.ply into the folder OUT or below it."),
                              TypeRole::Small,
                              QStringLiteral("secondary")));
  auto* layout = new QVBoxLayout(this);
  layout->addStretch(2);
  layout->addWidget(card, 0, Qt::AlignHCenter);
  layout->addStretch(3);
}

}  // namespace tarsus
