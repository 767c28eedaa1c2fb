#pragma once

#include "measurement/report/flow.h"

namespace tarsus {

// The numbered sections after the front page; each starts a new page where it does not fit.

void measurementSection(Flow& flow);  ///< 4: splits only between groups, with its head repeated
void findingsSection(Flow& flow);     ///< 5
void scoreSection(Flow& flow);        ///< 6
void trendSection(Flow& flow);        ///< 7: needs an earlier visit
void comparisonSection(Flow& flow);   ///< 8: needs an earlier visit
void notesSection(Flow& flow);        ///< 9
void qualitySection(Flow& flow);      ///< 10
void signatureSection(Flow& flow);    ///< 11
void aboutSection(Flow& flow);        ///< 12

}  // namespace tarsus
