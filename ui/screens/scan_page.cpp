#include "ui/screens/scan_page.h"

#include "ui/look/icons.h"
#include "ui/parts/controls.h"
#include "ui/parts/scan_dialog.h"
#include "ui/parts/scan_views.h"
#include "ui/parts/words.h"
#include "ui/screens/visit_screen.h"
#include "ui/work/session.h"
#include "ui/work/visit_work.h"

#include <QApplication>
#include <QDir>
#include <QFileDialog>
#include <QFrame>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLocale>
#include <QVBoxLayout>
#include <QVariant>

#include <cmath>

namespace tarsus {
namespace {

namespace fs = std::filesystem;
constexpr double kAskBeforeDropping_s = 3.0;

struct OrderWords {
  QString icon;
  QString words;
};

OrderWords wordsOf(ScanOrder order) {
  switch (order) {
    case ScanOrder::GoBack:
      return {QStringLiteral("undo"), ScanPage::tr("Go back to where you were")};
    case ScanOrder::MoveBack:
      return {QStringLiteral("arrow-down"), ScanPage::tr("Move back")};
    case ScanOrder::ComeCloser:
      return {QStringLiteral("arrow-up"), ScanPage::tr("Come closer")};
    case ScanOrder::Slower:
      return {QStringLiteral("clock"), ScanPage::tr("Slower")};
    case ScanOrder::MoreLight:
      return {QStringLiteral("light"), ScanPage::tr("More light")};
    case ScanOrder::LessLight:
      return {QStringLiteral("light"), ScanPage::tr("Less light")};
    case ScanOrder::Done:
      return {QStringLiteral("check"), ScanPage::tr("Done, you can stop")};
    case ScanOrder::KeepMoving:
      break;
  }
  return {QStringLiteral("turn"), ScanPage::tr("Move on around the foot")};
}

QString reasonOf(LossReason why) {
  switch (why) {
    case LossReason::TooClose:
      return ScanPage::tr("Tracking lost: too close");
    case LossReason::TooFar:
      return ScanPage::tr("Tracking lost: too far");
    case LossReason::TooFast:
      return ScanPage::tr("Tracking lost: too fast");
    case LossReason::OutOfSight:
      break;
  }
  return ScanPage::tr("Tracking lost: out of sight");
}

QString remedyOf(LossReason why) {
  switch (why) {
    case LossReason::TooClose:
      return ScanPage::tr("Move back to 30 cm, then point at the part in the dashed frame.");
    case LossReason::TooFar:
      return ScanPage::tr("Come closer to 50 cm, then point at the part in the dashed frame.");
    case LossReason::TooFast:
      return ScanPage::tr("Go back slowly and point at the part in the dashed frame.");
    case LossReason::OutOfSight:
      break;
  }
  return ScanPage::tr("Point at the part in the dashed frame and hold still.");
}

QWidget* figure(const QString& title, QLabel*& value, QLabel*& below) {
  auto* box = new QWidget;
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  column->addWidget(makeLine(title, TypeRole::Small, QStringLiteral("secondary")));
  value = makeLine({}, TypeRole::ScanFigure);
  value->setTextFormat(Qt::RichText);
  column->addWidget(value);
  below = makeLine({}, TypeRole::Small, QStringLiteral("secondary"));
  column->addWidget(below);
  return box;
}

QString withUnit(int number, const QString& unit) {
  return QStringLiteral("<b>%1</b> <span style=\"font-size:%3px\"><b>%2</b></span>")
      .arg(QLocale().toString(number), unit)
      .arg(Look::px(16));
}

}  // namespace

ScanPage::ScanPage(VisitWork& work) : VisitPage(work) {
  setFocusPolicy(Qt::StrongFocus);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(24, 24, 24, 24);
  row->setSpacing(24);
  left_ = makeLeft();
  row->addWidget(left_);
  foot_ = new GrowingView;
  row->addWidget(foot_, 1);
  right_ = makeRight();
  row->addWidget(right_);
  dialog_ = new ScanDialog(foot_);
  dialog_->setObjectName(QStringLiteral("scan dialog"));
  connect(&work, &VisitWork::scanChanged, this, &ScanPage::showState);
  showState();
}

ScanPage::~ScanPage() = default;

QWidget* ScanPage::makeLeft() {
  auto* box = new QWidget;
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  color_ = new LivePicture(LivePicture::Kind::Color);
  depth_ = new LivePicture(LivePicture::Kind::Depth);
  depth_->setRange(ScanCamera::kNear_mm / 10.0, ScanCamera::kFar_mm / 10.0);
  column->addWidget(color_, 4);
  column->addWidget(depth_, 4);
  QFrame* tips = makeFrame(QStringLiteral("card"));
  auto* lines = new QVBoxLayout(tips);
  lines->setContentsMargins(16, 12, 16, 16);
  lines->setSpacing(2);
  lines->addWidget(makeLabel(tr("For a good scan"), TypeRole::Label));
  for (const QString& tip : {tr("Foot still, wound and heel free."),
                             tr("No direct sun on the foot."),
                             tr("Move slowly, one arc from toes to heel.")}) {
    lines->addWidget(makeLabel(tip, TypeRole::Base, QStringLiteral("secondary")));
  }
  lines->addStretch();
  column->addWidget(tips, 2);
  return box;
}

QWidget* ScanPage::makeDistance() {
  QFrame* card = makeFrame(QStringLiteral("card"));
  auto* column = new QVBoxLayout(card);
  column->setContentsMargins(16, 16, 16, 16);
  column->setSpacing(8);
  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  auto* gauge = new QVBoxLayout;
  gauge->setSpacing(4);
  gauge->addWidget(makeLine(tr("Distance"), TypeRole::Strong));
  gauge_ = new DistanceGauge;
  gauge->addWidget(gauge_, 1);
  row->addLayout(gauge, 1);
  auto* figures = new QVBoxLayout;
  figures->setSpacing(16);
  QLabel* nothing = nullptr;
  figures->addWidget(figure(tr("Time left"), left_s_, paused_));
  figures->addWidget(figure(tr("Foot seen"), seen_, nothing));
  figures->addStretch();
  row->addLayout(figures);
  column->addLayout(row, 1);
  distance_text_ = makeLabel({}, TypeRole::Small, QStringLiteral("secondary"));
  column->addWidget(distance_text_);
  return card;
}

QWidget* ScanPage::makeRight() {
  auto* box = new QWidget;
  auto* column = new QVBoxLayout(box);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(16);
  state_ = new QFrame;
  auto* card = new QVBoxLayout(state_);
  card->setContentsMargins(16, 14, 16, 14);
  card->setSpacing(2);
  auto* top = new QHBoxLayout;
  top->setSpacing(12);
  state_icon_ = new QLabel;
  top->addWidget(state_icon_);
  state_title_ = makeLabel({}, TypeRole::Title);
  state_title_->setObjectName(QStringLiteral("scan state"));
  Look::setType(state_title_, TypeRole::Heading);
  top->addWidget(state_title_, 1);
  card->addLayout(top);
  state_text_ = makeLabel({}, TypeRole::Base);
  card->addWidget(state_text_);
  column->addWidget(state_);
  distance_ = makeDistance();
  column->addWidget(distance_, 1);
  column->addStretch();
  auto* row = new QHBoxLayout;
  row->setSpacing(8);
  retake_ = makeButton(tr("Retake"), {}, "undo");
  retake_->setObjectName(QStringLiteral("retake"));
  retake_->setToolTip(tr("Retake (R)"));
  file_ = makeButton(tr("From file"), {}, "folder");
  file_->setObjectName(QStringLiteral("from file"));
  file_->setToolTip(tr("A scan folder or an .oni recording (O), or drop one here"));
  for (QPushButton* button : {retake_, file_}) {
    button->setProperty("target", QStringLiteral("large"));
    row->addWidget(button, 1);
  }
  column->addLayout(row);
  none_ = makeButton(tr("No scan today"), QStringLiteral("quiet"));
  none_->setObjectName(QStringLiteral("no scan"));
  none_->setToolTip(tr("Measure with ruler and probe instead"));
  column->addWidget(none_, 0, Qt::AlignHCenter);
  go_ = makeButton({}, QStringLiteral("stop"), "start");
  go_->setObjectName(QStringLiteral("start or stop"));
  Look::setType(go_, TypeRole::Title);
  column->addWidget(go_);
  connect(retake_, &QPushButton::clicked, this, &ScanPage::retake);
  connect(file_, &QPushButton::clicked, this, &ScanPage::chooseFile);
  connect(none_, &QPushButton::clicked, this, &ScanPage::takeNoScan);
  connect(go_, &QPushButton::clicked, this, &ScanPage::startOrStop);
  for (QPushButton* button : {retake_, file_, none_, go_}) {
    button->setFocusPolicy(Qt::TabFocus);
  }
  return box;
}

void ScanPage::useCamera(const std::string& uri) {
  uri_ = uri;
  if (camera_) {
    camera_->setUri(uri);
  }
}

void ScanPage::openCamera() {
  if (!camera_) {
    camera_ = std::make_unique<ScanCamera>(work().session().folder() / "work");
    connect(camera_.get(), &ScanCamera::shown, this, &ScanPage::show);
    connect(camera_.get(), &ScanCamera::begun, this, [this] {
      waiting_ = false;
      recording_ = true;
      foot_->setFoot({});
      showState();
    });
    connect(camera_.get(), &ScanCamera::ended, this, &ScanPage::ended);
    if (!uri_.empty()) {
      camera_->setUri(uri_);
    }
  }
  camera_->start();
}

void ScanPage::reset() {
  now_ = {};
  recording_ = false;
  waiting_ = false;
  dialog_->close();
  foot_->setFoot({});
  color_->setPicture({});
  depth_->setPicture({});
  showState();
}

void ScanPage::enter() {
  setFocus();
  if (work().mayEdit()) {
    openCamera();
    offerKept();
  }
  showState();
}

void ScanPage::leave() {
  if (recording_) {
    at_end_ = AtEnd::Use;  // what was recorded is kept
    camera_->end();
  }
  if (camera_) {
    camera_->stop();
  }
}

fs::path ScanPage::take() const { return work().folder() / "take"; }

/// A scan that was being recorded when the program ended.
void ScanPage::offerKept() {
  std::error_code ignored;
  if (recording_ || waiting_ || !fs::exists(take() / "depth.txt", ignored)) {
    return;
  }
  dialog_->open({.id = QStringLiteral("kept"),
                 .icon = QStringLiteral("save"),
                 .title = tr("Work was recovered"),
                 .text = tr("A scan was not finished. What was recorded is kept."),
                 .steps = {},
                 .waiting = {},
                 .technician = {},
                 .first = {tr("Use this scan"),
                           [this] {
                             work().takeRecording(take());
                             emit stepWanted(VisitScreen::Form);
                           },
                           "use kept"},
                 .second = {tr("Scan again"),
                            [this] {
                              removeSoon(take());
                              setFocus();
                            },
                            "scan anew"}});
}

bool ScanPage::lost() const { return recording_ && now_.guidance.why_lost.has_value(); }

void ScanPage::show(const ScanMoment& moment) {
  const bool note_changed = moment.camera != now_.camera || moment.name != now_.name;
  const int frames = now_.frames;
  const QImage foot = moment.foot;
  now_ = moment;
  color_->setPicture(moment.color);
  depth_->setPicture(moment.depth);
  if (!foot.isNull()) {
    foot_->setFoot(foot);
  }
  showState();
  if (note_changed || frames != now_.frames) {
    emit statusChanged();
  }
}

void ScanPage::showState() {
  using Camera = ScanMoment::Camera;
  QString look = QStringLiteral("plain");
  QString icon = QStringLiteral("camera");
  Tone tone = Tone::Text;
  QString title;
  QString text;
  const bool may_edit = work().mayEdit();
  switch (now_.camera) {
    case Camera::Looking:
      title = tr("Looking for the camera");
      break;
    case Camera::None:
      title = tr("No camera");
      text = tr("Plug the camera in, or open a scan from a file.");
      icon = QStringLiteral("unplugged");
      break;
    case Camera::Preparing:
      title = tr("Making the simulated foot");
      text = tr("%1 % done").arg(static_cast<int>(100.0 * now_.prepared));
      break;
    case Camera::Failed:
      title = tr("The camera does not answer");
      text = sentenceOf(now_.problem);
      look = QStringLiteral("lost");
      icon = QStringLiteral("warning");
      tone = Tone::Danger;
      break;
    case Camera::Gone:
      title = tr("Camera gone");
      look = QStringLiteral("lost");
      icon = QStringLiteral("unplugged");
      tone = Tone::Danger;
      break;
    case Camera::Live:
      title = work().hasScan() ? tr("This visit has a scan") : tr("Ready");
      text = work().hasScan() ? tr("A new one takes its place.")
                              : tr("Point at the foot and start the scan.");
      break;
  }
  if (now_.camera == Camera::Live && recording_) {
    const ScanOrder order = now_.guidance.order;
    const bool weak = order == ScanOrder::Slower || order == ScanOrder::MoreLight ||
                      order == ScanOrder::LessLight || order == ScanOrder::MoveBack ||
                      order == ScanOrder::ComeCloser;
    look = lost() ? QStringLiteral("lost") : weak ? QStringLiteral("weak") : QStringLiteral("good");
    icon = lost() ? QStringLiteral("close")
           : weak ? QStringLiteral("warning")
                  : QStringLiteral("check");
    tone = lost() ? Tone::Danger : weak ? Tone::Warning : Tone::Accent;
    title = lost()                          ? tr("Not recording")
            : !weak                         ? tr("Tracking well")
            : order == ScanOrder::Slower    ? tr("Tracking is weak: slower")
            : order == ScanOrder::MoreLight ? tr("Tracking is weak: more light")
                                            : tr("Tracking is weak");
    text = lost()  ? tr("Nothing is added until the foot is found again.")
           : !weak ? tr("Good speed. Good light.")
                   : wordsOf(order).words;
  }
  setStyleProperty(state_, "state", look);
  state_icon_->setPixmap(themeIcon(icon, tone).pixmap(Look::px(22)));
  state_title_->setText(title);
  setStyleProperty(state_title_,
                   "tone",
                   tone == Tone::Danger   ? QStringLiteral("danger")
                   : tone == Tone::Accent ? QStringLiteral("accent")
                                          : QString());
  state_text_->setText(text);
  state_text_->setVisible(!text.isEmpty());
  const bool live = now_.camera == Camera::Live;
  go_->setText(recording_ ? tr("Stop the scan") : tr("Start the scan"));
  go_->setIcon(
      themeIcon(recording_ ? QStringLiteral("stop") : QStringLiteral("start"), Tone::OnAccent));
  go_->setToolTip(tr("%1 (Space)").arg(go_->text()));
  go_->setEnabled(may_edit && !waiting_ && (recording_ || live));
  retake_->setEnabled(may_edit && recording_ && !waiting_);
  file_->setEnabled(may_edit && !recording_);
  none_->setVisible(may_edit && !recording_);
  const bool blind = !live;
  color_->setEmpty(blind && now_.camera != Camera::Looking ? QStringLiteral("unplugged")
                                                           : QStringLiteral("camera"),
                   tr("No picture"));
  depth_->setEmpty(blind && now_.camera != Camera::Looking ? QStringLiteral("unplugged")
                                                           : QStringLiteral("layers"),
                   tr("No depth"));
  showFigures();
  showOrder();
  showDialogs();
}

void ScanPage::showFigures() {
  const bool live = now_.camera == ScanMoment::Camera::Live;
  const ScanGuidance& guidance = now_.guidance;
  gauge_->setDistance(live ? guidance.distance_mm : std::nullopt);
  const double left = recording_ ? guidance.left_s : GuideOptions{}.scan_s;
  left_s_->setText(withUnit(static_cast<int>(std::lround(left)), tr("s")));
  paused_->setText(recording_ && (lost() || !live) ? tr("paused") : QString());
  seen_->setText(
      withUnit(recording_ ? static_cast<int>(std::lround(guidance.coverage_percent)) : 0, tr("%")));
  seen_->setAccessibleName(
      tr("%1 percent of the foot seen").arg(std::lround(guidance.coverage_percent)));
  const auto mm = guidance.distance_mm;
  const GuideOptions band;
  distance_text_->setText(!live                ? tr("No distance without the camera.")
                          : !mm                ? tr("Nothing is in the middle of the picture.")
                          : *mm < band.near_mm ? tr("Too close. Move back to 30 cm.")
                          : *mm > band.far_mm  ? tr("Too far. Come closer to 50 cm.")
                                               : tr("Keep the mark in the band, 30 to 50 cm."));
}

void ScanPage::showOrder() {
  const bool live = now_.camera == ScanMoment::Camera::Live;
  foot_->setEmpty(recording_ ? tr("The foot appears here")
                  : live     ? tr("Ready. Start the scan")
                             : tr("No scan yet"),
                  recording_ ? tr("Move slowly along the foot.")
                  : live     ? tr("The growing foot will appear here.")
                             : tr("With a camera, the growing foot appears here."));
  if (!live) {
    foot_->setOrder({}, {});
    foot_->setTrouble({}, {});
    return;
  }
  const ScanGuidance& guidance = now_.guidance;
  const bool over = recording_ && guidance.left_s <= 0.0;
  const OrderWords words = wordsOf(over && !lost() ? ScanOrder::Done : guidance.order);
  const bool before_start_moving =
      !recording_ && (guidance.order == ScanOrder::KeepMoving ||
                      guidance.order == ScanOrder::Done || guidance.order == ScanOrder::GoBack);
  before_start_moving ? foot_->setOrder({}, {}) : foot_->setOrder(words.icon, words.words);
  if (lost()) {
    foot_->setTrouble(reasonOf(*guidance.why_lost), remedyOf(*guidance.why_lost));
    foot_->setAim(now_.aim);
  } else {
    foot_->setTrouble({}, {});
  }
  if (lost() && !was_lost_) {
    QApplication::beep();
  }
  was_lost_ = lost();
}

QString ScanPage::keptSeconds() const {
  return QLocale().toString(static_cast<int>(std::lround(now_.guidance.passed_s)));
}

void ScanPage::showDialogs() {
  using Camera = ScanMoment::Camera;
  if (now_.camera == Camera::Gone) {
    const QString kept = keptSeconds();
    ScanDialog::Words words{
        .id = QStringLiteral("gone"),
        .icon = QStringLiteral("unplugged"),
        .title = tr("The camera was unplugged"),
        .text = recording_
                    ? tr("Nothing is lost: the first %1 seconds are kept. Plug the camera in "
                         "again and the scan goes on by itself.")
                          .arg(kept)
                    : tr("Plug the camera in again."),
        .steps = {tr("Check the cable at the camera"),
                  tr("Use a blue (USB 3) socket on this computer")},
        .waiting = tr("Looking for the camera"),
        .technician = tr("%1: the device left the bus; %2 frames are written.")
                          .arg(now_.name)
                          .arg(now_.frames),
        .first = {},
        .second = {}};
    if (recording_) {
      words.first = {tr("Use the %1 seconds").arg(kept), [this] { end(AtEnd::Use); }, "use kept"};
      words.second = {tr("Scan again later"), [this] { end(AtEnd::Drop); }, "scan later"};
    } else {
      words.first = {tr("From file"), [this] { chooseFile(); }, "file instead"};
    }
    if (!gone_told_) {
      gone_told_ = true;
      dialog_->open(std::move(words));
    }
    return;
  }
  gone_told_ = false;
  dialog_->close(QStringLiteral("gone"));
  if (now_.camera == Camera::None && work().mayEdit() && !work().hasScan()) {
    dialog_->open(
        {.id = QStringLiteral("none"),
         .icon = QStringLiteral("unplugged"),
         .title = tr("No camera is plugged in"),
         .text = tr("Plug it in and it appears by itself. A scan from a file, or the "
                    "simulated camera, can stand for it."),
         .steps = {},
         .waiting = tr("Looking for the camera"),
         .technician = {},
         .first = {tr("From file"), [this] { chooseFile(); }, "file instead"},
         .second = {tr("Use the simulated camera"), [this] { camera_->simulate(); }, "simulate"}});
  } else {
    dialog_->close(QStringLiteral("none"));
  }
  if (recording_ && now_.stopped) {
    end(AtEnd::Use);
  }
}

void ScanPage::startOrStop() {
  if (waiting_ || !go_->isEnabled()) {
    return;
  }
  recording_ ? end(AtEnd::Use) : begin();
}

void ScanPage::begin() {
  take_ = take();
  waiting_ = true;
  camera_->begin(take_);
  showState();
}

void ScanPage::end(AtEnd then) {
  if (recording_ && !waiting_) {
    at_end_ = then;
    waiting_ = true;
    camera_->end();
    showState();
  }
}

void ScanPage::ended(int frames, const Error& problem) {
  waiting_ = false;
  const bool was_recording = recording_;
  recording_ = false;
  const bool failed = problem.code != ErrorCode::Cancelled;
  if (failed || frames == 0) {
    const Error why = failed ? problem : Error{ErrorCode::ScanEmpty, {}};
    dialog_->open({.id = QStringLiteral("failed"),
                   .icon = QStringLiteral("warning"),
                   .title = frames == 0 ? tr("Nothing was recorded") : tr("The recording ended"),
                   .text = sentenceOf(why),
                   .steps = {},
                   .waiting = {},
                   .technician = QString::fromStdString(why.detail),
                   .first = {tr("Scan again"), [this] { setFocus(); }, "scan anew"},
                   .second = {}});
  }
  if (was_recording && frames > 0 && at_end_ == AtEnd::Use) {
    if (!failed) {
      dialog_->close();
    }
    // Where another visit is open by now, the recording waits in its own visit's folder.
    if (work().isOpen() && take() == take_) {
      const bool in_front = isVisible();
      work().takeRecording(take_);
      if (in_front) {
        emit stepWanted(VisitScreen::Form);
      }
    }
  } else if (was_recording && at_end_ == AtEnd::Again) {
    foot_->setFoot({});
    begin();
  } else if (at_end_ == AtEnd::Drop) {
    removeSoon(take_);
    foot_->setFoot({});
  }
  at_end_ = AtEnd::Use;
  emit statusChanged();
  showState();
}

void ScanPage::retake() { end(AtEnd::Again); }

void ScanPage::cancel() {
  if (!recording_) {
    return;
  }
  if (now_.guidance.passed_s <= kAskBeforeDropping_s) {
    end(AtEnd::Drop);
    return;
  }
  dialog_->open({.id = QStringLiteral("cancel"),
                 .icon = QStringLiteral("warning"),
                 .title = tr("Stop and leave out this scan?"),
                 .text = tr("%1 seconds were recorded.").arg(keptSeconds()),
                 .steps = {},
                 .waiting = {},
                 .technician = {},
                 .first = {tr("Leave it out"), [this] { end(AtEnd::Drop); }, "leave out"},
                 .second = {tr("Go on scanning"), [this] { setFocus(); }, "go on"},
                 .second_is_safe = true});
}

void ScanPage::chooseFile() {
  QFileDialog chooser(this, tr("Open a scan: its folder, or an .oni recording"));
  chooser.setFileMode(QFileDialog::AnyFile);
  chooser.setNameFilters({tr("Recordings (*.oni)"), tr("Scan folders (camera.json)")});
  if (chooser.exec() != QDialog::Accepted || chooser.selectedFiles().isEmpty()) {
    return;
  }
  QFileInfo chosen(chooser.selectedFiles().constFirst());
  if (chosen.fileName() == QLatin1String("camera.json")) {
    chosen = QFileInfo(chosen.path());
  }
  work().useFile(chosen.absoluteFilePath().toStdString());
  emit stepWanted(VisitScreen::Form);
}

void ScanPage::takeNoScan() {
  work().setNoScan(true);
  emit stepWanted(VisitScreen::Form);
}

void ScanPage::primary() { startOrStop(); }

void ScanPage::keyPressEvent(QKeyEvent* event) {
  switch (event->key()) {
    case Qt::Key_Space:
      startOrStop();
      return;
    case Qt::Key_R:
      if (retake_->isEnabled()) {
        retake();
      }
      return;
    case Qt::Key_O:
      if (file_->isEnabled() && event->modifiers() == Qt::NoModifier) {
        chooseFile();
      }
      return;
    case Qt::Key_Escape:
      cancel();
      return;
    default:
      VisitPage::keyPressEvent(event);
  }
}

void ScanPage::resizeEvent(QResizeEvent* event) {
  VisitPage::resizeEvent(event);
  const bool narrow = width() < Look::px(1360);
  const bool tight = width() < Look::px(1000);  // large text: the orders tell the distance too
  left_->setVisible(!tight);
  distance_->setVisible(!tight);
  left_->setFixedWidth(Look::px(narrow ? 320 : 384));
  right_->setFixedWidth(Look::px(narrow ? 280 : 312));
}

QString ScanPage::status() const { return tr("Space starts and stops, Esc cancels"); }

QString ScanPage::saved() const {
  if (!recording_) {
    return {};
  }
  const bool live = now_.camera == ScanMoment::Camera::Live;
  return !live    ? tr("Recording stopped, %1 frames kept").arg(now_.frames)
         : lost() ? tr("Recording paused, %1 frames kept").arg(now_.frames)
                  : tr("Recording, %1 frames kept").arg(now_.frames);
}

QString ScanPage::headerNote(bool* trouble) const {
  using Camera = ScanMoment::Camera;
  *trouble =
      now_.camera == Camera::Gone || now_.camera == Camera::None || now_.camera == Camera::Failed;
  if (*trouble) {
    return tr("No camera");
  }
  if (now_.camera != Camera::Live) {
    return {};
  }
  return now_.simulated ? tr("Simulated camera") : tr("Camera %1").arg(now_.name);
}

}  // namespace tarsus
