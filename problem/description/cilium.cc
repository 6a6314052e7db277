// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/description/cilium.h"

#include <numbers>

namespace ciliaval::description {
namespace {

constexpr std::size_t longest_name = 100;  ///< bytes

// A member that is added does not compile until it stands here; describe it below.
[[maybe_unused]] void every_member(const Cilium& cilium, const Segment& segment,
                                   const CrossSection& section) {
  [[maybe_unused]] const auto& [diameter, segments, of_cilium] = cilium;
  [[maybe_unused]] const auto& [name, length, modulus, ratio, axial, density, transverse] = segment;
  [[maybe_unused]] const auto& [shape, width, height, inner_diameter, orientation] = section;
}

/// M of the segment, whose component along the axis is a member of its own.
Field<Segment> magnetization_field() {
  Field<Segment> field = description::field(
      &Segment::magnetization, "magnetization", quantity::magnetization,
      {-1e8, 1e8, false, "the strongest magnets have about 1.2e6 A/m; divide a B_r in T by mu_0"},
      "Axial magnetisation B_r/mu_0 from base to tip, negative to the base; or three components "
      "along x, y, z of the straight cilium.");
  field.initial = Vector3(Vector3::Zero());
  field.may_be_axial = true;
  field.get = [](const Segment& segment) { return Value(magnetization(segment)); };
  field.set = [](Segment& segment, const Value& value) {
    const auto& M = std::get<Vector3>(value);
    segment.transverse_magnetization = {M.x(), M.y()};
    segment.magnetization = M.z();
  };
  return falls_back_to(std::move(field), "0 A/m");
}

}  // namespace

template <>
const Fields<Segment>& fields<Segment>() {
  static const Fields<Segment> all = [] {
    Field<Segment> name =
        required(field(&Segment::name, "name", "Name of the segment, different from the others'."));
    name.longest = longest_name;
    return Fields<Segment>{
        name,
        required(field(&Segment::length, "length", quantity::length, length_range,
                       "Length along the straight axis.")),
        required(field(&Segment::young_modulus, "young_modulus", quantity::pressure,
                       {1, 1e15, false, unit_slip}, "Young's modulus E.")),
        required(field(&Segment::poisson_ratio, poisson_ratio_key,
                       {-1, 0.5, true,
                        "an elastic solid is stable only in between, and a compressible one below "
                        "0.5"},
                       "Poisson's ratio; rubber is near 0.49.")),
        magnetization_field(),
        optional(
            field(&Segment::density, "density", quantity::density, {1e-3, 1e5, false, unit_slip},
                  "Of the material, for its weight: `gravity` of [environment] needs it of "
                  "each segment."),
            "not known")};
  }();
  return all;
}

template <>
const Fields<CrossSection>& fields<CrossSection>() {
  using Shape = CrossSection::Shape;
  const auto of_rectangle = [](const Field<CrossSection>& field) {
    return only_with(&CrossSection::shape, Shape::rectangle, R"(shape = "rectangle")", field);
  };
  static const Fields<CrossSection> all{
      required(choice(
          &CrossSection::shape, "shape",
          {{"circle", Shape::circle}, {"rectangle", Shape::rectangle}, {"tube", Shape::tube}},
          "Shape of the section, if it is not the full circle of `diameter`.")),
      of_rectangle(required(field(&CrossSection::width, "width", quantity::length, length_range,
                                  "`rectangle`: its first side, along x unless it is turned."))),
      of_rectangle(required(field(&CrossSection::height, "height", quantity::length, length_range,
                                  "`rectangle`: its second side, along y unless it is turned."))),
      of_rectangle(falls_back_to(
          field(&CrossSection::orientation, "orientation", quantity::angle,
                {-4 * std::numbers::pi, 4 * std::numbers::pi, false,
                 "more than two turns is taken for a slip in the unit"},
                "`rectangle`: turn of the first side from +x towards +y. The load's azimuth lies "
                "along a side."),
          "0 deg")),
      only_with(&CrossSection::shape, Shape::tube, R"(shape = "tube")",
                required(field(&CrossSection::inner_diameter, inner_diameter_key, quantity::length,
                               length_range, "`tube`: diameter of the hole.")))};
  return all;
}

template <>
const Fields<Cilium>& fields<Cilium>() {
  static const Fields<Cilium> all{[] {
    Field<Cilium> diameter =
        field(&Cilium::diameter, diameter_key, quantity::length, length_range,
              "Diameter d of the section, the same all along; of a tube the outer one.");
    diameter.condition = [](const Cilium& cilium) { return !cilium.is_rectangular(); };
    diameter.goes_with = "a circle or a tube";
    return required(falls_back_to(diameter, "none of a rectangle"));
  }()};
  return all;
}

}  // namespace ciliaval::description
