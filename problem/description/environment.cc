// SPDX-License-Identifier: LGPL-2.1-or-later
#include "problem/description/environment.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "problem/field_model.h"
#include "problem/support/rotation.h"

namespace ciliaval::description {
namespace {

using surroundings::Environment;
using surroundings::MagneticEnergy;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

constexpr Range field_range{-100, 100, false, unit_slip};

// A member that is added does not compile until it stands here; describe it below.
[[maybe_unused]] void every_member_of_environment(const Environment& environment,
                                                  const Magnet& magnet) {
  [[maybe_unused]] const auto& [gravity, fluid, field, energy, magnets] = environment;
  [[maybe_unused]] const auto& [name, shape, position, rotation, diameter, length, edges, M] =
      magnet;
}

/// The unit quaternion from the magnet's own axes to those of space.
Field<Magnet> rotation_field() {
  Field<Magnet> result;
  result.name = rotation_key;
  result.range = {-1, 1, false, "a quaternion of a rotation has unit length"};
  result.doc =
      "In place of `axis`: the rotation of its own axes, the unit quaternion `[w, x, y, z]`.";
  result.initial = std::array<double, 4>{1, 0, 0, 0};
  result.get = [](const Magnet& magnet) {
    const Quaternion& q = magnet.rotation;
    return Value(std::array{q.w(), q.x(), q.y(), q.z()});
  };
  result.set = [](Magnet& magnet, const Value& value) {
    const auto& [w, x, y, z] = std::get<std::array<double, 4>>(value);
    magnet.rotation = Quaternion(w, x, y, z);
  };
  return optional(result, "`axis`");
}

/// The direction of its third axis; of a zero the quaternion is zero, which is none of a rotation.
Field<Magnet> axis_field() {
  Field<Magnet> result;
  result.name = axis_key;
  result.range = {-1e6, 1e6, false, unit_slip};
  result.doc =
      "Direction `[x, y, z]` of its own third axis, along which it is magnetised; the other two "
      "are turned with it by the shortest way.";
  result.initial = Vector3(Vector3::UnitZ());
  result.get = [](const Magnet& magnet) {
    return Value(Vector3(magnet.rotation * Vector3::UnitZ()));
  };
  result.set = [](Magnet& magnet, const Value& value) {
    const auto& direction = std::get<Vector3>(value);
    magnet.rotation = direction.isZero(0) ? Quaternion(0, 0, 0, 0) : support::turn_to(direction);
  };
  return in_place_of(rotation_key, falls_back_to(result, "`[0, 0, 1]`"));
}

Field<Magnet> remanence_field() {
  Field<Magnet> result;
  result.name = remanence_key;
  result.quantity = quantity::flux_density;
  result.range = field_range;
  result.doc = "B_r = mu_0 M in place of `magnetization`, along its own third axis.";
  result.initial = 0.0;
  result.get = [](const Magnet& magnet) {
    return Value(vacuum_permeability * magnet.magnetization.z());
  };
  result.set = [](Magnet& magnet, const Value& value) {
    magnet.magnetization = std::get<double>(value) / vacuum_permeability * Vector3::UnitZ();
  };
  return in_place_of(magnetization_key, falls_back_to(result, "`magnetization`"));
}

/// A size of a magnet of one of the shapes.
Field<Magnet> size_of(std::initializer_list<Shape> shapes, std::string_view words,
                      const Field<Magnet>& size) {
  Field<Magnet> result = required(size);
  result.condition = [shapes = std::vector<Shape>(shapes)](const Magnet& magnet) {
    return std::ranges::find(shapes, magnet.shape) != shapes.end();
  };
  result.goes_with = words;
  return result;
}

}  // namespace

template <>
const Fields<Environment>& fields<Environment>() {
  static const Fields<Environment> all{
      optional(field(&Environment::gravity, "gravity", quantity::acceleration,
                     {-1e4, 1e4, false, unit_slip},
                     "The acceleration `[x, y, z]` of free fall, such as `[\"0 m/s2\", \"0 m/s2\", "
                     "\"-9.81 m/s2\"]` for a cilium that stands; each segment needs a `density`."),
               "none"),
      falls_back_to(
          field(&Environment::fluid_density, "fluid_density", quantity::density,
                {0, 1e5, false, unit_slip},
                "Of a fluid around the cilium, whose buoyancy takes its part off the weight."),
          "0 kg/m^3"),
      along_path(optional(
          field(&Environment::uniform_field, "uniform_field", quantity::flux_density, field_range,
                "A uniform field B_0 `[x, y, z]` that turns the magnet, or a list of such, which "
                "is a path. Sensors read the cilium's field without it."),
          "none")),
      choice(&Environment::magnetic_energy, "magnetic_energy",
             {{name(MagneticEnergy::F), MagneticEnergy::F},
              {name(MagneticEnergy::R), MagneticEnergy::R}},
             "Energy of the cilium's magnet in the fields: the magnetisation carried along by the "
             "deformation, -(F M).B_0, or turned by its rotation, -(R M).B_0.")};
  return all;
}

template <>
const Fields<Magnet>& fields<Magnet>() {
  static const Fields<Magnet> all = [] {
    Field<Magnet> its_name =
        required(field(&Magnet::name, "name", "Name of the magnet, different from the others'."));
    its_name.longest = 100;  // bytes
    Field<Magnet> magnetization = required(
        field(&Magnet::magnetization, magnetization_key, quantity::magnetization,
              {-1e8, 1e8, false, "the strongest magnets have about 1.2e6 A/m"},
              "M along its own third axis, or three components along its own axes (a cylinder's "
              "along its axis only)."));
    magnetization.may_be_axial = true;
    magnetization.fallback = "`remanence`";
    const auto sized = [](auto member, std::string_view key, std::string_view doc) {
      return field(member, key, quantity::length, length_range, doc);
    };
    return Fields<Magnet>{
        its_name,
        required(choice(&Magnet::shape, "shape",
                        {{name(Shape::ball), Shape::ball},
                         {name(Shape::cylinder), Shape::cylinder},
                         {name(Shape::cuboid), Shape::cuboid}},
                        "Shape of a magnet at rest beside the cilium, which it pulls and turns. "
                        "Sensors read the cilium's field without it.")),
        along_path(required(
            field(&Magnet::position, "position", quantity::length, {-100, 100, false, unit_slip},
                  "The point `[x, y, z]` of the centre, or a list of such, which is a path."))),
        axis_field(),
        rotation_field(),
        size_of({Shape::ball, Shape::cylinder}, "a ball or a cylinder",
                sized(&Magnet::diameter, "diameter", "Of a ball or a cylinder.")),
        size_of({Shape::cylinder}, "a cylinder",
                sized(&Magnet::length, "length", "Of a cylinder, along its axis.")),
        size_of({Shape::cuboid}, "a cuboid",
                sized(&Magnet::edges, "edges", "Of a cuboid, along its own axes `[a, b, c]`.")),
        magnetization,
        remanence_field()};
  }();
  return all;
}

}  // namespace ciliaval::description
