#include "measurement/report/numbers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace tarsus {
namespace {

int cap(Printed kind) {
  switch (kind) {
    case Printed::AreaCm2:
    case Printed::VolumeMl:
      return 2;
    case Printed::LengthMm:
    case Printed::DepthMm:
      return 1;
    case Printed::Percent:
      return 0;
  }
  return 0;
}

}  // namespace

int printedDecimals(Printed kind, std::optional<double> half_width) {
  if (kind == Printed::AreaCm2 || !half_width || !(*half_width > 0.0)) {
    return cap(kind);
  }
  // The small addend keeps 0.3 (stored as 0.29999...) from reading as a leading digit 2.
  const double exponent = std::floor(std::log10(*half_width * (1.0 + 1e-9)));
  const double leading = *half_width * (1.0 + 1e-9) / std::pow(10.0, exponent);
  const int decimals = static_cast<int>(-exponent) + (leading < 3.0 ? 1 : 0);
  return std::clamp(decimals, 0, cap(kind));
}

std::string fixedText(double value, int decimals) {
  const double scale = std::pow(10.0, decimals);
  double rounded = std::round(value * scale) / scale;
  if (rounded == 0.0) {
    rounded = 0.0;  // drops the sign of -0
  }
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, rounded);
  return buffer.data();
}

std::string intervalText(const Interval& interval, double factor, int decimals) {
  return fixedText(interval.low * factor, decimals) + "\u2013" +
         fixedText(interval.high * factor, decimals);
}

std::string dateText(const std::string& iso_8601) {
  constexpr std::array kMonths{
      "Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  int year = 0;
  int month = 0;
  int day = 0;
  int hour = 0;
  int minute = 0;
  const int read = std::sscanf(
      iso_8601.c_str(), "%4d-%2d-%2d%*[T ]%2d:%2d", &year, &month, &day, &hour, &minute);
  if (read < 5 || month < 1 || month > 12) {
    return iso_8601;
  }
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(),
                buffer.size(),
                "%d %s %d %02d:%02d%s",
                day,
                kMonths[static_cast<std::size_t>(month - 1)],
                year,
                hour,
                minute,
                iso_8601.back() == 'Z' ? " UTC" : "");
  return buffer.data();
}

}  // namespace tarsus
