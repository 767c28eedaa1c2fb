#include "ui/parts/foot_shape.h"

#include "ui/look/look.h"

#include <QPainter>

#include <array>

namespace tarsus {
namespace {

constexpr double kWidth = 163.0;
constexpr double kHeight = 435.0;

// The right sole, drawn by hand: from between great and second toe clockwise.
constexpr std::array<std::array<double, 2>, 44> kOutline{
    {{114, 20},  {120, 6},   {134, 0},   {150, 4},   {158, 22},  {156, 55},  {157, 84},  {163, 115},
     {157, 142}, {151, 175}, {150, 215}, {146, 262}, {144, 292}, {148, 320}, {141, 352}, {140, 374},
     {128, 408}, {106, 428}, {84, 435},  {58, 430},  {34, 412},  {19, 380},  {16, 340},  {14, 290},
     {9, 220},   {5, 180},   {0, 143},   {5, 112},   {1, 84},    {4, 67},    {14, 63},   {25, 71},
     {29, 80},   {29, 58},   {36, 40},   {48, 39},   {55, 46},   {57, 30},   {68, 17},   {80, 24},
     {84, 33},   {87, 16},   {98, 3},    {110, 9}}};

struct Place {
  const char* name;
  double x;
  double y;
};

// Middles on the right sole.
constexpr std::array kPlaces{Place{"toe_1", 0.84, 0.075},
                             Place{"toe_2", 0.60, 0.055},
                             Place{"toe_3", 0.43, 0.085},
                             Place{"toe_4", 0.26, 0.135},
                             Place{"toe_5", 0.09, 0.180},
                             Place{"mth_1", 0.80, 0.270},
                             Place{"mth_2", 0.58, 0.270},
                             Place{"mth_3", 0.42, 0.285},
                             Place{"mth_4", 0.28, 0.305},
                             Place{"mth_5", 0.13, 0.335},
                             Place{"midfoot", 0.48, 0.570},
                             Place{"heel", 0.48, 0.860}};

constexpr double kMidfootFrom = 0.40;
constexpr double kHeelFrom = 0.74;

QPointF catmullRom(const QPointF& before, const QPointF& at, const QPointF& next) {
  return at + (next - before) / 6.0;
}

}  // namespace

QRectF soleBox(const QRectF& box) {
  const double scale = std::min(box.width() / kWidth, box.height() / kHeight);
  QRectF result(0, 0, kWidth * scale, kHeight * scale);
  result.moveCenter(box.center());
  return result;
}

QPainterPath solePath(FootSide side, const QRectF& box) {
  const QRectF inside = soleBox(box);
  const auto point = [&](std::size_t index) {
    const auto& [x, y] = kOutline.at((index + kOutline.size()) % kOutline.size());
    const double across = side == FootSide::Right ? x / kWidth : 1.0 - x / kWidth;
    return QPointF(inside.left() + across * inside.width(),
                   inside.top() + y / kHeight * inside.height());
  };
  QPainterPath path(point(0));
  const std::size_t count = kOutline.size();
  for (std::size_t i = 0; i < count; ++i) {
    const QPointF from = point(i);
    const QPointF to = point(i + 1);
    path.cubicTo(
        catmullRom(point(i + count - 1), from, to), catmullRom(point(i + 2), to, from), to);
  }
  path.closeSubpath();
  return path;
}

QString placeAt(FootSide side, const QPointF& at) {
  if (at.y() > kHeelFrom) {
    return QStringLiteral("heel");
  }
  if (at.y() > kMidfootFrom) {
    return QStringLiteral("midfoot");
  }
  const double x = side == FootSide::Right ? at.x() : 1.0 - at.x();
  const Place* nearest = &kPlaces.front();
  double best = 1e9;
  for (const Place& place : kPlaces) {
    // A toe's width counts more than its length: the rays run along the foot.
    const double dx = 1.4 * (place.x - x) * kWidth;
    const double dy = (place.y - at.y()) * kHeight;
    if (place.y < kMidfootFrom && dx * dx + dy * dy < best) {
      best = dx * dx + dy * dy;
      nearest = &place;
    }
  }
  return QLatin1String(nearest->name);
}

QPointF middleOf(FootSide side, const QString& place) {
  for (const Place& known : kPlaces) {
    if (place == QLatin1String(known.name)) {
      return {side == FootSide::Right ? known.x : 1.0 - known.x, known.y};
    }
  }
  return {0.5, 0.5};
}

void paintMiniFoot(
    QPainter& painter, const QRectF& box, FootSide side, const QString& place, bool healed) {
  const Theme& theme = Look::theme();
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(QPen(theme.control_edge, 1.0));
  painter.setBrush(theme.sunk);
  painter.drawPath(solePath(side, box));
  if (!place.isEmpty()) {
    const QRectF inside = soleBox(box);
    const QPointF middle = middleOf(side, place);
    const QPointF at(inside.left() + middle.x() * inside.width(),
                     inside.top() + middle.y() * inside.height());
    const double radius = 0.085 * inside.height();
    painter.setPen(healed ? QPen(theme.accent, 1.5) : QPen(Qt::NoPen));
    painter.setBrush(healed ? theme.surface : theme.danger);
    painter.drawEllipse(at, radius, radius);
  }
  painter.restore();
}

}  // namespace tarsus
