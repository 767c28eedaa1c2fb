#include "ui/screens/form_field.h"

#include "ui/parts/choice_row.h"
#include "ui/parts/controls.h"
#include "ui/parts/icon_label.h"
#include "ui/parts/words.h"
#include "ui/screens/form_words.h"

#include <QCheckBox>
#include <QHBoxLayout>
#include <QLineEdit>
#include <QLocale>
#include <QPlainTextEdit>
#include <QVBoxLayout>
#include <QVariant>

#include <cmath>
#include <optional>

namespace tarsus {
namespace {

using nlohmann::json;

QString qString(std::string_view text) {
  return QString::fromUtf8(text.data(), static_cast<int>(text.size()));
}

/// A number as it is typed here, with the locale's sign or a point; nothing: it is none.
std::optional<double> numberOf(const QString& typed) {
  bool is_number = false;
  double value = QLocale().toDouble(typed.trimmed(), &is_number);
  if (!is_number) {
    value = QLocale::c().toDouble(typed.trimmed(), &is_number);
  }
  return is_number && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// A line of typing with its unit inside the box, and room for an error under it.
class UnitLine : public QWidget {
 public:
  explicit UnitLine(const QString& unit) {
    auto* column = new QVBoxLayout(this);
    column->setContentsMargins(0, 0, 0, 0);
    column->setSpacing(4);
    line_ = new QLineEdit;
    line_->setInputMethodHints(Qt::ImhFormattedNumbersOnly);
    Look::setType(line_, TypeRole::Base);
    unit_ = makeLine(unit, TypeRole::Base, QStringLiteral("secondary"));
    unit_->setAttribute(Qt::WA_TransparentForMouseEvents);
    auto* inside = new QHBoxLayout(line_);
    inside->setContentsMargins(0, 0, 12, 0);
    inside->addStretch();
    inside->addWidget(unit_);
    column->addWidget(line_);
    below_ = new QWidget;
    auto* row = new QHBoxLayout(below_);
    row->setContentsMargins(0, 0, 0, 0);
    row->setSpacing(4);
    row->addWidget(new IconLabel(QStringLiteral("warning"), Tone::Danger, 16), 0, Qt::AlignTop);
    text_ = makeLabel({}, TypeRole::Chip, QStringLiteral("danger"));
    row->addWidget(text_, 1);
    column->addWidget(below_);
    below_->hide();
  }
  void setError(const QString& error) {
    text_->setText(error);
    below_->setVisible(!error.isEmpty());
    setStyleProperty(line_, "state", error.isEmpty() ? QString() : QStringLiteral("error"));
    line_->setAccessibleDescription(error);
  }
  [[nodiscard]] QString error() const { return text_->text(); }
  [[nodiscard]] QLineEdit* line() { return line_; }
  [[nodiscard]] QString unit() const { return unit_->text(); }

 private:
  QLineEdit* line_;
  QLabel* unit_;
  QWidget* below_;
  QLabel* text_;
};

class ChoiceField : public FormField {
 public:
  explicit ChoiceField(const VisitField& field) : FormField(field) {
    words_ = qString(field.words).split(QLatin1Char(' '));
    QStringList texts;
    for (const QString& word : words_) {
      texts << choiceWord(name(), word);
    }
    row_ = new ChoiceRow(texts);
    row_->setFills(fieldWord(name()));
    row_->setObjectName(name());
    column_->addWidget(row_);
    connect(row_, &ChoiceRow::chosen, this, [this](int index) {
      emit changed(name(), index < 0 ? json() : json(words_.at(index).toStdString()));
    });
  }
  void setValue(const json& value) override {
    row_->setCurrent(
        value.is_string() ? words_.indexOf(QString::fromStdString(value.get<std::string>())) : -1);
  }
  void focusFirst() override { row_->focusCurrent(); }

 private:
  QStringList words_;
  ChoiceRow* row_;
};

class NumberField : public FormField {
 public:
  explicit NumberField(const VisitField& field) : FormField(field) {
    line_ = new UnitLine(unitWord(name()));
    line_->line()->setObjectName(name());
    line_->line()->setAccessibleName(fieldWord(name()));
    column_->addWidget(line_);
    connect(line_->line(), &QLineEdit::textEdited, this, [this](const QString& text) {
      read(text, false);
    });
    connect(line_->line(), &QLineEdit::editingFinished, this, [this] {
      read(line_->line()->text(), true);
    });
  }
  void setValue(const json& value) override {
    line_->line()->setText(value.is_number() ? QLocale().toString(value.get<double>(), 'g', 6)
                                             : QString());
    line_->setError({});
  }
  [[nodiscard]] QString error() const override { return line_->error(); }
  void focusFirst() override { line_->line()->setFocus(Qt::TabFocusReason); }

 private:
  void read(const QString& text, bool finished) {
    const auto number = numberOf(text);
    const bool empty = text.trimmed().isEmpty();
    const bool possible = number && *number >= field_.least && *number <= field_.most;
    if (empty || possible) {
      line_->setError({});
      emit changed(name(), empty ? json() : json(*number));
      return;
    }
    // "6" on the way to "63": too small may still grow, too large cannot shrink.
    const bool may_grow = number && *number >= 0.0 && *number < field_.least;
    if (finished || !may_grow) {
      line_->setError(rangeError(field_));
    }
    emit changed(name(), json());
  }

  UnitLine* line_;
};

class TextField : public FormField {
 public:
  explicit TextField(const VisitField& field) : FormField(field) {
    const bool tall = field.name == "notes" || field.name == "plan";
    if (tall) {
      tall_ = new QPlainTextEdit;
      tall_->setTabChangesFocus(true);
      tall_->setObjectName(name());
      tall_->setAccessibleName(fieldWord(name()));
      Look::setType(tall_, TypeRole::Base);
      Look::setFixedHeight(tall_, 96);
      column_->addWidget(tall_);
      connect(
          tall_, &QPlainTextEdit::textChanged, this, [this] { announce(tall_->toPlainText()); });
      return;
    }
    line_ = new QLineEdit;
    line_->setObjectName(name());
    line_->setAccessibleName(fieldWord(name()));
    Look::setType(line_, TypeRole::Base);
    column_->addWidget(line_);
    connect(line_, &QLineEdit::textEdited, this, [this](const QString& text) { announce(text); });
  }
  void setValue(const json& value) override {
    const QString text =
        value.is_string() ? QString::fromStdString(value.get<std::string>()) : QString();
    if (line_ != nullptr) {
      if (line_->text() != text) {
        line_->setText(text);
      }
    } else if (tall_->toPlainText() != text) {
      const QSignalBlocker quiet(tall_);
      tall_->setPlainText(text);
    }
  }
  void focusFirst() override {
    QWidget* control = line_ != nullptr ? static_cast<QWidget*>(line_) : tall_;
    control->setFocus(Qt::TabFocusReason);
  }

 private:
  void announce(const QString& text) {
    emit changed(name(), text.trimmed().isEmpty() ? json() : json(text.toStdString()));
  }
  QLineEdit* line_ = nullptr;
  QPlainTextEdit* tall_ = nullptr;
};

/// Undermining and tunnels by the clock: none, or some ranges with a depth each.
class ClockField : public FormField {
 public:
  explicit ClockField(const VisitField& field) : FormField(field) {
    choice_ = new ChoiceRow({tr("None"), tr("By the clock")});
    choice_->setFills(fieldWord(name()));
    choice_->setObjectName(name());
    column_->addWidget(choice_);
    rows_ = new QVBoxLayout;
    rows_->setSpacing(8);
    column_->addLayout(rows_);
    add_ = makeButton(tr("Add a range"), QStringLiteral("quiet"), "plus");
    column_->addWidget(add_, 0, Qt::AlignLeft);
    add_->hide();
    connect(add_, &QPushButton::clicked, this, [this] { addRow({})->line()->setFocus(); });
    connect(choice_, &ChoiceRow::chosen, this, [this](int index) {
      clearRows();
      add_->setVisible(index == 1);
      if (index == 1) {
        addRow({})->line()->setFocus();
      }
      emit changed(name(), index == 0 ? json::array() : json());
    });
  }
  void setValue(const json& value) override {
    if (value == read() && !value.is_null()) {
      return;  // typed here just now
    }
    clearRows();
    choice_->setCurrent(!value.is_array() ? -1 : value.empty() ? 0 : 1);
    add_->setVisible(value.is_array() && !value.empty());
    if (value.is_array()) {
      for (const json& range : value) {
        addRow(range);
      }
    }
  }
  void focusFirst() override { choice_->focusCurrent(); }
  [[nodiscard]] QString error() const override {
    for (const Row& row : lines_) {
      for (UnitLine* line : {row.from, row.to, row.depth}) {
        if (!line->error().isEmpty()) {
          return line->error();
        }
      }
    }
    return {};
  }

 private:
  struct Row {
    QWidget* box;
    UnitLine* from;
    UnitLine* to;
    UnitLine* depth;
  };

  UnitLine* addRow(const json& range) {
    Row row{new QWidget,
            new UnitLine(tr("from, o'clock")),
            new UnitLine(tr("to, o'clock")),
            new UnitLine(tr("mm deep"))};
    auto* line = new QHBoxLayout(row.box);
    line->setContentsMargins(0, 0, 0, 0);
    line->setSpacing(8);
    const char* keys[] = {"from_clock", "to_clock", "depth_mm"};
    int i = 0;
    for (UnitLine* each : {row.from, row.to, row.depth}) {
      if (range.is_object()) {
        each->line()->setText(QLocale().toString(range.value(keys[i], 0.0), 'g', 6));
      }
      each->line()->setAccessibleName(fieldWord(name()) + QStringLiteral(", ") + each->unit());
      line->addWidget(each, 1, Qt::AlignTop);
      connect(each->line(), &QLineEdit::textEdited, this, [this] { emit changed(name(), read()); });
      ++i;
    }
    QToolButton* away = makeIconButton(QStringLiteral("close"), tr("Take this range away"));
    connect(away, &QToolButton::clicked, this, [this, box = row.box] {
      std::erase_if(lines_, [box](const Row& each) { return each.box == box; });
      box->hide();
      box->deleteLater();
      emit changed(name(), read());
    });
    line->addWidget(away, 0, Qt::AlignTop);
    rows_->addWidget(row.box);
    lines_.push_back(row);
    return row.from;
  }
  void clearRows() {
    for (const Row& row : lines_) {
      row.box->hide();
      row.box->deleteLater();
    }
    lines_.clear();
  }
  /// The ranges that are whole; an unfinished one waits.
  [[nodiscard]] json read() const {
    if (choice_->current() == 0) {
      return json::array();
    }
    json ranges = json::array();
    for (const Row& row : lines_) {
      const auto from = valueIn(row.from, 1.0, 12.0, tr("1 to 12 o'clock, please check."));
      const auto to = valueIn(row.to, 1.0, 12.0, tr("1 to 12 o'clock, please check."));
      const auto depth = valueIn(row.depth, 0.0, 400.0, tr("0 to 400 mm, please check."));
      if (from && to && depth) {
        ranges.push_back({{"from_clock", *from}, {"to_clock", *to}, {"depth_mm", *depth}});
      }
    }
    return ranges.empty() ? json() : ranges;
  }
  static std::optional<double> valueIn(UnitLine* line,
                                       double least,
                                       double most,
                                       const QString& error) {
    const QString text = line->line()->text().trimmed();
    const auto number = numberOf(text);
    const bool possible = number && *number >= least && *number <= most;
    line->setError(text.isEmpty() || possible ? QString() : error);
    return possible ? number : std::nullopt;
  }

  ChoiceRow* choice_;
  QVBoxLayout* rows_;
  QPushButton* add_;
  std::vector<Row> lines_;
};

/// A sign that is there or not, as a tile.
class FlagField : public FormField {
 public:
  explicit FlagField(const VisitField& field) : FormField(field) {
    tile_ = new QCheckBox(fieldWord(name()));
    tile_->setObjectName(name());
    tile_->setProperty("role", QStringLiteral("tile"));
    Look::setType(tile_, TypeRole::Label);
    column_->addWidget(tile_);
    connect(tile_, &QCheckBox::clicked, this, [this](bool on) { emit changed(name(), json(on)); });
  }
  void setValue(const json& value) override {
    tile_->setChecked(value.is_boolean() && value.get<bool>());
  }
  void focusFirst() override { tile_->setFocus(Qt::TabFocusReason); }

 private:
  QCheckBox* tile_;
};

}  // namespace

QString rangeError(const VisitField& field) {
  const QLocale locale;
  const QString unit = unitWord(qString(field.name));
  const QString most =
      locale.toString(field.most, 'g', 6) + (unit.isEmpty() ? QString() : QChar(0x00A0) + unit);
  return FormField::tr("%1 to %2, please check.").arg(locale.toString(field.least, 'g', 6), most);
}

FormField::FormField(const VisitField& field) : field_(field), name_(qString(field.name)) {
  column_ = new QVBoxLayout(this);
  column_->setContentsMargins(0, 0, 0, 0);
  column_->setSpacing(4);
  if (field.type == FieldType::Flag) {
    return;  // a tile is its own label
  }
  auto* top = new QHBoxLayout;
  top->setSpacing(8);
  top->addWidget(makeLine(fieldWord(name_), TypeRole::Label));
  top->addStretch();
  earlier_ = makeButton({}, QStringLiteral("earlier"));
  earlier_->setObjectName(name_ + QStringLiteral(" earlier"));
  Look::setType(earlier_, TypeRole::Small);
  const auto lean = [this] {
    QFont italic = Look::font(TypeRole::Small);
    italic.setItalic(true);
    earlier_->setFont(italic);
  };
  lean();
  connect(&Look::instance(), &Look::changed, this, lean);
  earlier_->hide();
  connect(earlier_, &QPushButton::clicked, this, [this] {
    setValue(earlier_value_);
    emit changed(name_, earlier_value_);
  });
  top->addWidget(earlier_);
  column_->addLayout(top);
}

void FormField::setEarlier(const json& value, const QDate& date, bool may_keep) {
  if (earlier_ == nullptr) {
    return;
  }
  QString text = valueWord(name_, value);
  constexpr int kLongest = 40;
  if (text.size() > kLongest) {
    text = text.left(kLongest - 1) + QChar(0x2026);
  }
  earlier_value_ = value;
  earlier_->setText(tr("%1: %2", "date, value").arg(dayMonth(date), text));
  earlier_->setEnabled(may_keep);
  earlier_->setToolTip(may_keep ? tr("Keep this value") : tr("Please look anew"));
  earlier_->setVisible(true);
}

void FormField::clearEarlier() {
  if (earlier_ != nullptr) {
    earlier_->hide();
  }
}

FormField* FormField::make(const VisitField& field) {
  switch (field.type) {
    case FieldType::Words:
      return new ChoiceField(field);
    case FieldType::Number:
      return new NumberField(field);
    case FieldType::Flag:
      return new FlagField(field);
    case FieldType::ClockRanges:
      return new ClockField(field);
    case FieldType::Text:
      break;
  }
  return new TextField(field);
}

}  // namespace tarsus
