#include "ui/screens/patient_screen.h"

#include "ui/look/icons.h"
#include "ui/parts/area_chart.h"
#include "ui/parts/controls.h"
#include "ui/parts/empty_place.h"
#include "ui/parts/foot_map.h"
#include "ui/parts/note.h"
#include "ui/parts/visit_card.h"
#include "ui/parts/words.h"
#include "ui/screens/wound_form.h"
#include "ui/work/session.h"

#include <QDateTime>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLocale>
#include <QPainter>
#include <QScrollArea>
#include <QStackedWidget>
#include <QTimer>
#include <QVBoxLayout>
#include <QVariant>

namespace tarsus {
namespace {

QString qString(const std::string& text) { return QString::fromStdString(text); }

QScrollArea* makeScroll(QWidget* inside) {
  auto* area = new QScrollArea;
  area->setWidgetResizable(true);
  area->setFrameShape(QFrame::NoFrame);
  area->setFocusPolicy(Qt::NoFocus);
  area->setWidget(inside);
  return area;
}

void removeAll(QLayout* layout) {
  while (QLayoutItem* item = layout->takeAt(0)) {
    if (item->widget() != nullptr) {
      item->widget()->hide();
      item->widget()->deleteLater();
    }
    delete item;
  }
}

/// "14 Mar 1958 (68), No. 40-2817"
QString bornAndNumber(const PatientFields& fields, const QDate& today) {
  QStringList parts;
  if (const QDate born = dateOf(fields.birth_date); born.isValid()) {
    const bool had_birthday =
        std::pair(today.month(), today.day()) >= std::pair(born.month(), born.day());
    parts << PatientScreen::tr("%1 (%2)", "birth date, age")
                 .arg(dayMonthYear(born))
                 .arg(today.year() - born.year() - (had_birthday ? 0 : 1));
  }
  if (!fields.identifier.empty()) {
    parts << PatientScreen::tr("No. %1").arg(qString(fields.identifier));
  }
  return parts.join(QStringLiteral(", "));
}

QString stateOfWound(const WoundFields& fields) {
  if (!fields.healed_on.empty()) {
    return PatientScreen::tr("Healed %1").arg(dayMonthYear(dateOf(fields.healed_on)));
  }
  const QString cause = aetiologyWord(qString(fields.aetiology));
  return fields.onset.empty() ? PatientScreen::tr("Open, %1").arg(cause)
                              : PatientScreen::tr("Open since %1, %2")
                                    .arg(dayMonthYear(dateOf(fields.onset)), cause);
}

FootMap::Marker markerOf(const WoundSummary& wound) {
  const QString site =
      siteLong(wound.side, qString(wound.fields.place), qString(wound.fields.aspect));
  return {
      .id = qString(wound.id),
      .side = wound.side,
      .place = qString(wound.fields.place),
      .number = wound.number,
      .healed = wound.healed(),
      .words =
          PatientScreen::tr("Wound %1, %2, %3")
              .arg(wound.number)
              .arg(site, wound.healed() ? PatientScreen::tr("healed") : PatientScreen::tr("open"))};
}

/// A wound of the list under the map.
class WoundRow : public QAbstractButton {
 public:
  explicit WoundRow(const WoundSummary& wound)
      : site_(siteShort(wound.side, qString(wound.fields.place), qString(wound.fields.aspect))),
        state_(stateOfWound(wound.fields)),
        number_(wound.number),
        healed_(wound.healed()) {
    setCheckable(true);
    setAutoExclusive(true);
    setCursor(Qt::PointingHandCursor);
    setProperty("ring", true);
    setAccessibleName(site_ + QStringLiteral(", ") + state_);
    Look::setFixedHeight(this, 56);
  }

 protected:
  void paintEvent(QPaintEvent*) override {
    const Theme& theme = Look::theme();
    QPainter painter(this);
    painter.setRenderHint(QPainter::Antialiasing);
    if (isChecked()) {
      painter.setPen(theme.note_edge_px > 0 ? QPen(theme.accent, 2.0) : QPen(Qt::NoPen));
      painter.setBrush(theme.accent_weak);
      painter.drawRoundedRect(QRectF(rect()).adjusted(1, 1, -1, -1), 6.0, 6.0);
    }
    const double r = Look::px(13);
    const QPointF at(Look::px(25), height() / 2.0);
    const QRectF disc(at.x() - r, at.y() - r, 2 * r, 2 * r);
    painter.setPen(healed_ ? QPen(theme.accent, 2.0) : QPen(Qt::NoPen));
    painter.setBrush(healed_ ? theme.surface : theme.danger);
    painter.drawEllipse(disc);
    painter.setFont(Look::font(TypeRole::Label));
    if (healed_) {
      drawIcon(painter, QStringLiteral("check"), disc.adjusted(5, 5, -5, -5), theme.accent_text);
    } else {
      painter.setPen(Look::choice() == ThemeChoice::Light ? QColor(Qt::white) : QColor(Qt::black));
      painter.drawText(disc, Qt::AlignCenter, QString::number(number_));
    }
    const double left = Look::px(50);
    const int room = width() - static_cast<int>(left) - 8;
    painter.setFont(Look::font(TypeRole::Strong));
    painter.setPen(theme.text);
    painter.drawText(QRectF(left, 0, room, height() / 2.0 + 2),
                     Qt::AlignLeft | Qt::AlignBottom,
                     QFontMetrics(painter.font()).elidedText(site_, Qt::ElideRight, room));
    painter.setFont(Look::font(TypeRole::Small));
    painter.setPen(theme.text_secondary);
    painter.drawText(QRectF(left, height() / 2.0 + 2, room, height() / 2.0 - 2),
                     Qt::AlignLeft | Qt::AlignTop,
                     QFontMetrics(painter.font()).elidedText(state_, Qt::ElideRight, room));
  }

 private:
  QString site_;
  QString state_;
  int number_;
  bool healed_;
};

QWidget* makeFigure(QLabel*& title, QLabel*& value, const QString& text, TypeRole role) {
  auto* box = new QWidget;
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  title = makeLine(text, TypeRole::Small, QStringLiteral("secondary"));
  value = makeLine({}, role);
  column->addWidget(title);
  column->addWidget(value);
  return box;
}

}  // namespace

PatientScreen::PatientScreen(Session& session, QWidget* parent)
    : Screen(parent), session_(session) {
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(24, 24, 24, 24);
  row->setSpacing(24);
  row->addWidget(makeLeft());
  row->addWidget(makeRight(), 1);
  connect(&Look::instance(), &Look::changed, this, [this] {
    if (!id_.isEmpty()) {
      show();
    }
  });
}

QWidget* PatientScreen::makeLeft() {
  auto* inside = new QWidget;
  auto* column = new QVBoxLayout(inside);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  auto* names = new QVBoxLayout;
  names->setSpacing(0);
  name_ = makeLabel({}, TypeRole::Title);
  born_ = makeLabel({}, TypeRole::Base, QStringLiteral("secondary"));
  names->addWidget(name_);
  names->addWidget(born_);
  column->addLayout(names);
  column->addWidget(makeWounds());
  known_card_ = makeFrame(QStringLiteral("card"));
  known_ = new QGridLayout(known_card_);
  known_->setContentsMargins(16, 14, 16, 14);
  known_->setVerticalSpacing(4);
  known_->setHorizontalSpacing(16);
  known_->setColumnStretch(0, 2);
  known_->setColumnStretch(1, 5);
  column->addWidget(known_card_);
  column->addStretch();
  left_ = makeScroll(inside);
  left_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  left_->setFixedWidth(Look::px(356));
  return left_;
}

QWidget* PatientScreen::makeWounds() {
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(16, 12, 16, 16);
  column->setSpacing(8);
  auto* top = new QHBoxLayout;
  top->addWidget(makeLine(tr("Wounds"), TypeRole::Strong));
  top->addStretch();
  place_ = makeButton(tr("Place a wound"), QStringLiteral("quiet"), "plus");
  top->addWidget(place_);
  column->addLayout(top);
  map_ = new FootMap;
  map_->setProperty("ring", true);
  column->addWidget(map_);
  rows_box_ = new QWidget;
  wound_rows_ = new QVBoxLayout(rows_box_);
  wound_rows_->setContentsMargins(0, 0, 0, 0);
  wound_rows_->setSpacing(4);
  column->addWidget(rows_box_);
  form_ = new WoundForm;
  form_->hide();
  column->addWidget(form_);
  connect(place_, &QPushButton::clicked, this, [this] {
    placeAt(FootSide::Right, QStringLiteral("mth_1"));
  });
  connect(map_, &FootMap::placeTouched, this, &PatientScreen::placeAt);
  connect(map_, &FootMap::woundPicked, this, [this](const QString& id) {
    wound_id_ = id.toStdString();
    endPlacing();
    show();
  });
  connect(form_, &WoundForm::givenUp, this, &PatientScreen::endPlacing);
  connect(form_, &WoundForm::proposed, map_, &FootMap::setProposal);
  connect(form_, &WoundForm::accepted, this, &PatientScreen::addWoundHere);
  return card;
}

QWidget* PatientScreen::makeFigures() {
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* row = new QHBoxLayout(card);
  row->setContentsMargins(16, 16, 16, 12);
  row->setSpacing(24);
  auto* column = new QVBoxLayout;
  column->setSpacing(2);
  column->addWidget(makeFigure(area_title_, area_, {}, TypeRole::KeyFigure));
  Look::setType(area_title_, TypeRole::Base);
  range_ = makeLine({}, TypeRole::Base, QStringLiteral("secondary"));
  column->addWidget(range_);
  column->addSpacing(14);
  changes_ = new QWidget;
  auto* changes = new QHBoxLayout(changes_);
  changes->setContentsMargins(0, 0, 0, 0);
  changes->setSpacing(24);
  QLabel* title = nullptr;
  changes->addWidget(makeFigure(since_last_title_, since_last_, {}, TypeRole::Heading));
  changes->addWidget(makeFigure(title, since_baseline_, tr("Since baseline"), TypeRole::Heading));
  changes->addStretch();
  column->addWidget(changes_);
  column->addSpacing(12);
  advance_box_ = makeFigure(title, advance_, tr("Edge advance"), TypeRole::Strong);
  column->addWidget(advance_box_);
  column->addStretch();
  row->addLayout(column);
  chart_ = new AreaChart;
  row->addWidget(chart_, 1);
  return card;
}

QWidget* PatientScreen::makeVisits() {
  auto* page = new QWidget;
  auto* column = new QVBoxLayout(page);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(12);
  QWidget* figures = makeFigures();
  figures->setMinimumHeight(Look::px(240));
  column->addWidget(figures, 1);
  auto* head = new QHBoxLayout;
  head->setSpacing(8);
  head->addWidget(makeLine(tr("Visits"), TypeRole::Heading));
  head->addWidget(makeLine(tr("newest first"), TypeRole::Base, QStringLiteral("secondary")));
  head->addStretch();
  column->addLayout(head);
  strip_ = new QWidget;
  auto* cards = new QHBoxLayout(strip_);
  cards->setContentsMargins(0, 0, 0, 0);
  cards->setSpacing(16);
  QScrollArea* area = makeScroll(strip_);
  area->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  area->setFixedHeight(Look::px(218) + 14);
  column->addWidget(area);
  return page;
}

QWidget* PatientScreen::makeFoot() {
  auto* foot = new QWidget;
  auto* row = new QHBoxLayout(foot);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(12);
  auto* notes = new QVBoxLayout;
  note_ = new Note(Note::Kind::Warning);
  problem_ = new Note(Note::Kind::Danger);
  notes->addWidget(note_);
  notes->addWidget(problem_);
  row->addLayout(notes, 1);
  start_ = makeButton(tr("Start new visit"), {}, "plus");
  start_->setObjectName(QStringLiteral("start visit"));
  start_->setProperty("target", QStringLiteral("large"));
  continue_ = makeButton(tr("Continue the draft"), QStringLiteral("primary"));
  continue_->setObjectName(QStringLiteral("continue"));
  row->addWidget(start_, 0, Qt::AlignBottom);
  row->addWidget(continue_, 0, Qt::AlignBottom);
  connect(start_, &QPushButton::clicked, this, &PatientScreen::startVisit);
  connect(continue_, &QPushButton::clicked, this, [this] {
    if (const VisitSummary* open = draft(); open != nullptr) {
      emit visitChosen(qString(open->id));
    }
  });
  return foot;
}

QWidget* PatientScreen::makeRight() {
  auto* right = new QWidget;
  auto* column = new QVBoxLayout(right);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  title_ = makeLabel({}, TypeRole::Heading);
  title_->setMinimumHeight(Look::px(40));
  column->addWidget(title_);
  pages_ = new QStackedWidget;
  visits_page_ = makeVisits();
  pages_->addWidget(visits_page_);
  for (const auto& [icon, title, text] :
       {std::tuple(QStringLiteral("foot"),
                   tr("No wound placed"),
                   tr("Touch the foot map where the wound is.")),
        std::tuple(QStringLiteral("clock"),
                   tr("No visits yet"),
                   tr("Start the first visit to see healing here."))}) {
    QFrame* card = makeFrame(QStringLiteral("card"));
    auto* inside = new QVBoxLayout(card);
    inside->addWidget(new EmptyPlace(icon, title, text));
    pages_->addWidget(card);
  }
  column->addWidget(pages_, 1);
  column->addWidget(makeFoot());
  return right;
}

QStringList PatientScreen::crumbs() const {
  return {tr("Patients"), id_.isEmpty() ? QString() : fullName(summary_.patient.fields)};
}

void PatientScreen::open(const QString& patient_id) {
  if (id_ != patient_id) {
    forget();
    id_ = patient_id;
  }
  endPlacing();
  load();
}

void PatientScreen::forget() {
  id_.clear();
  wound_id_.clear();
  summary_ = {};
  problem_->setText({});
  show();
}

void PatientScreen::load() {
  session_.ask<PatientSummary>(
      Session::Kind::Read,
      this,
      [id = id_.toStdString()](Store& store) { return patientSummary(store, id); },
      [this, id = id_](Expected<PatientSummary> summary) {
        if (id != id_) {
          return;
        }
        if (!summary) {
          refuse(tr("The patient could not be read."), summary.error());
          return;
        }
        summary_ = std::move(*summary);
        show();
        emit crumbsChanged();
        emit loaded();
      });
}

void PatientScreen::refuse(const QString& what, const Error& error) {
  if (error.code != ErrorCode::StoreLocked) {
    problem_->setText(what, sentenceOf(error));
  }
}

const WoundSummary* PatientScreen::wound() const {
  for (const WoundSummary& wound : summary_.wounds) {
    if (wound.id == wound_id_) {
      return &wound;
    }
  }
  return summary_.wounds.empty() ? nullptr : &summary_.wounds.front();
}

const VisitSummary* PatientScreen::draft() const {
  const WoundSummary* shown = wound();
  if (shown != nullptr) {
    for (auto visit = shown->visits.rbegin(); visit != shown->visits.rend(); ++visit) {
      if (visit->state == VisitState::Draft) {
        return &*visit;
      }
    }
  }
  return nullptr;
}

void PatientScreen::show() {
  const QDate today = QDateTime::fromMSecsSinceEpoch(session_.nowMs()).date();
  name_->setText(fullName(summary_.patient.fields));
  born_->setText(bornAndNumber(summary_.patient.fields, today));
  form_->setLatest(today);
  place_->setVisible(session_.mayEdit());
  map_->setCanPlace(session_.mayEdit());
  std::vector<FootMap::Marker> markers;
  for (const WoundSummary& wound : summary_.wounds) {
    markers.push_back(markerOf(wound));
  }
  map_->setMarkers(std::move(markers));
  const WoundSummary* shown = wound();
  map_->setSelected(shown != nullptr ? qString(shown->id) : QString());
  showWoundRows();
  showKnown();
  showWound();
}

void PatientScreen::showWoundRows() {
  removeAll(wound_rows_);
  const WoundSummary* shown = wound();
  for (const WoundSummary& each : summary_.wounds) {
    auto* row = new WoundRow(each);
    row->setChecked(shown != nullptr && each.id == shown->id);
    connect(row, &QAbstractButton::clicked, map_, [this, id = each.id] {
      emit map_->woundPicked(qString(id));
    });
    wound_rows_->addWidget(row);
  }
}

void PatientScreen::showKnown() {
  removeAll(known_);
  known_card_->setVisible(!summary_.known.empty());
  int row = 0;
  for (const LastKnown& known : summary_.known) {
    known_->addWidget(makeLabel(known.name, TypeRole::Small, QStringLiteral("secondary")), row, 0);
    auto* value = new QWidget;
    auto* line = new QHBoxLayout(value);
    line->setContentsMargins(0, 0, 0, 0);
    line->setSpacing(8);
    line->addWidget(makeLabel(known.value, TypeRole::Chip), 1);
    line->addWidget(makeLine(dayMonth(known.date), TypeRole::Small, QStringLiteral("secondary")));
    known_->addWidget(value, row++, 1);
  }
}

void PatientScreen::showWound() {
  const WoundSummary* shown = wound();
  title_->setText(shown == nullptr ? QString()
                                   : tr("Wound %1: %2")
                                         .arg(shown->number)
                                         .arg(siteLong(shown->side,
                                                       qString(shown->fields.place),
                                                       qString(shown->fields.aspect))));
  title_->setVisible(shown != nullptr);
  const VisitSummary* open = draft();
  start_->setVisible(shown != nullptr && session_.mayEdit());
  continue_->setVisible(open != nullptr && session_.mayEdit());
  setStyleProperty(start_, "role", open == nullptr ? QStringLiteral("primary") : QString());
  start_->setIcon(themeIcon(QStringLiteral("plus"), open == nullptr ? Tone::OnAccent : Tone::Text));
  note_->setText(
      open == nullptr ? QString() : tr("The visit of %1 is a draft.").arg(dayMonth(open->date)),
      open == nullptr ? QString() : tr("It still needs your signature."));
  if (shown == nullptr || shown->visits.empty()) {
    pages_->setCurrentIndex(shown == nullptr ? 1 : 2);
    return;
  }
  pages_->setCurrentWidget(visits_page_);
  removeAll(strip_->layout());
  cards_.clear();
  std::vector<AreaPoint> points;
  const VisitSummary& baseline = shown->visits.front();
  for (const VisitSummary& visit : shown->visits) {
    if (visit.area_mm2) {
      const auto& range = visit.area_interval_mm2;
      points.push_back({.weeks = static_cast<double>(baseline.date.daysTo(visit.date)) / 7.0,
                        .area_mm2 = *visit.area_mm2,
                        .low_mm2 = range ? std::optional(range->low) : std::nullopt,
                        .high_mm2 = range ? std::optional(range->high) : std::nullopt,
                        .draft = visit.state == VisitState::Draft});
    }
  }
  chart_->setPoints(std::move(points));
  auto* strip = static_cast<QHBoxLayout*>(strip_->layout());
  for (std::size_t i = shown->visits.size(); i-- > 0;) {
    auto* card = new VisitCard(shown->visits[i], baseline);
    connect(card, &QAbstractButton::clicked, this, [this, i] { showVisit(i); });
    strip->addWidget(card, 0, Qt::AlignTop);
    cards_.push_back(card);
  }
  strip->addStretch();
  cards_.front()->setChecked(true);
  showVisit(shown->visits.size() - 1);
}

void PatientScreen::showVisit(std::size_t index) {
  const WoundSummary* shown = wound();
  const VisitSummary& visit = shown->visits.at(index);
  const VisitSummary& baseline = shown->visits.front();
  const QString day = dayMonth(visit.date);
  area_title_->setText(visit.state == VisitState::Draft ? tr("Area, %1 (draft)").arg(day)
                                                        : tr("Area, %1").arg(day));
  area_->setText(visit.area_mm2 ? areaText(*visit.area_mm2) : tr("not computable"));
  Look::setType(area_, visit.area_mm2 ? TypeRole::KeyFigure : TypeRole::Heading);
  const auto& range = visit.area_interval_mm2;
  const QLocale locale;
  range_->setText(range ? tr("95 %: %1 to %2")
                              .arg(locale.toString(range->low / 100.0, 'f', 2),
                                   locale.toString(range->high / 100.0, 'f', 2))
                        : QString());
  changes_->setVisible(index > 0);
  std::optional<double> advance;
  if (index > 0) {
    const VisitSummary& last = shown->visits[index - 1];
    const auto since_last = areaRatio(last, visit);
    const auto since_start = areaRatio(baseline, visit);
    since_last_title_->setText(tr("Since %1").arg(dayMonth(last.date)));
    since_last_->setText(since_last ? changeText(*since_last) : tr("not computable"));
    since_baseline_->setText(since_start ? changeText(*since_start) : tr("not computable"));
    advance = edgeAdvance(last, visit);
  }
  advance_box_->setVisible(advance.has_value());
  if (advance) {
    QString rate = locale.toString(*advance, 'f', 2);
    rate.replace(QLatin1Char('-'), QChar(0x2212));
    advance_->setText(tr("%1 mm per week").arg(rate));
  }
}

void PatientScreen::placeAt(FootSide side, const QString& place) {
  map_->setProposal(side, place);
  form_->propose(side, place);
  rows_box_->hide();
  known_card_->hide();
  form_->show();
  // Once the layout has made room for it.
  QTimer::singleShot(60, form_, [this] { left_->ensureWidgetVisible(form_, 0, 0); });
}

void PatientScreen::endPlacing() {
  form_->hide();
  rows_box_->show();
  known_card_->setVisible(!summary_.known.empty());
  map_->setProposal(FootSide::Right, {});
}

void PatientScreen::addWoundHere(FootSide side, const WoundFields& fields) {
  if (busy_) {
    return;
  }
  busy_ = true;
  std::string foot_id;
  for (const Foot& foot : summary_.feet) {
    if (foot.fields.side == side) {
      foot_id = foot.id;
    }
  }
  session_.ask<Wound>(
      Session::Kind::Write,
      this,
      [patient = id_.toStdString(), foot_id, side, fields](Store& store) -> Expected<Wound> {
        if (!foot_id.empty()) {
          return addWound(store, foot_id, fields);
        }
        auto change =
            StoreChange::begin(store, Permission::EditRecords);  // foot and wound, or none
        if (!change) {
          return tl::unexpected(change.error());
        }
        auto wound =
            addFoot(store, patient, {.side = side, .missing_toes = {}})
                .and_then([&](const Foot& foot) { return addWound(store, foot.id, fields); });
        if (!wound) {
          return wound;
        }
        const auto done = change->commit();
        return done ? std::move(wound) : tl::unexpected(done.error());
      },
      [this](const Expected<Wound>& added) {
        busy_ = false;
        if (!added) {
          refuse(tr("The wound was not added."), added.error());
          return;
        }
        wound_id_ = added->id;
        endPlacing();
        load();
      });
}

void PatientScreen::startVisit() {
  const WoundSummary* shown = wound();
  if (busy_ || shown == nullptr) {
    return;
  }
  busy_ = true;
  session_.ask<Visit>(
      Session::Kind::Write,
      this,
      [wound = shown->id, now = session_.nowMs()](Store& store) {
        return addVisit(store, wound, {.taken_at_ms = now, .files = {}});
      },
      [this](const Expected<Visit>& visit) {
        busy_ = false;
        if (!visit) {
          refuse(tr("The visit was not started."), visit.error());
          return;
        }
        load();
        emit visitChosen(qString(visit->id));
      });
}

void PatientScreen::primary() {
  if (!session_.mayEdit()) {
    return;
  }
  if (const VisitSummary* open = draft(); open != nullptr) {
    emit visitChosen(qString(open->id));
  } else {
    startVisit();
  }
}

void PatientScreen::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && form_->isVisible()) {
    endPlacing();
    return;
  }
  if (event->key() == Qt::Key_N && session_.mayEdit() && wound() != nullptr) {
    startVisit();
    return;
  }
  const int step = event->key() == Qt::Key_Right ? 1 : event->key() == Qt::Key_Left ? -1 : 0;
  for (std::size_t i = 0; step != 0 && i < cards_.size(); ++i) {
    const std::size_t next = i + static_cast<std::size_t>(step);
    if (cards_[i]->isChecked() && next < cards_.size()) {
      cards_[next]->click();
      cards_[next]->setFocus(Qt::OtherFocusReason);
      return;
    }
  }
  Screen::keyPressEvent(event);
}

}  // namespace tarsus
