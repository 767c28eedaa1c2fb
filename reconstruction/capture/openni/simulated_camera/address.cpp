#include "reconstruction/capture/openni/simulated_camera/address.h"

#include <array>
#include <sstream>
#include <utility>

namespace tarsus {
namespace {

std::optional<CameraFault> parseFault(const std::string& text) {
  constexpr std::array<std::pair<std::string_view, CameraFault::Kind>, 5> kKinds{
      {{"unplug", CameraFault::Kind::Unplug},
       {"stall", CameraFault::Kind::Stall},
       {"drop", CameraFault::Kind::Drop},
       {"unit", CameraFault::Kind::Unit},
       {"garbage", CameraFault::Kind::Garbage}}};
  std::istringstream fields(text);
  std::string name;
  std::getline(fields, name, ',');
  CameraFault fault;
  for (const auto& [known, kind] : kKinds) {
    if (name == known) {
      fault.kind = kind;
    }
  }
  char comma = ',';
  if (fields >> fault.from_s) {
    fields >> comma >> fault.to_s;
  }
  const bool usable =
      fault.kind != CameraFault::Kind::None && fault.from_s >= 0.0 && fault.to_s > fault.from_s;
  return usable ? std::optional(fault) : std::nullopt;
}

}  // namespace

std::optional<SimulatedAddress> parseSimulatedAddress(std::string_view uri) {
  constexpr std::string_view kFault = "?fault=";
  if (!uri.starts_with(kSimulatedScheme)) {
    return std::nullopt;
  }
  uri.remove_prefix(kSimulatedScheme.size());
  SimulatedAddress address;
  if (uri.ends_with(kSimulatedOnce)) {
    address.once = true;
    uri.remove_suffix(kSimulatedOnce.size());
  }
  if (const auto at = uri.rfind(kFault); at != std::string_view::npos) {
    const auto fault = parseFault(std::string(uri.substr(at + kFault.size())));
    if (!fault) {
      return std::nullopt;
    }
    address.fault = *fault;
    uri = uri.substr(0, at);
  }
  address.scan = uri;
  return address.scan.is_absolute() ? std::optional(address) : std::nullopt;
}

}  // namespace tarsus
