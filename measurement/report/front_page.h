#pragma once

#include "measurement/report/page_canvas.h"

namespace tarsus {

/// Page 1: whose wound, the key values, one sentence, the pictures. Starts no page of its own.
/// @return false where the other wounds of the visit found no room
bool frontPage(PageCanvas& canvas, const ReportContent& content);

}  // namespace tarsus
