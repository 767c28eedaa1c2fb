#include "reconstruction/capture/simulator/ulcer_designs.h"

namespace tarsus {
namespace {

UlcerDesign forefoot() {
  return {.site = "forefoot, plantar, under metatarsal heads 1-3",
          .seen_from = {184, 10, -60},
          .seen_towards = {0, 0, 1},
          .half_length_mm = 13.6,
          .half_width_mm = 10.6,
          .turn_rad = 1.15,
          .depth_mm = 3.4,
          .wall_mm = 1.0,
          .irregularity = 0.16,
          .undulation = 0.30,
          .slough = 0.30,
          .necrosis = 0.03,
          .islands = 2};
}

UlcerDesign heel() {
  return {.site = "heel, plantar",
          .seen_from = {36, 1, -60},
          .seen_towards = {0, 0, 1},
          .half_length_mm = 11.6,
          .half_width_mm = 9.6,
          .turn_rad = 0.35,
          .depth_mm = 11.5,
          .wall_mm = 1.2,
          .irregularity = 0.10,
          .undulation = 0.14,
          .slough = 0.45,
          .necrosis = 0.16,
          .islands = 0};
}

UlcerDesign lateral() {
  return {.site = "lateral edge, over metatarsal head 5",
          .seen_from = {168, -120, 8},
          .seen_towards = {0, 0.966, 0.259},
          .half_length_mm = 7.9,
          .half_width_mm = 5.9,
          .turn_rad = 0.25,
          .depth_mm = 3.2,
          .wall_mm = 0.8,
          .irregularity = 0.13,
          .undulation = 0.22,
          .slough = 0.30,
          .necrosis = 0.14,
          .islands = 0};
}

UlcerDesign underFirstHead() {
  return {.site = "forefoot, plantar, under metatarsal head 1",
          .seen_from = {183, 28, -60},
          .seen_towards = {0, 0, 1},
          .half_length_mm = 9.2,
          .half_width_mm = 7.4,
          .turn_rad = 0.6,
          .depth_mm = 3.0,
          .wall_mm = 0.9,
          .irregularity = 0.14,
          .undulation = 0.25,
          .slough = 0.35,
          .necrosis = 0.0,
          .islands = 1};
}

UlcerDesign bigToe() {
  return {.site = "toe 1, plantar",
          .seen_from = {243, 31, -60},
          .seen_towards = {0, 0, 1},
          .half_length_mm = 5.6,
          .half_width_mm = 4.6,
          .turn_rad = 0.1,
          .depth_mm = 2.0,
          .wall_mm = 0.6,
          .irregularity = 0.10,
          .undulation = 0.18,
          .slough = 0.25,
          .necrosis = 0.06,
          .islands = 0,
          .on_toe = 0};
}

}  // namespace

std::vector<UlcerDesign> ulcerDesigns(FootCase foot) {
  switch (foot) {
    case FootCase::Forefoot:
      return {forefoot()};
    case FootCase::Heel:
      return {heel()};
    case FootCase::Lateral:
      return {lateral()};
    case FootCase::Two:
      break;
  }
  return {underFirstHead(), bigToe()};
}

}  // namespace tarsus
