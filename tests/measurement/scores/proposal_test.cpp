#include "measurement/scores/proposal.h"

#include <gtest/gtest.h>

namespace tarsus {
namespace {

TEST(Proposal, AreaIsInSquareCentimetresAndNotConfirmed) {
  const auto area = proposedArea(466.9);
  EXPECT_NEAR(area.value.value(), 4.669, 1e-12);
  EXPECT_EQ(area.source, ItemSource::Model);
  EXPECT_FALSE(area.confirmed);
  EXPECT_FALSE(area.usable());
}

TEST(Proposal, SiteByThePlaceAlongTheFoot) {
  const Eigen::Vector3d heel(10, 20, 300);
  const Eigen::Vector3d toe = heel + Eigen::Vector3d(0, 250, 0);
  const auto site = [&](double along_mm) {
    // Aside and above: only the way along the foot counts.
    return proposedSite(heel + Eigen::Vector3d(30, along_mm, -15), heel, toe);
  };
  EXPECT_EQ(site(-5).value, FootSite::Hindfoot);
  EXPECT_EQ(site(30).value, FootSite::Hindfoot);
  EXPECT_EQ(site(100).value, FootSite::Midfoot);
  EXPECT_EQ(site(180).value, FootSite::Forefoot);
  EXPECT_EQ(site(260).value, FootSite::Forefoot);
  EXPECT_FALSE(site(180).confirmed);
  EXPECT_EQ(site(180).source, ItemSource::Model);
}

TEST(Proposal, NoSiteWithoutAFoot) {
  const Eigen::Vector3d heel(10, 20, 300);
  EXPECT_FALSE(proposedSite(heel, heel, heel).value);
}

}  // namespace
}  // namespace tarsus
