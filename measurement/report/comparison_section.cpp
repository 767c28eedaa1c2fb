#include "measurement/report/sections.h"
namespace tarsus {
void comparisonSection(Flow&) {}
}  // namespace tarsus
