#pragma once

#include "measurement/report/page_canvas.h"

namespace tarsus {

/// One page to take to the bed: the great numbers, the two close views, what is recorded, and
/// boxes and lines to fill in by hand. Needs a record.
void bedsideForm(PageCanvas& canvas, const ReportContent& content);

}  // namespace tarsus
