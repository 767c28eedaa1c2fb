#include "ui/screens/build_panel.h"

#include "reconstruction/scene/mesh_picture.h"
#include "ui/parts/chip.h"
#include "ui/parts/controls.h"
#include "ui/parts/stage_mark.h"
#include "ui/parts/words.h"
#include "ui/work/background_job.h"
#include "ui/work/images.h"
#include "ui/work/visit_work.h"

#include <QCoreApplication>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLocale>
#include <QProgressBar>
#include <QVBoxLayout>

#include <cmath>

namespace tarsus {
namespace {

constexpr double kMisfitOfCare_mm = 1.2;  // scans that were tracked well stay under it
constexpr double kFramesOfCare = 0.9;     // share
constexpr double kUnseenOfCare = 0.05;    // share of the surface without a sharp picture

QString minutes(double seconds) {
  const int s = static_cast<int>(std::lround(seconds));
  return QStringLiteral("%1:%2").arg(s / 60).arg(s % 60, 2, 10, QLatin1Char('0'));
}

QString percentText(double share) {
  return QLocale().toString(static_cast<int>(std::lround(100.0 * share))) + QChar(0x202F) +
         QLatin1Char('%');
}

/// The sentence of a refusal in the window's language; unknown ones as the record has them.
QString reasonText(const Warning& reason) {
  return QCoreApplication::translate("Refusal", reason.text.c_str());
}

}  // namespace

BuildPanel::BuildPanel(VisitWork& work) : work_(work) {
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  column->addWidget(makeBuild());
  quality_ = makeQuality();
  column->addWidget(quality_);
  column->addStretch();
  again_ = makeButton(tr("Scan again"));
  again_->setObjectName(QStringLiteral("scan again"));
  again_->setProperty("target", QStringLiteral("large"));
  column->addWidget(again_);
  continue_ = makeButton(tr("Continue to outline"), QStringLiteral("primary"));
  continue_->setObjectName(QStringLiteral("continue to outline"));
  column->addWidget(continue_);
  connect(continue_, &QPushButton::clicked, this, &BuildPanel::continued);
  connect(again_, &QPushButton::clicked, this, &BuildPanel::scanWanted);
  connect(&work.build(), &ScanBuild::changed, this, &BuildPanel::show);
  connect(&work, &VisitWork::scanChanged, this, &BuildPanel::show);
  connect(&work, &VisitWork::fieldChanged, this, [this] { show(); });
  clock_.setInterval(500);
  connect(&clock_, &QTimer::timeout, this, &BuildPanel::show);
}

QWidget* BuildPanel::makeBuild() {
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(16, 16, 16, 16);
  column->setSpacing(8);
  picture_ = new QLabel;
  picture_->setAlignment(Qt::AlignCenter);
  picture_->setAccessibleName(tr("The model"));
  Look::setFixedHeight(picture_, 132);
  column->addWidget(picture_);
  column->addSpacing(4);
  auto* top = new QHBoxLayout;
  title_ = makeLabel({}, TypeRole::Heading);
  title_->setObjectName(QStringLiteral("build title"));
  percent_ = makeLine({}, TypeRole::Heading);
  top->addWidget(title_, 1);
  top->addWidget(percent_);
  column->addLayout(top);
  bar_ = new QProgressBar;
  bar_->setTextVisible(false);
  bar_->setRange(0, 1000);
  bar_->setAccessibleName(tr("Building the model"));
  column->addWidget(bar_);
  left_ = makeLabel({}, TypeRole::Small, QStringLiteral("secondary"));
  column->addWidget(left_);
  stage_box_ = new QWidget;
  auto* grid = new QGridLayout(stage_box_);
  grid->setContentsMargins(0, 4, 0, 4);
  grid->setVerticalSpacing(10);
  grid->setHorizontalSpacing(12);
  grid->setColumnStretch(1, 1);
  const QString names[] = {tr("Reading the frames"),
                           tr("Finding the camera path"),
                           tr("Building the surface"),
                           tr("Sharpening the colours"),
                           tr("Checking the quality")};
  for (int i = 0; i < ScanBuild::kStages; ++i) {
    Row& row = stages_.at(static_cast<std::size_t>(i));
    row = {new StageMark,
           makeLabel(names[i], TypeRole::Base),
           makeLine({}, TypeRole::Small, QStringLiteral("secondary"))};
    grid->addWidget(row.mark, i, 0);
    grid->addWidget(row.name, i, 1);
    grid->addWidget(row.value, i, 2, Qt::AlignRight);
  }
  column->addWidget(stage_box_);
  cancel_ = makeButton(tr("Cancel"));
  cancel_->setObjectName(QStringLiteral("cancel build"));
  connect(cancel_, &QPushButton::clicked, this, [this] {
    if (work_.build().state() == ScanBuild::State::Running) {
      ask(true);
    } else {
      work_.build().start(work_.folder());
    }
  });
  column->addWidget(cancel_);
  question_ = new QWidget;
  auto* asked = new QVBoxLayout(question_);
  asked->setContentsMargins(0, 0, 0, 0);
  asked->setSpacing(8);
  asked->addWidget(makeLabel(tr("Stop building? The scan is kept."), TypeRole::Strong));
  auto* answers = new QHBoxLayout;
  stop_ = makeButton(tr("Stop building"), QStringLiteral("danger"));
  stop_->setObjectName(QStringLiteral("stop building"));
  QPushButton* on = makeButton(tr("Go on"));
  on->setObjectName(QStringLiteral("go on building"));
  answers->addWidget(stop_);
  answers->addWidget(on);
  asked->addLayout(answers);
  column->addWidget(question_);
  connect(stop_, &QPushButton::clicked, this, [this] {
    ask(false);
    work_.build().cancel();
  });
  connect(on, &QPushButton::clicked, this, [this] { ask(false); });
  question_->hide();
  return card;
}

QWidget* BuildPanel::makeQuality() {
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(16, 16, 16, 16);
  column->setSpacing(10);
  auto* top = new QHBoxLayout;
  top->addWidget(makeLabel(tr("Scan quality"), TypeRole::Heading), 1);
  verdict_ = new Chip;
  verdict_->setObjectName(QStringLiteral("verdict"));
  top->addWidget(verdict_);
  column->addLayout(top);
  auto* grid = new QGridLayout;
  grid->setVerticalSpacing(10);
  grid->setHorizontalSpacing(10);
  grid->setColumnStretch(1, 1);
  const QString names[] = {tr("Frames used"),
                           tr("Average misfit"),
                           tr("Wound bed not seen"),
                           tr("Surface without a sharp picture")};
  for (int i = 0; i < 4; ++i) {
    Row& row = facts_.at(static_cast<std::size_t>(i));
    row = {new StageMark, makeLabel(names[i], TypeRole::Base), makeLine({}, TypeRole::Strong)};
    grid->addWidget(row.mark, i, 0);
    grid->addWidget(row.name, i, 1);
    grid->addWidget(row.value, i, 2, Qt::AlignRight);
  }
  column->addLayout(grid);
  sentence_ = makeLabel({}, TypeRole::Base);
  sentence_->setObjectName(QStringLiteral("quality sentence"));
  column->addWidget(sentence_);
  return card;
}

void BuildPanel::ask(bool asking) {
  asking_ = asking;
  show();
  if (asking) {
    question_->findChild<QPushButton*>(QStringLiteral("go on building"))->setFocus();
  }
}

void BuildPanel::reset() {
  asking_ = false;
  pictured_ = nullptr;
  picture_->setPixmap({});
  show();
}

void BuildPanel::enter() { show(); }

void BuildPanel::pressContinue() {
  if (continue_->isEnabled() && continue_->isVisible()) {
    continue_->click();
  }
}

void BuildPanel::show() {
  const ScanBuild& build = work_.build();
  using State = ScanBuild::State;
  const State state = build.state();
  const bool running = state == State::Running;
  if (!running) {
    asking_ = false;
  }
  running ? clock_.start() : clock_.stop();
  const bool by_hand = work_.noScan();
  switch (state) {
    case State::None:
      title_->setText(by_hand ? tr("No scan today") : tr("No scan yet"));
      left_->setText(by_hand ? tr("Please measure with ruler or probe.")
                             : tr("Take a scan, or open one from a file."));
      break;
    case State::Running:
      title_->setText(tr("Building the model"));
      break;
    case State::Ready:
      title_->setText(tr("The model is ready"));
      left_->setText(tr("The form may stay open until signing."));
      break;
    case State::Failed:
      title_->setText(tr("The model could not be built"));
      left_->setText(sentenceOf(build.problem()));
      break;
    case State::Cancelled:
      title_->setText(tr("Building was stopped"));
      left_->setText(tr("The scan is kept."));
      break;
  }
  if (running) {
    const auto left = build.secondsLeft();
    constexpr int kStep = 5;
    const int rounded =
        left ? kStep * std::max(1, static_cast<int>(std::lround(*left / kStep))) : 0;
    left_->setText(left ? tr("About %1 seconds left. Keep filling the form.").arg(rounded)
                        : tr("Keep filling the form."));
  }
  const bool stages = running || state == State::Ready;
  stage_box_->setVisible(running);
  bar_->setVisible(running);
  percent_->setVisible(running);
  percent_->setText(percentText(build.fraction()));
  bar_->setValue(static_cast<int>(std::lround(1000.0 * build.fraction())));
  const bool stopped = state == State::Failed || state == State::Cancelled;
  cancel_->setVisible((running && !asking_) || (stopped && work_.hasScan()));
  cancel_->setText(running ? tr("Cancel") : tr("Build again"));
  question_->setVisible(running && asking_);
  if (stages) {
    showStages();
  }
  showQuality();
  showPicture();
  again_->setVisible(!running && work_.mayEdit() &&
                     (stopped || (state == State::Ready && !work_.modelIsFit())));
  continue_->setText(by_hand ? tr("Continue to review") : tr("Continue to outline"));
  continue_->setEnabled(by_hand || work_.modelIsFit());
}

void BuildPanel::showStages() {
  const auto stages = work_.build().stages();
  for (std::size_t i = 0; i < stages.size(); ++i) {
    const ScanBuild::Stage& stage = stages.at(i);
    const Row& row = stages_.at(i);
    row.mark->setKind(stage.done      ? StageMark::Kind::Done
                      : stage.running ? StageMark::Kind::Running
                                      : StageMark::Kind::ToCome);
    Look::setType(row.name, stage.running ? TypeRole::Strong : TypeRole::Base);
    setStyleProperty(
        row.name, "tone", stage.done || stage.running ? QString() : QStringLiteral("secondary"));
    row.value->setText(stage.done || stage.running ? minutes(stage.seconds) : QString());
  }
}

void BuildPanel::showQuality() {
  const ScanBuild& build = work_.build();
  const bool known = build.state() == ScanBuild::State::Ready;
  quality_->setVisible(known || build.state() == ScanBuild::State::Running);
  const ScanQuality& q = build.built().quality;
  const QLocale locale;
  const auto fact = [this, known](std::size_t i, bool good, const QString& text) {
    const Row& row = facts_.at(i);
    row.mark->setKind(!known ? StageMark::Kind::Waiting
                      : good ? StageMark::Kind::Checked
                             : StageMark::Kind::Care);
    row.value->setText(known ? text : tr("checking"));
  };
  const bool frames = q.frames_used >= kFramesOfCare * q.frames_total;
  const bool misfit = q.misfit_mm.value_or(0.0) <= kMisfitOfCare_mm;
  const bool seen = q.unseen_share <= kUnseenOfCare;
  fact(0, frames, tr("%1 of %2", "frames").arg(q.frames_used).arg(q.frames_total));
  fact(1,
       misfit,
       q.misfit_mm ? locale.toString(*q.misfit_mm, 'f', 2) + QChar(0x00A0) + QStringLiteral("mm")
                   : tr("not computable"));
  fact(2, true, tr("after outlining"));
  if (known) {
    facts_.at(2).mark->setKind(StageMark::Kind::Waiting);
  }
  fact(3, seen, percentText(q.unseen_share));
  const bool good = frames && misfit && seen;
  verdict_->setChip(
      !known     ? ChipLook{tr("Still checking"), ChipTone::Plain, {}}
      : !q.fit() ? ChipLook{tr("Not usable"), ChipTone::Danger, QStringLiteral("close")}
      : good     ? ChipLook{tr("Good"), ChipTone::Good, QStringLiteral("check")}
                 : ChipLook{tr("Usable, with care"), ChipTone::Warning, QStringLiteral("warning")});
  QStringList sentences;
  if (known && !q.fit()) {
    sentences << tr("This scan cannot be used.");
    for (const Warning& reason : q.reasons) {
      sentences << reasonText(reason);
    }
  }
  sentence_->setText(sentences.join(QLatin1Char('\n')));
  setStyleProperty(sentence_, "tone", QStringLiteral("danger"));
  sentence_->setVisible(!sentences.isEmpty());
}

void BuildPanel::showPicture() {
  const auto& model = work_.model();
  picture_->setVisible(model != nullptr);
  if (!model || pictured_ == model.get()) {
    pictured_ = model ? pictured_ : nullptr;
    return;
  }
  pictured_ = model.get();
  const QSize size(std::max(200, picture_->width()), Look::px(132));
  auto* job = new BackgroundJob(picture_);
  job->start<QImage>(
      [model, size](const Job&) -> Expected<QImage> {
        const PictureOptions options{.width_px = size.width(), .height_px = size.height()};
        const ViewFrame view = viewOfWhole(
            model->mesh, -Eigen::Vector3d::UnitZ(), Eigen::Vector3d(0.0, -1.0, 0.0), options);
        return imageOf(takePicture(model->mesh, model->colors, view, options));
      },
      [this, job](const Expected<QImage>& image) {
        if (image) {
          picture_->setPixmap(QPixmap::fromImage(*image));
        }
        job->deleteLater();
      });
}

}  // namespace tarsus
