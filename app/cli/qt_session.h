#pragma once

namespace tarsus {

/// Text painting and databases need a Qt application; no display does. The first call makes it.
void startQt();

}  // namespace tarsus
