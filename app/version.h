#pragma once

#ifndef TARSUS_VERSION
#error "the build gives TARSUS_VERSION"
#endif
