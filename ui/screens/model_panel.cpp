#include "ui/screens/model_panel.h"

#include "ui/parts/controls.h"

#include <QGridLayout>
#include <QScrollArea>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {
namespace {

QString chipOf(Fitness fitness) {
  switch (fitness) {
    case Fitness::Fit:
      return QStringLiteral("good");
    case Fitness::Unfit:
      return QStringLiteral("bad");
    case Fitness::NotStated:
      break;
  }
  return QStringLiteral("unknown");
}

/// Groups of four, eight a line, for reading aloud and comparing.
QString groupedHash(const std::string& sha256) {
  QString text;
  for (std::size_t i = 0; i < sha256.size(); i += 4) {
    if (i > 0) {
      text += i % 16 == 0 ? QLatin1Char('\n') : QLatin1Char(' ');
    }
    text += QString::fromStdString(sha256.substr(i, 4));
  }
  return text;
}

QFrame* makeCard(const QString& title, QVBoxLayout*& inside) {
  QFrame* card = makeFrame(QStringLiteral("card"));
  inside = new QVBoxLayout(card);
  inside->setContentsMargins(16, 16, 16, 16);
  inside->setSpacing(12);
  inside->addWidget(makeLabel(title, TypeRole::Heading));
  return card;
}

QLabel* selectable(QLabel* label) {
  label->setTextInteractionFlags(Qt::TextSelectableByMouse | Qt::TextSelectableByKeyboard);
  return label;
}

QFrame* makeFactsCard(const QString& file_name, const ModelFacts& facts) {
  QVBoxLayout* inside = nullptr;
  QFrame* card = makeCard(file_name, inside);
  QLabel* chip = makeLabel(facts.fitness_text, TypeRole::Label);
  chip->setProperty("chip", chipOf(facts.fitness));
  chip->setObjectName(QStringLiteral("fitness"));
  inside->addWidget(chip);
  auto* grid = new QGridLayout;
  grid->setVerticalSpacing(10);
  grid->setColumnStretch(1, 1);
  int row = 0;
  for (const auto& [name, value] : facts.rows) {
    if (row > 0) {
      grid->addWidget(makeFrame(QStringLiteral("line")), row++, 0, 1, 2);
    }
    QLabel* name_label = makeLabel(name, TypeRole::Base, QStringLiteral("secondary"));
    name_label->setWordWrap(false);
    grid->addWidget(name_label, row, 0);
    QLabel* value_label = makeLabel(value, TypeRole::Base);
    value_label->setAlignment(Qt::AlignRight);
    value_label->setAccessibleName(name + QStringLiteral(", ") + value);
    grid->addWidget(value_label, row++, 1);
  }
  inside->addLayout(grid);
  return card;
}

QFrame* makeHashCard(const std::string& sha256) {
  QVBoxLayout* inside = nullptr;
  QFrame* card = makeCard(ModelPanel::tr("Fingerprint"), inside);
  QLabel* hash = selectable(makeLabel(groupedHash(sha256), TypeRole::Base));
  hash->setObjectName(QStringLiteral("hash"));
  inside->addWidget(hash);
  inside->addWidget(
      makeLabel(ModelPanel::tr("SHA-256 of shape and colours. Every measurement names it."),
                TypeRole::Small,
                QStringLiteral("secondary")));
  return card;
}

QFrame* makeCommentsCard(const QStringList& comments) {
  QVBoxLayout* inside = nullptr;
  QFrame* card = makeCard(ModelPanel::tr("Written in the file"), inside);
  inside->setSpacing(8);
  if (comments.isEmpty()) {
    inside->addWidget(
        makeLabel(ModelPanel::tr("Nothing."), TypeRole::Base, QStringLiteral("secondary")));
  }
  for (QString comment : comments) {
    // A hash is one long word: places where it may wrap keep it inside the card.
    for (int at = 24; at < comment.size(); at += 24) {
      comment.insert(at++, QChar(0x200B));
    }
    inside->addWidget(selectable(makeLabel(comment, TypeRole::Small, QStringLiteral("secondary"))));
  }
  return card;
}

}  // namespace

ModelPanel::ModelPanel(QWidget* parent) : QWidget(parent) {
  setFixedWidth(336);
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* content = new QWidget;
  cards_ = new QVBoxLayout(content);
  cards_->setContentsMargins(0, 0, 0, 0);
  cards_->setSpacing(16);
  area->setWidget(content);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->addWidget(area);
}

void ModelPanel::clear() {
  while (QLayoutItem* item = cards_->takeAt(0)) {
    delete item->widget();
    delete item;
  }
}

void ModelPanel::showFacts(const QString& file_name,
                           const ModelFacts& facts,
                           const std::string& sha256) {
  clear();
  cards_->addWidget(makeFactsCard(file_name, facts));
  cards_->addWidget(makeHashCard(sha256));
  cards_->addWidget(makeCommentsCard(facts.comments));
  cards_->addStretch();
}

}  // namespace tarsus
