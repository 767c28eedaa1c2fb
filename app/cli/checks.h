#pragma once

#include <CLI/CLI.hpp>

#include <sstream>
#include <string>

namespace tarsus {

/// A number between two bounds; CLI::Range lets "nan" pass.
inline CLI::Validator inRange(double least, double most) {
  std::ostringstream bounds;
  bounds << least << " to " << most;
  return {[least, most, text = bounds.str()](const std::string& value) {
            double number = 0.0;
            const bool is_number = CLI::detail::lexical_cast(value, number);
            return is_number && number >= least && number <= most
                       ? std::string()
                       : "\"" + value + "\" is no number from " + text;
          },
          bounds.str()};
}

/// "" would mean the folder one stands in.
inline CLI::Validator notEmpty() {
  return {[](const std::string& value) { return value.empty() ? "a name is needed" : ""; }, ""};
}

}  // namespace tarsus
