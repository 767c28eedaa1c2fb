#pragma once

#include <stdexcept>
#include <string>

/// States what the caller must guarantee. Always on; a violation is a bug in our code.
#define TARSUS_REQUIRE(condition, message)                                                   \
  do {                                                                                       \
    if (!(condition)) {                                                                      \
      throw std::logic_error(std::string(__FILE__) + ':' + std::to_string(__LINE__) + ": " + \
                             (message));                                                     \
    }                                                                                        \
  } while (false)
