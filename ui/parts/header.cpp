#include "ui/parts/header.h"

#include "ui/look/icons.h"
#include "ui/parts/chip.h"
#include "ui/parts/controls.h"
#include "ui/parts/icon_label.h"
#include "ui/parts/mark.h"
#include "ui/parts/step_bar.h"

#include <QAction>
#include <QHBoxLayout>
#include <QMenu>
#include <QVariant>

namespace tarsus {
namespace {

constexpr int kNarrow = 1360;  ///< under this the first crumbs are left out

}  // namespace

Header::Header(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("header"));
  setAttribute(Qt::WA_StyledBackground);
  Look::setFixedHeight(this, 56);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(20, 0, 16, 0);
  row->setSpacing(8);
  row->addWidget(new Mark);
  row->addWidget(makeLine(tr("Tarsus"), TypeRole::Heading));
  row->addSpacing(8);
  crumbs_ = new QHBoxLayout;
  crumbs_->setSpacing(2);
  row->addLayout(crumbs_);
  row->addStretch();
  steps_ = new StepBar;
  steps_->hide();
  row->addWidget(steps_);
  row->addStretch();
  note_ = new Chip;
  note_->hide();
  row->addWidget(note_);
  help_ = makeIconButton(QStringLiteral("help"), tr("Help (F1)"));
  connect(help_, &QToolButton::clicked, this, &Header::helpClicked);
  row->addWidget(help_);
  help_->hide();
  person_ = new QToolButton;
  person_->setProperty("role", QStringLiteral("person"));
  person_->setObjectName(QStringLiteral("person"));
  Look::setType(person_, TypeRole::Label);
  person_->setPopupMode(QToolButton::InstantPopup);
  person_->setFocusPolicy(Qt::StrongFocus);
  auto* menu = new QMenu(person_);
  connect(menu->addAction(themeIcon(QStringLiteral("lock")), tr("Lock\tCtrl+L")),
          &QAction::triggered,
          this,
          &Header::lockClicked);
  connect(menu->addAction(themeIcon(QStringLiteral("open")), tr("Open a model file\tCtrl+O")),
          &QAction::triggered,
          this,
          &Header::openModelClicked);
  person_->setMenu(menu);
  row->addWidget(person_);
  setPerson({}, {});
}

void Header::setNote(const QString& text, bool trouble) {
  note_->setVisible(!text.isEmpty());
  if (note_->chip().text != text) {
    note_->setChip({text,
                    trouble ? ChipTone::Danger : ChipTone::Plain,
                    trouble ? QStringLiteral("unplugged") : QString()});
  }
}

void Header::setHelp(bool there_is_help) { help_->setVisible(there_is_help); }

void Header::setCrumbs(const QStringList& crumbs) {
  shown_crumbs_ = crumbs;
  showCrumbs();
}

void Header::showCrumbs() {
  while (QLayoutItem* item = crumbs_->takeAt(0)) {
    if (item->widget() != nullptr) {
      item->widget()->hide();
      item->widget()->deleteLater();  // perhaps it is the one that was clicked
    }
    delete item;
  }
  const int count = shown_crumbs_.size();
  const int first = width() < kNarrow && count > 2 ? 1 : 0;
  for (int i = first; i < count; ++i) {
    if (i > first) {
      crumbs_->addWidget(new IconLabel(QStringLiteral("chevron-right"), Tone::Secondary, 16));
    }
    QPushButton* crumb = makeButton(shown_crumbs_.at(i), QStringLiteral("crumb"));
    Look::setType(crumb, i + 1 == count ? TypeRole::Strong : TypeRole::Base);
    crumb->setEnabled(i + 1 < count);
    connect(crumb, &QPushButton::clicked, this, [this, i] { emit crumbClicked(i); });
    crumbs_->addWidget(crumb);
  }
}

void Header::setPerson(const QString& name, const QString& role) {
  person_->setVisible(!name.isEmpty());
  person_->setText(initialsOf(name));
  const QString words = tr("%1, %2").arg(name, role);
  person_->setToolTip(words);
  person_->setAccessibleName(words);
}

void Header::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  steps_->setShort(width() < Look::px(1100));
  if (shown_crumbs_.size() > 2) {
    showCrumbs();
  }
}

}  // namespace tarsus
