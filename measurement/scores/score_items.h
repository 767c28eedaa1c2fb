#pragma once

// The names, words and limits of all inputs, in one place for the rules and for JSON.

#include "measurement/scores/scores.h"

#include <array>
#include <string_view>
#include <type_traits>

namespace tarsus {

struct ItemFacts {
  std::string_view name;
  double least = 0.0;  ///< of a number; what lies outside is a slip of unit or of the pen
  double most = 0.0;
  std::string_view unit = {};
};

/// Words of an enumeration, in the order of its values.
template <typename E>
inline constexpr std::array<std::string_view, 0> kWords{};
template <>
inline constexpr std::array<std::string_view, 3> kWords<FootSite>{
    "forefoot", "midfoot", "hindfoot"};
template <>
inline constexpr std::array<std::string_view, 6> kWords<UlcerDepth>{
    "skin", "subcutis", "muscle", "tendon", "joint", "bone"};
template <>
inline constexpr std::array<std::string_view, 3> kWords<WagnerDepth>{"none", "superficial", "deep"};
template <>
inline constexpr std::array<std::string_view, 3> kWords<Gangrene>{"none", "local", "whole_foot"};
template <>
inline constexpr std::array<std::string_view, 6> kWords<TexasDepth>{
    "epithelialised", "superficial", "tendon", "capsule", "bone", "joint"};
template <>
inline constexpr std::array<std::string_view, 5> kWords<WifiDepth>{
    "none", "shallow", "distal_phalanx", "bone_joint_tendon", "extensive_deep"};
template <>
inline constexpr std::array<std::string_view, 4> kWords<FootInfection>{
    "none", "mild", "moderate", "severe"};
template <>
inline constexpr std::array<std::string_view, 4> kWords<ExudateAmount>{
    "none", "light", "moderate", "heavy"};
template <>
inline constexpr std::array<std::string_view, 5> kWords<WoundTissue>{
    "closed", "epithelium", "granulation", "slough", "necrosis"};

template <typename Input, typename Wanted>
concept InputOf = std::is_same_v<std::remove_const_t<Input>, Wanted>;

/// Calls visit(facts, item) for each item of an input, const or not.
template <InputOf<SinbadInput> Input, typename Visit>
void forEachItem(Input& in, const Visit& visit) {
  visit(ItemFacts{"site"}, in.site);
  visit(ItemFacts{"ischaemia"}, in.ischaemia);
  visit(ItemFacts{"neuropathy"}, in.neuropathy);
  visit(ItemFacts{"infection"}, in.infection);
  visit(ItemFacts{"area_cm2", 0.0, 1000.0, "cm2"}, in.area_cm2);
  visit(ItemFacts{"depth"}, in.depth);
}

template <InputOf<WagnerInput> Input, typename Visit>
void forEachItem(Input& in, const Visit& visit) {
  visit(ItemFacts{"depth"}, in.depth);
  visit(ItemFacts{"abscess_or_osteomyelitis"}, in.abscess_or_osteomyelitis);
  visit(ItemFacts{"gangrene"}, in.gangrene);
}

template <InputOf<TexasInput> Input, typename Visit>
void forEachItem(Input& in, const Visit& visit) {
  visit(ItemFacts{"depth"}, in.depth);
  visit(ItemFacts{"infection"}, in.infection);
  visit(ItemFacts{"ischaemia"}, in.ischaemia);
}

template <InputOf<InfectionInput> Input, typename Visit>
void forEachItem(Input& in, const Visit& visit) {
  visit(ItemFacts{"swelling_or_induration"}, in.swelling_or_induration);
  visit(ItemFacts{"erythema_cm", 0.0, 60.0, "cm"}, in.erythema_cm);
  visit(ItemFacts{"tenderness_or_pain"}, in.tenderness_or_pain);
  visit(ItemFacts{"warmth"}, in.warmth);
  visit(ItemFacts{"pus"}, in.pus);
  visit(ItemFacts{"osteomyelitis"}, in.osteomyelitis);
  visit(ItemFacts{"deeper_than_subcutis"}, in.deeper_than_subcutis);
  visit(ItemFacts{"temperature_c", 25.0, 45.0, "degrees Celsius"}, in.temperature_c);
  visit(ItemFacts{"heart_rate_per_min", 10.0, 350.0, "per minute"}, in.heart_rate_per_min);
  visit(ItemFacts{"respiratory_rate_per_min", 2.0, 100.0, "per minute"},
        in.respiratory_rate_per_min);
  visit(ItemFacts{"paco2_mmhg", 5.0, 200.0, "mmHg"}, in.paco2_mmhg);
  visit(ItemFacts{"wbc_10e9_per_l", 0.0, 500.0, "x 10^9/L"}, in.wbc_10e9_per_l);
  visit(ItemFacts{"bands_percent", 0.0, 100.0, "%"}, in.bands_percent);
}

template <InputOf<WifiInput> Input, typename Visit>
void forEachItem(Input& in, const Visit& visit) {
  visit(ItemFacts{"depth"}, in.depth);
  visit(ItemFacts{"heel"}, in.heel);
  visit(ItemFacts{"abi", 0.0, 3.0, "(a ratio)"}, in.abi);
  visit(ItemFacts{"ankle_mmhg", 0.0, 350.0, "mmHg"}, in.ankle_mmhg);
  visit(ItemFacts{"toe_mmhg", 0.0, 350.0, "mmHg"}, in.toe_mmhg);
  visit(ItemFacts{"tcpo2_mmhg", 0.0, 200.0, "mmHg"}, in.tcpo2_mmhg);
  visit(ItemFacts{"foot_infection"}, in.foot_infection);
}

template <InputOf<PushInput> Input, typename Visit>
void forEachItem(Input& in, const Visit& visit) {
  visit(ItemFacts{"length_cm", 0.0, 60.0, "cm"}, in.length_cm);
  visit(ItemFacts{"width_cm", 0.0, 60.0, "cm"}, in.width_cm);
  visit(ItemFacts{"exudate"}, in.exudate);
  visit(ItemFacts{"tissue"}, in.tissue);
}

}  // namespace tarsus
