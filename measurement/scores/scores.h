#pragma once

#include "measurement/scores/score.h"

#include <cstdint>

namespace tarsus {

// Each rule is a pure function. A needed input that is missing or unconfirmed makes the score not
// computable, never 0. Wording of the items: clinical.md section 4, in our own short form.
// All refuse numbers that cannot be (negative, not finite, out of any living range) and inputs that
// contradict each other: @errors ScoreInputInvalid

enum class FootSite : std::uint8_t { Forefoot, Midfoot, Hindfoot };
enum class UlcerDepth : std::uint8_t { Skin, Subcutis, Muscle, Tendon, Joint, Bone };

struct SinbadInput {
  ScoreItem<FootSite> site;
  ScoreItem<bool> ischaemia;   ///< pedal blood flow reduced; false: a pedal pulse is felt
  ScoreItem<bool> neuropathy;  ///< protective sensation lost
  ScoreItem<bool> infection;   ///< bacterial
  ScoreItem<double> area_cm2;
  ScoreItem<UlcerDepth> depth;
};
/// Six items of 0 or 1.
[[nodiscard]] Expected<ScoreResult> scoreSinbad(const SinbadInput& input);

enum class WagnerDepth : std::uint8_t { None, Superficial, Deep };
enum class Gangrene : std::uint8_t { None, Local, WholeFoot };

struct WagnerInput {
  ScoreItem<WagnerDepth> depth;  ///< deep: to ligament or muscle
  ScoreItem<bool> abscess_or_osteomyelitis;
  ScoreItem<Gangrene> gangrene;
};
/// Grade 0 to 5.
[[nodiscard]] Expected<ScoreResult> scoreWagner(const WagnerInput& input);

enum class TexasDepth : std::uint8_t { Epithelialised, Superficial, Tendon, Capsule, Bone, Joint };

struct TexasInput {
  ScoreItem<TexasDepth> depth;
  ScoreItem<bool> infection;
  ScoreItem<bool> ischaemia;
};
/// Grade 0 to 3 and stage A to D.
[[nodiscard]] Expected<ScoreResult> scoreTexas(const TexasInput& input);

struct InfectionInput {
  ScoreItem<bool> swelling_or_induration;
  ScoreItem<double> erythema_cm;  ///< how far it reaches from the wound's edge; 0: none
  ScoreItem<bool> tenderness_or_pain;
  ScoreItem<bool> warmth;
  ScoreItem<bool> pus;
  ScoreItem<bool> osteomyelitis;
  // The following are asked of an infected foot alone.
  ScoreItem<bool> deeper_than_subcutis;
  ScoreItem<double> temperature_c;
  ScoreItem<double> heart_rate_per_min;
  ScoreItem<double> respiratory_rate_per_min;
  ScoreItem<double> paco2_mmhg;  ///< used where it was measured
  ScoreItem<double> wbc_10e9_per_l;
  ScoreItem<double> bands_percent;  ///< used where it was counted
};
/// Grade 1 to 4, with (O) for osteomyelitis.
[[nodiscard]] Expected<ScoreResult> scoreInfection(const InfectionInput& input);

enum class WifiDepth : std::uint8_t {
  None,
  Shallow,          ///< small, no bone exposed
  DistalPhalanx,    ///< small and shallow, bone at the distal phalanx at most
  BoneJointTendon,  ///< deeper, with bone, joint or tendon
  ExtensiveDeep,
};
enum class FootInfection : std::uint8_t { None, Mild, Moderate, Severe };

struct WifiInput {
  ScoreItem<WifiDepth> depth;
  ScoreItem<bool> heel;
  // At least one of the next four; where several are given they must agree on the grade.
  ScoreItem<double> abi;         ///< read to 0.01
  ScoreItem<double> ankle_mmhg;  ///< pressures are read to 1 mmHg
  ScoreItem<double> toe_mmhg;
  ScoreItem<double> tcpo2_mmhg;
  ScoreItem<FootInfection> foot_infection;  ///< IWGDF/IDSA grade less one
};
/// Wound, ischaemia and foot infection 0 to 3, and stage 1 to 4.
[[nodiscard]] Expected<ScoreResult> scoreWifi(const WifiInput& input);

enum class ExudateAmount : std::uint8_t { None, Light, Moderate, Heavy };
enum class WoundTissue : std::uint8_t { Closed, Epithelium, Granulation, Slough, Necrosis };

struct PushInput {
  ScoreItem<double> length_cm;
  ScoreItem<double> width_cm;
  ScoreItem<ExudateAmount> exudate;
  ScoreItem<WoundTissue> tissue;  ///< the worst that is present, in any amount
};
/// 0 to 17.
[[nodiscard]] Expected<ScoreResult> scorePush(const PushInput& input);

}  // namespace tarsus
