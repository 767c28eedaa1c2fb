#include "measurement/report/flow.h"

#include <algorithm>

namespace tarsus {

std::size_t paintFitting(Flow& flow,
                         const QPointF& top_left_mm,
                         const TextLines& text,
                         std::size_t first) {
  const double room = flow.canvas.contentBottom() - top_left_mm.y();
  const auto fit = static_cast<std::size_t>(std::max(1.0, room / text.line_mm + 1e-6));
  const std::size_t count = std::min(fit, text.lines.size() - first);
  flow.canvas.paint(top_left_mm, text, first, count);
  return first + count;
}

void paragraphOf(Flow& flow, const std::string& name, const std::vector<TextRun>& runs) {
  const TextLines text = flow.canvas.linesOf(page::kContentWidth, runs);
  constexpr double kTooHigh_mm = 120.0;
  flow.need(text.height() < kTooHigh_mm ? text.height() : 3.0 * text.line_mm);
  for (std::size_t first = 0; first < text.lines.size();) {
    if (first > 0) {
      flow.y = flow.turn_page();
    }
    const std::size_t next = paintFitting(flow, {page::kLeft, flow.y}, text, first);
    const double height = text.line_mm * static_cast<double>(next - first);
    flow.canvas.frame(name, {page::kLeft, flow.y, page::kContentWidth, height});
    flow.y += height + 1.0;
    first = next;
  }
}

void headNote(Flow& flow, const QString& text) {
  flow.canvas.text(
      {page::kRight, flow.y + 0.5}, text, type::kCaption.in(ink::kGrey), Qt::AlignRight);
}

}  // namespace tarsus
