#include "ui/scene/view_overlay.h"

#include <QButtonGroup>
#include <QHBoxLayout>
#include <QPainter>
#include <QToolButton>

#include <cmath>

namespace tarsus {
namespace {

constexpr double kShortest_px = 60.0;  ///< the bar is 60 to 150 px long

/// The next of 1, 2, 5, 10, ... mm that is long enough to read.
double roundLength(double least_mm) {
  const double decade = std::pow(10.0, std::floor(std::log10(least_mm)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= least_mm) {
      return step * decade;
    }
  }
  return 10.0 * decade;
}

QToolButton* makeChoice(const QString& text, const QString& tip) {
  auto* button = new QToolButton;
  button->setText(text);
  button->setToolTip(tip);
  button->setCheckable(true);
  Look::setType(button, TypeRole::Label);
  return button;
}

}  // namespace

ScaleBar::ScaleBar(QWidget* parent) : QWidget(parent) {
  setFixedSize(184, 44);
  setAttribute(Qt::WA_TransparentForMouseEvents);
}

void ScaleBar::setMmPerPixel(double mm_per_px) {
  if (mm_per_px > 0.0 && mm_per_px != mm_per_px_) {
    mm_per_px_ = mm_per_px;
    length_mm_ = roundLength(kShortest_px * mm_per_px);
    setAccessibleName(tr("Scale bar, %1 mm").arg(length_mm_));
    update();
  }
}

void ScaleBar::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  const double length = lengthPx();
  const QRectF plate(width() - length - 24.0, 0.0, length + 24.0, height());
  painter.setPen(Qt::NoPen);
  painter.setBrush(Look::theme().surface);
  painter.drawRoundedRect(plate, 6.0, 6.0);
  painter.setPen(Look::theme().text);
  painter.setFont(Look::font(TypeRole::Small));
  const QString label = length_mm_ < 10.0 ? QStringLiteral(u"%1\u00A0mm").arg(length_mm_)
                                          : QStringLiteral(u"%1\u00A0cm").arg(length_mm_ / 10.0);
  painter.drawText(plate.adjusted(0, 5, 0, -20), Qt::AlignCenter, label);
  const QRectF bar(plate.left() + 12.0, height() - 15.0, length, 6.0);
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.fillRect(bar, Look::theme().text);
  painter.fillRect(QRectF(bar.center().x(), bar.top() + 1.0, 0.5 * length - 1.0, 4.0),
                   Look::theme().surface);
}

ViewTools::ViewTools(QWidget* parent) : QWidget(parent) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  texture_ = makeChoice(tr("Texture"), tr("Colours of the scan (T)"));
  relief_ = makeChoice(tr("Relief"), tr("Shape alone, in grey (T)"));
  auto* group = new QButtonGroup(this);
  group->addButton(texture_);
  group->addButton(relief_);
  texture_->setChecked(true);
  layout->addWidget(texture_);
  layout->addWidget(relief_);
  connect(texture_, &QToolButton::clicked, this, [this] { emit texturedChosen(true); });
  connect(relief_, &QToolButton::clicked, this, [this] { emit texturedChosen(false); });
}

ViewButtons::ViewButtons(QWidget* parent) : QWidget(parent) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(8);
  const std::pair<QString, StandardView> views[] = {{tr("1  Front"), StandardView::Front},
                                                    {tr("2  Back"), StandardView::Back},
                                                    {tr("3  Left"), StandardView::Left},
                                                    {tr("4  Right"), StandardView::Right}};
  for (const auto& [name, view] : views) {
    QToolButton* button = makeChoice(name, tr("Look from this side"));
    button->setCheckable(false);
    layout->addWidget(button);
    connect(
        button, &QToolButton::clicked, this, [this, chosen = view] { emit viewChosen(chosen); });
  }
  QToolButton* fit = makeChoice(tr("F  Fit"), tr("Show the whole model"));
  fit->setCheckable(false);
  layout->addWidget(fit);
  connect(fit, &QToolButton::clicked, this, &ViewButtons::fitChosen);
}

void ViewTools::setTextured(bool textured, bool has_color) {
  texture_->setEnabled(has_color);
  texture_->setToolTip(has_color ? tr("Colours of the scan (T)") : tr("This model has no colour"));
  (textured && has_color ? texture_ : relief_)->setChecked(true);
}

}  // namespace tarsus
