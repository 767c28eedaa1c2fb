#include "measurement/report/flow.h"

namespace tarsus {

void paragraphOf(Flow& flow, const std::string& name, const std::vector<TextRun>& runs) {
  const double height = flow.canvas.paragraphHeight(page::kContentWidth, runs);
  flow.need(height);
  flow.canvas.paragraph({page::kLeft, flow.y}, page::kContentWidth, runs);
  flow.canvas.frame(name, {page::kLeft, flow.y, page::kContentWidth, height});
  flow.y += height + 1.0;
}

void headNote(Flow& flow, const QString& text) {
  flow.canvas.text(
      {page::kRight, flow.y + 0.5}, text, type::kCaption.in(ink::kGrey), Qt::AlignRight);
}

}  // namespace tarsus
