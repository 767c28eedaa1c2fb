#pragma once

#include <string>
#include <vector>

namespace tarsus {

/// Started again as `PROGRAM --child ARGUMENTS...`, a test program runs this instead of its tests.
using ChildMain = int (*)(const std::vector<std::string>& arguments);
/// To be called while the program's statics are made.
int registerChild(ChildMain child);

}  // namespace tarsus
