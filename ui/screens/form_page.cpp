#include "ui/screens/form_page.h"

#include "ui/look/icons.h"
#include "ui/parts/choice_row.h"
#include "ui/parts/controls.h"
#include "ui/parts/words.h"
#include "ui/screens/build_panel.h"
#include "ui/screens/form_field.h"
#include "ui/screens/form_words.h"
#include "ui/screens/visit_screen.h"
#include "ui/work/visit_work.h"

#include <QAction>
#include <QCheckBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QScrollArea>
#include <QScrollBar>
#include <QVBoxLayout>
#include <QVariant>

#include <algorithm>

namespace tarsus {
namespace {

using nlohmann::json;

constexpr int kWidest = 820;

const VisitField& fieldNamed(std::string_view name) {
  return *std::ranges::find(visitFields(), name, &VisitField::name);
}

}  // namespace

FormPage::FormPage(VisitWork& work) : VisitPage(work) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(24, 24, 24, 24);
  column->setSpacing(16);
  tabs_ = new ChoiceRow({tr("Form"), tr("Model")});
  tabs_->setTicks(false);
  tabs_->setCurrent(0);
  tabs_->hide();
  connect(tabs_, &ChoiceRow::chosen, this, &FormPage::arrange);
  column->addWidget(tabs_);
  auto* row = new QHBoxLayout;
  row->setSpacing(24);
  column->addLayout(row, 1);
  QWidget* form = makeForm();  // before the list of its sections
  row->addWidget(makeNavigation());
  row->addWidget(form, 1);
  build_ = new BuildPanel(work);
  row->addWidget(build_);
  connect(build_, &BuildPanel::continued, this, [this] {
    emit stepWanted(this->work().noScan() ? VisitScreen::Review : VisitScreen::Outline);
  });
  connect(build_, &BuildPanel::scanWanted, this, [this] { emit stepWanted(VisitScreen::Scan); });
  connect(&work, &VisitWork::opened, this, &FormPage::fill);
  connect(&work, &VisitWork::fieldChanged, this, [this](const QString& name) {
    FormField* changed = field(name.toStdString());
    if (changed != nullptr && !changed->isAncestorOf(focusWidget())) {
      const auto& fields = this->work().fields();
      const auto found = fields.find(name.toStdString());
      changed->setValue(found == fields.end() ? json() : *found);
    }
    showSigns();
    showDone();
  });
  for (const int step : {1, -1}) {
    auto* action = new QAction(step > 0 ? tr("Next section") : tr("Previous section"), this);
    action->setShortcut(
        QKeySequence(static_cast<int>(Qt::CTRL) + (step > 0 ? Qt::Key_Down : Qt::Key_Up)));
    action->setShortcutContext(Qt::WidgetWithChildrenShortcut);
    connect(action, &QAction::triggered, this, [this, step] {
      const auto last = static_cast<int>(sections_.size()) - 1;
      goToSection(static_cast<std::size_t>(std::clamp(static_cast<int>(current_) + step, 0, last)));
    });
    addAction(action);
  }
}

QWidget* FormPage::makeNavigation() {
  navigation_ = new QWidget;
  auto* column = new QVBoxLayout(navigation_);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    const QString id = QLatin1String(sections_[i].form->id);
    QPushButton* button = makeButton(sectionWord(id), QStringLiteral("section"));
    button->setObjectName(QStringLiteral("section ") + id);
    button->setCheckable(true);
    button->setAutoExclusive(true);
    sections_[i].button = button;
    connect(button, &QPushButton::clicked, this, [this, i] { goToSection(i); });
    column->addWidget(button);
  }
  column->addSpacing(12);
  done_ = makeLabel({}, TypeRole::Small, QStringLiteral("secondary"));
  done_->setContentsMargins(12, 0, 0, 0);
  column->addWidget(done_);
  column->addStretch();
  navigation_->setFixedWidth(Look::px(216));
  return navigation_;
}

QWidget* FormPage::makeForm() {
  QFrame* card = makeFrame(QStringLiteral("card"));
  card_ = card;
  auto* outer = new QVBoxLayout(card);
  outer->setContentsMargins(0, 0, 4, 0);
  auto* inside = new QWidget;
  auto* column = new QVBoxLayout(inside);
  column->setContentsMargins(32, 24, 28, 24);
  column->setSpacing(28);
  for (const FormSection& section : formSections()) {
    auto* box = new QWidget;
    auto* rows = new QVBoxLayout(box);
    rows->setContentsMargins(0, 0, 0, 0);
    rows->setSpacing(18);
    rows->addWidget(makeLabel(sectionWord(QLatin1String(section.id)), TypeRole::Heading));
    for (const auto& names : section.rows) {
      if (fieldNamed(names.front()).type == FieldType::Flag) {
        makeSigns(rows, names);
      } else {
        rows->addWidget(makeRow(names));
      }
    }
    column->addWidget(box);
    sections_.push_back({&section, box, nullptr});
  }
  column->addStretch();
  scroll_ = new QScrollArea;
  scroll_->setWidgetResizable(true);
  scroll_->setFrameShape(QFrame::NoFrame);
  scroll_->setFocusPolicy(Qt::NoFocus);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setWidget(inside);
  outer->addWidget(scroll_);
  connect(
      scroll_->verticalScrollBar(), &QScrollBar::valueChanged, this, [this] { followScroll(); });
  return card;
}

QWidget* FormPage::makeRow(const std::vector<std::string_view>& names) {
  auto* box = new QWidget;
  auto* row = new QHBoxLayout(box);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(16);
  const bool alone = names.size() == 1 && fieldNamed(names.front()).type == FieldType::Number;
  for (const std::string_view name : names) {
    FormField* control = FormField::make(fieldNamed(name));
    fields_.push_back(control);
    row->addWidget(control, 1, Qt::AlignTop);
    connect(control, &FormField::changed, this, [this](const QString& what, const json& value) {
      take(what, &value);
    });
  }
  if (alone) {
    row->addStretch(1);  // a number needs no whole line
  }
  return box;
}

void FormPage::makeSigns(QVBoxLayout* column, const std::vector<std::string_view>& names) {
  auto* grid = new QGridLayout;
  grid->setSpacing(8);
  int i = 0;
  for (const std::string_view name : names) {
    FormField* tile = FormField::make(fieldNamed(name));
    fields_.push_back(tile);
    grid->addWidget(tile, i / 2, i % 2);
    ++i;
    connect(tile, &FormField::changed, this, [this](const QString& what, const json& value) {
      take(what, &value);
      answerSigns(false);
    });
  }
  no_signs_ = new QCheckBox(tr("None of these"));
  no_signs_->setObjectName(QStringLiteral("no signs"));
  no_signs_->setProperty("role", QStringLiteral("tile"));
  Look::setType(no_signs_, TypeRole::Label);
  grid->addWidget(no_signs_, i / 2, i % 2);
  grid->setColumnStretch(0, 1);
  grid->setColumnStretch(1, 1);
  connect(no_signs_, &QCheckBox::clicked, this, [this](bool none) { answerSigns(none); });
  column->addLayout(grid);
}

/// The first tick answers the whole list: what is not ticked was not found. "None" taken back makes
/// all of it unknown again.
void FormPage::answerSigns(bool none) {
  const bool taken_back = sender() == no_signs_ && !none;
  for (const VisitField& each : visitFields()) {
    if (each.type != FieldType::Flag) {
      continue;
    }
    const std::string name(each.name);
    if (none || taken_back) {
      work().setField(name, none ? json(false) : json());
      field(each.name)->setValue(json());
    } else if (!work().fields().contains(name)) {
      work().setField(name, false);
    }
  }
  showSigns();
}

void FormPage::showSigns() {
  bool all_known = true;
  bool any = false;
  for (const VisitField& each : visitFields()) {
    if (each.type == FieldType::Flag) {
      const auto found = work().fields().find(std::string(each.name));
      all_known = all_known && found != work().fields().end();
      any = any || (found != work().fields().end() && found->is_boolean() && found->get<bool>());
    }
  }
  no_signs_->setChecked(all_known && !any);
}

FormField* FormPage::field(std::string_view name) const {
  for (FormField* each : fields_) {
    if (each->name() == QLatin1String(name.data(), static_cast<int>(name.size()))) {
      return each;
    }
  }
  return nullptr;
}

void FormPage::take(const QString& name, const void* value) {
  work().setField(name.toStdString(), *static_cast<const json*>(value));
  showDone();
}

void FormPage::fill() {
  const VisitFacts& facts = work().facts();
  const bool may_edit = work().mayEdit();
  for (FormField* each : fields_) {
    const std::string name = each->name().toStdString();
    const auto found = work().fields().find(name);
    each->setValue(found == work().fields().end() ? json() : *found);
    each->setEnabled(may_edit);
    const auto earlier = facts.earlier.find(name);
    each->clearEarlier();
    if (earlier != facts.earlier.end()) {
      each->setEarlier(earlier->second.value, earlier->second.date, may_edit && !isAskedAnew(name));
    }
  }
  no_signs_->setEnabled(may_edit);
  showSigns();
  showDone();
}

bool FormPage::isDone(const FormSection& section) const {
  bool all = true;
  bool any = false;
  bool only_texts = true;
  for (const auto& row : section.rows) {
    for (const std::string_view name : row) {
      const bool text = fieldNamed(name).type == FieldType::Text;
      const bool known = work().fields().contains(std::string(name));
      only_texts = only_texts && text;
      all = all && (known || text);
      any = any || known;
    }
  }
  return only_texts ? any : all;
}

void FormPage::showDone() {
  int count = 0;
  for (const Section& section : sections_) {
    const bool done = isDone(*section.form);
    count += done ? 1 : 0;
    section.button->setIcon(done ? themeIcon(QStringLiteral("check"))
                                 : themeIcon(QStringLiteral("blank")));
    section.button->setAccessibleName(done ? tr("%1, done").arg(section.button->text())
                                           : section.button->text());
  }
  QString text = tr("%1 of %2 sections done.").arg(count).arg(sections_.size());
  if (!work().facts().earlier.empty()) {
    text += QLatin1Char('\n') + tr("Values in italics are from earlier visits; touch to keep.");
  }
  done_->setText(text);
}

void FormPage::goToSection(std::size_t index) {
  current_ = index;
  sections_[index].button->setChecked(true);
  const QSignalBlocker quiet(scroll_->verticalScrollBar());
  scroll_->verticalScrollBar()->setValue(sections_[index].box->y() - 24);
  scroll_->widget()->update();
  FormField* first = field(sections_[index].form->rows.front().front());
  first->focusFirst();
}

void FormPage::followScroll() {
  const QScrollBar* bar = scroll_->verticalScrollBar();
  const int top = bar->value() + scroll_->viewport()->height() / 4;
  if (bar->value() == bar->maximum() && sections_[current_].box->y() > top) {
    return;  // the last ones cannot come to the top
  }
  for (std::size_t i = 0; i < sections_.size(); ++i) {
    if (sections_[i].box->y() <= top) {
      current_ = i;
    }
  }
  sections_[current_].button->setChecked(true);
}

void FormPage::reset() {
  scroll_->verticalScrollBar()->setValue(0);
  current_ = 0;
  sections_.front().button->setChecked(true);
  build_->reset();
}

void FormPage::enter() {
  fill();
  build_->enter();
  const auto hand = std::ranges::find_if(
      sections_, [](const Section& each) { return std::string_view(each.form->id) == "hand"; });
  if (work().noScan() && !isDone(*hand->form)) {
    goToSection(static_cast<std::size_t>(hand - sections_.begin()));
  } else {
    field(sections_[current_].form->rows.front().front())->focusFirst();
  }
}

void FormPage::leave() { work().save(); }

void FormPage::primary() { build_->pressContinue(); }

void FormPage::resizeEvent(QResizeEvent* event) {
  VisitPage::resizeEvent(event);
  arrange();
}

void FormPage::arrange() {
  const bool narrow = width() < Look::px(1300);
  tight_ = width() < Look::px(1000);  // large text
  const bool model = tight_ && tabs_->current() == 1;
  tabs_->setVisible(tight_);
  navigation_->setVisible(!tight_);
  card_->setVisible(!model);
  build_->setVisible(!tight_ || model);
  card_->setMaximumWidth(tight_ ? QWIDGETSIZE_MAX : Look::px(kWidest));
  int names = Look::px(narrow ? 184 : 216);
  for (const Section& section : sections_) {
    names = std::max(names, section.button->sizeHint().width());
  }
  navigation_->setFixedWidth(names);
  if (tight_) {
    build_->setMinimumWidth(0);
    build_->setMaximumWidth(QWIDGETSIZE_MAX);
  } else {
    build_->setFixedWidth(Look::px(narrow ? 320 : 376));
  }
}

}  // namespace tarsus
