#pragma once

#include "measurement/report/page_canvas.h"

#include <functional>

namespace tarsus {

/// Where the next thing goes, and how a page is turned when it does not fit.
struct Flow {
  PageCanvas& canvas;
  const ReportContent& content;
  double y = 0.0;
  /// Closes the page and opens the next; returns where its content begins [mm].
  const std::function<double()>& turn_page;

  /// @return whether the page was turned
  bool need(double height_mm) {
    if (y + height_mm <= canvas.contentBottom()) {
      return false;
    }
    y = turn_page();
    return true;
  }
};

/// A paragraph over the whole width, with a frame of that name. What is higher than a page goes on
/// on the next ones, as nothing that a person wrote is cut.
void paragraphOf(Flow& flow, const std::string& name, const std::vector<TextRun>& runs);

/// As many lines from `first` as fit the page. @return the first that is left
std::size_t paintFitting(Flow& flow,
                         const QPointF& top_left_mm,
                         const TextLines& text,
                         std::size_t first);

/// Grey words at the right end of a section's head.
void headNote(Flow& flow, const QString& text);

}  // namespace tarsus
