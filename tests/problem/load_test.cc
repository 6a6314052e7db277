// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/load.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "problem/error.h"

namespace ciliaval {
namespace {

TEST(Load, PointsAlongItsAzimuth) {
  const Load load = FlowLoad{0.3, std::numbers::pi / 6};
  EXPECT_EQ(type(load), "flow");
  EXPECT_NEAR((direction(load) - Vector3(std::sqrt(3.0) / 2, 0.5, 0)).norm(), 0, 1e-15);
}

TEST(Load, InterpolatesEveryParameter) {
  const Load load = interpolate(ContactLoad{0, 10e-3, 0.2}, ContactLoad{4e-3, 14e-3, 0.6}, 0.25);
  const auto contact = *load.as<ContactLoad>();
  EXPECT_DOUBLE_EQ(contact.force, 1e-3);
  EXPECT_DOUBLE_EQ(contact.height, 11e-3);
  EXPECT_DOUBLE_EQ(contact.azimuth, 0.3);
  EXPECT_THROW(interpolate(ContactLoad{}, DeadLoad{}, 0.5), InputError);
}

TEST(Load, ChangesItsMagnitudeAlone) {
  const Load load = with_magnitude(SectionLoad{1e-3, 5e-3, 0.4}, 7e-3);
  const auto section = *load.as<SectionLoad>();
  EXPECT_EQ(magnitude(load), 7e-3);
  EXPECT_EQ(section.arclength, 5e-3);
  EXPECT_EQ(section.azimuth, 0.4);
}

TEST(Load, AProbeHasItsDisplacementForMagnitude) {
  const Load load = with_magnitude(ProbeLoad{1e-3, 16e-3, 0.4}, 3e-3);
  EXPECT_EQ(type(load), "probe");
  EXPECT_EQ(magnitude(load), 3e-3);
  EXPECT_EQ(load.as<ProbeLoad>()->displacement, 3e-3);
  EXPECT_EQ(contact_height(load), 16e-3);
  const Load half = interpolate(ProbeLoad{0, 10e-3, 0.2}, ProbeLoad{4e-3, 14e-3, 0.6}, 0.5);
  EXPECT_DOUBLE_EQ(half.as<ProbeLoad>()->displacement, 2e-3);
  EXPECT_DOUBLE_EQ(half.as<ProbeLoad>()->height, 12e-3);
  EXPECT_DOUBLE_EQ(azimuth(half), 0.4);
}

TEST(Load, SaysTheUnitOfItsMagnitude) {
  EXPECT_EQ(magnitude_unit(ContactLoad{}), "N");
  EXPECT_EQ(magnitude_unit(FlowLoad{}), "N/m");
  EXPECT_EQ(magnitude_unit(SectionLoad{}), "N");
  EXPECT_EQ(magnitude_unit(DeadLoad{}), "N/m");
  EXPECT_EQ(magnitude_unit(ProbeLoad{}), "m");
  EXPECT_EQ(contact_height(ContactLoad{1, 2, 3}), 2);
  EXPECT_FALSE(contact_height(FlowLoad{}));
}

TEST(Load, RefusesWhatTheCiliumCannotBear) {
  const Cilium cilium{1e-3, {{"all", 20e-3, 1e6, 0.3, 0}}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NO_THROW(require_valid(ContactLoad{1e-3, 16e-3, 0}, cilium));
  EXPECT_NO_THROW(require_valid(SectionLoad{1e-3, 20e-3, 0}, cilium));
  EXPECT_THROW(require_valid(ContactLoad{1e-3, 20e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ContactLoad{1e-3, 0, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ContactLoad{-1e-3, 16e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ContactLoad{nan, 16e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ContactLoad{1e-3, nan, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(FlowLoad{1, nan}, cilium), InputError);
  EXPECT_NO_THROW(require_valid(ProbeLoad{0, 16e-3, 0}, cilium));
  EXPECT_NO_THROW(require_valid(ProbeLoad{1, 16e-3, 0}, cilium));  // it will slip off
  EXPECT_THROW(require_valid(ProbeLoad{1e-3, 20e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ProbeLoad{1e-3, 0, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ProbeLoad{-1e-3, 16e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ProbeLoad{nan, 16e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(ProbeLoad{1e-3, 16e-3, nan}, cilium), InputError);
  EXPECT_THROW(require_valid(SectionLoad{1e-3, 20.001e-3, 0}, cilium), InputError);
  EXPECT_THROW(require_valid(DeadLoad{std::numeric_limits<double>::infinity(), 0}, cilium),
               InputError);
}

}  // namespace
}  // namespace ciliaval
