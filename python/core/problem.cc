// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "compare/input/described.h"
#include "compare/input/environment/environment.h"
#include "problem/cilium.h"
#include "problem/description/environment.h"
#include "problem/error.h"
#include "problem/load.h"
#include "python/core/convert.h"
#include "python/core/pickle.h"

namespace ciliaval::python::core {
namespace py = pybind11;
namespace names = compare::input::environment;
namespace {

using surroundings::Environment;

/// A parameter of a load, of which some might give a list.
description::Value parameter_value(py::handle value, const LoadParameter& parameter) {
  const bool is_list =
      !PyUnicode_Check(value.ptr()) && !as_number(value) && py::isinstance<py::sequence>(value);
  if (is_list)
    throw InputError(
        fmt::format("`{}` of a load is one {}, not {}: make a Load of each; bend() takes a list of "
                    "loads",
                    parameter.name, parameter.quantity.name, shown(value)));
  return number(value, parameter.name, parameter.quantity);
}

/// Sets the keys of a table from a dict.
void set_table(Load& load, const LoadTable& table, py::handle value) {
  if (!py::isinstance<py::dict>(value))
    throw InputError(fmt::format(
        "`{}` is a dict, such as {{\"{}\": {}}}, not {}", table.name, table.keys.front().name,
        compare::input::to_toml(table.keys.front(), table.keys.front().initial), shown(value)));
  for (const auto& [key, of_key] : py::reinterpret_borrow<py::dict>(value)) {
    const auto name = key.cast<std::string>();
    const auto found = std::ranges::find(table.keys, name, &description::Key::name);
    if (found == table.keys.end())
      throw InputError(fmt::format("`{}` has no `{}`", table.name, name));
    found->set(load, value_of(of_key, *found));
  }
}

/// What the tables of a load state, as dicts.
py::dict tables_of(const Load& load) {
  py::dict result;
  for (const LoadTable& table : load.type().tables) {
    py::dict stated;
    for (const auto& key : table.keys)
      if (key.get(load) != key.initial)
        stated[py::str(std::string(key.name))] = to_python(key, key.get(load));
    if (!stated.empty()) result[py::str(std::string(table.name))] = stated;
  }
  return result;
}

/// Sets a parameter or a setting; false if the load has none of this name.
bool set_key(Load& load, std::string_view name, py::handle value) {
  const LoadType& type = load.type();
  const auto parameter = std::ranges::find(type.parameters, name, &LoadParameter::name);
  if (parameter != type.parameters.end()) {
    parameter->set(load, parameter_value(value, *parameter));
    return true;
  }
  const auto table = std::ranges::find(type.tables, name, &LoadTable::name);
  if (table != type.tables.end()) {
    set_table(load, *table, value);
    return true;
  }
  const auto setting = std::ranges::find(type.settings, name, &description::Key::name);
  if (setting == type.settings.end()) return false;
  setting->set(load, value_of(value, *setting));
  return true;
}

Load load(const Text& type_name, const py::kwargs& parameters) {
  const std::string type = text(type_name, "type");
  const LoadType* found = find_load_type(type);
  if (found == nullptr) {
    std::string known;
    for (const LoadType* other : load_types()) known += fmt::format(" {}", other->name);
    throw InputError(fmt::format("there is no load type `{}`; there are:{}", type, known));
  }
  Load result(*found);
  std::string expected;
  for (const LoadParameter& parameter : found->parameters)
    expected += fmt::format("{}{} [{}]", expected.empty() ? "" : ", ", parameter.name,
                            parameter.quantity.unit);
  for (const auto& setting : found->settings) expected += fmt::format(", {}", setting.name);
  for (const LoadTable& table : found->tables) expected += fmt::format(", {}", table.name);
  for (const auto& [key, value] : parameters) {
    const auto name = key.cast<std::string>();
    if (!set_key(result, name, value))
      throw InputError(
          fmt::format("a load of type `{}` has no `{}`; it has: {}", type, name, expected));
  }
  for (const LoadParameter& parameter : found->parameters)
    if (parameter.fallback.empty() && !parameters.contains(py::str(std::string(parameter.name))))
      throw InputError(fmt::format("a load of type `{}` needs `{}`; it has: {}", type,
                                   parameter.name, expected));
  return result;
}

Environment environment(const Array& gravity, const Number& fluid_density,
                        const Array& uniform_field, const Text& magnetic_energy,
                        const py::object& magnets) {
  Environment result;
  set_field(result, "gravity", gravity);
  set_field(result, "fluid_density", fluid_density);
  set_field(result, "uniform_field", uniform_field);
  set_field(result, "magnetic_energy", magnetic_energy);
  result.magnets = list_of<surroundings::magnets::Magnet>(magnets, "magnets");
  return result;
}

/// The loads in their environments, one for all or one for each; without loads those of nothing
/// else.
LoadPath surrounded(const py::object& load_list, const py::object& environment_list) {
  LoadPath loads = list_of<Load>(load_list, "loads");
  const auto environments = list_of<Environment>(environment_list, "environment");
  if (environments.empty()) throw InputError("there is neither a load nor an environment");
  if (loads.empty()) return names::path_of(environments);
  const std::size_t steps = loads.size();
  if (!names::put_into(environments, loads))
    throw InputError(
        fmt::format("there are {} environments and {} loads: state one environment, "
                    "or one for each load",
                    environments.size(), steps));
  return loads;
}

std::string representation(const Vector3& vector) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", vector.x(), vector.y(), vector.z());
}

std::string representation(const Environment& around) {
  return fmt::format(
      "Environment(gravity={}, fluid_density={:.6g}, uniform_field={}, magnetic_energy='{}')",
      representation(around.gravity), around.fluid_density, representation(around.uniform_field),
      name(around.magnetic_energy));
}

std::string representation(const Load& load) {
  std::string parameters;
  for (std::size_t i = 0; i < load.values().size(); ++i)
    parameters += fmt::format(", {}={:.6g}", load.type().parameters[i].name, load.values()[i]);
  for (const auto& setting : load.type().settings)
    if (setting.get(load) != setting.initial)
      parameters += fmt::format(", {}={}", setting.name,
                                std::string(py::str(to_python(setting, setting.get(load)))));
  for (const auto& [name, stated] : tables_of(load))
    parameters += fmt::format(", {}={}", std::string(py::str(name)), std::string(py::repr(stated)));
  const std::string around = surroundings::is_empty(load.environment())
                                 ? ""
                                 : fmt::format(" in {}", representation(load.environment()));
  return fmt::format("Load('{}'{}){}", load.type().name, parameters, around);
}

Load changed(Load load, const py::kwargs& values) {
  for (const auto& [key, value] : values) {
    const auto name = key.cast<std::string>();
    const std::string_view parameter =
        name == "magnitude" ? load.type().parameters.front().name : std::string_view(name);
    if (!set_key(load, parameter, value))
      throw InputError(fmt::format("a {} has no `{}`", load.type().name, name));
  }
  return load;
}

std::string representation(const Segment& segment) {
  const Vector3 M = magnetization(segment);
  return fmt::format(
      "Segment(length={:.6g}, young_modulus={:.6g}, poisson_ratio={:.6g}, magnetization={}, "
      "name='{}', density={:.6g})",
      segment.length, segment.young_modulus, segment.poisson_ratio,
      M.head<2>().isZero(0) ? fmt::format("{:.6g}", M.z()) : representation(M), segment.name,
      segment.density);
}

std::string representation(const Cilium& cilium) {
  std::string segments;
  for (const Segment& segment : cilium.segments)
    segments += (segments.empty() ? "" : ", ") + representation(segment);
  const CrossSection& section = cilium.section;
  switch (section.shape) {
    case CrossSection::Shape::rectangle:
      return fmt::format(
          "Cilium.rectangle(width={:.6g}, height={:.6g}, segments=[{}], orientation={:.6g})",
          section.width, section.height, segments, section.orientation);
    case CrossSection::Shape::tube:
      return fmt::format("Cilium.tube(diameter={:.6g}, inner_diameter={:.6g}, segments=[{}])",
                         cilium.diameter, section.inner_diameter, segments);
    default:
      return fmt::format("Cilium(diameter={:.6g}, segments=[{}])", cilium.diameter, segments);
  }
}

Cilium valid(Cilium cilium) {
  require_valid(cilium);
  return cilium;
}

}  // namespace

void bind_problem(py::module_& module) {
  bind_magnets(module);
  py::class_<Segment> segment_class(
      module, "Segment",
      "A segment of a cilium: one material.\n\n"
      "length in m, young_modulus in Pa, poisson_ratio, magnetization M along the\n"
      "axis in A/m (M = B_r / mu_0; 0: not magnetic) or its three components, name\n"
      "for people, density in kg/m^3 (0: not known), which gravity needs.");
  segment_class
      .def(py::init([](const Number& length, const Number& young_modulus,
                       const Number& poisson_ratio, const Array& M, const Text& name,
                       const Number& density) {
             Segment segment;
             set_field(segment, "length", length);
             set_field(segment, "young_modulus", young_modulus);
             set_field(segment, "poisson_ratio", poisson_ratio);
             set_field(segment, "magnetization", M);
             set_field(segment, "name", name);
             set_field(segment, "density", density);
             return segment;
           }),
           py::arg("length"), py::arg("young_modulus"), py::arg("poisson_ratio") = 0.49,
           py::arg("magnetization") = 0.0, py::arg("name") = "", py::arg("density") = 0.0)
      .def(pickled<Segment>())
      .def("__repr__", [](const Segment& segment) { return representation(segment); });
  define_attributes(segment_class);

  py::class_<Cilium>(module, "Cilium",
                     "A straight cylinder of segments, from the base up. diameter in m.\n"
                     "Cilium.rectangle and Cilium.tube have other sections.\n\n"
                     "Raises InputError if a number is impossible.")
      .def(py::init([](const Number& diameter, const py::object& segments) {
             Cilium cilium{0, list_of<Segment>(segments, "segments")};
             set_field(cilium, "diameter", diameter);
             return valid(std::move(cilium));
           }),
           py::arg("diameter"), py::arg("segments"))
      .def_static(
          "rectangle",
          [](const Number& width, const Number& height, const py::object& segments,
             const Number& orientation) {
            Cilium cilium{0,
                          list_of<Segment>(segments, "segments"),
                          {.shape = CrossSection::Shape::rectangle}};
            set_field(cilium.section, "width", width);
            set_field(cilium.section, "height", height);
            set_field(cilium.section, "orientation", orientation);
            return valid(std::move(cilium));
          },
          "Of rectangular section: width along x and height along y, m, turned by orientation, "
          "rad.",
          py::arg("width"), py::arg("height"), py::arg("segments"), py::arg("orientation") = 0.0)
      .def_static(
          "tube",
          [](const Number& diameter, const Number& inner_diameter, const py::object& segments) {
            Cilium cilium{
                0, list_of<Segment>(segments, "segments"), {.shape = CrossSection::Shape::tube}};
            set_field(cilium, "diameter", diameter);
            set_field(cilium.section, "inner_diameter", inner_diameter);
            return valid(std::move(cilium));
          },
          "A tube: outer and inner diameter, m.", py::arg("diameter"), py::arg("inner_diameter"),
          py::arg("segments"))
      .def_readonly("diameter", &Cilium::diameter,
                    "Of the section, of a tube the outer one, m; 0 of a rectangle.")
      .def_property_readonly(
          "sides",
          [](const Cilium& cilium) -> std::optional<std::array<double, 2>> {
            if (!cilium.is_rectangular()) return std::nullopt;
            return std::array{cilium.section.width, cilium.section.height};
          },
          "Width and height of a rectangle, m; None of another section.")
      .def_property_readonly(
          "orientation", [](const Cilium& cilium) { return cilium.section.orientation; },
          "Turn of a rectangle about z, rad.")
      .def(
          "extent",
          [](const Cilium& cilium, const Number& azimuth) {
            return cilium.extent(number(azimuth, "azimuth", quantity::angle));
          },
          "Extent across the axis along an azimuth, m.", py::arg("azimuth") = 0.0)
      .def_property_readonly("segments", [](const Cilium& cilium) { return cilium.segments; })
      .def_property_readonly("length", &Cilium::length, "L, the sum of the lengths, m.")
      .def(pickled<Cilium>())
      .def("__repr__", [](const Cilium& cilium) { return representation(cilium); });

  py::class_<Environment> environment_class(
      module, "Environment",
      "What surrounds a cilium: gravity g [x, y, z] in m/s^2 (each segment needs a density),\n"
      "fluid_density in kg/m^3 for buoyancy, uniform_field B_0 [x, y, z] in T, by which\n"
      "magnetic_energy the field acts: 'F', -(F M).B_0, or 'R', -(R M).B_0, and magnets beside "
      "it.");
  environment_class
      .def(py::init(&environment), py::arg("gravity") = py::make_tuple(0.0, 0.0, 0.0),
           py::arg("fluid_density") = 0.0, py::arg("uniform_field") = py::make_tuple(0.0, 0.0, 0.0),
           py::arg("magnetic_energy") = "F", py::arg("magnets") = py::tuple())
      .def_readonly("magnets", &Environment::magnets)
      .def(
          "__eq__", [](const Environment& a, const Environment& b) { return a == b; },
          py::is_operator())
      .def(pickled<Environment>())
      .def("__repr__", [](const Environment& of) { return representation(of); });
  define_constants(environment_class);

  py::class_<Load>(module, "Load",
                   "A load by its type and parameters, in SI units:\n"
                   "Load('contact', force=1e-3, height=13e-3, azimuth=0). load_types() names all.")
      .def(py::init(&load), py::arg("type"))
      .def_property_readonly("type", [](const Load& of) { return std::string(of.type().name); })
      .def_property_readonly(
          "parameters",
          [](const Load& of) {
            py::dict result;
            for (std::size_t i = 0; i < of.values().size(); ++i)
              result[py::str(std::string(of.type().parameters[i].name))] = of.values()[i];
            for (const auto& setting : of.type().settings)
              if (setting.get(of) != setting.initial)
                result[py::str(std::string(setting.name))] = to_python(setting, setting.get(of));
            for (const auto& [name, stated] : tables_of(of)) result[name] = stated;
            return result;
          })
      .def_property_readonly(
          "magnitude", [](const Load& of) { return magnitude(of); },
          "What a load path varies: a contact's force, a flow's force per length, a probe's "
          "displacement.")
      .def_property_readonly(
          "unit", [](const Load& of) { return std::string(magnitude_unit(of)); }, "Of magnitude.")
      .def("changed", &changed,
           "The same load with other values of parameters, by name; `magnitude` is its own name of "
           "what\na path varies.")
      .def_property_readonly("environment", &Load::environment,
                             "What surrounds the cilium under this load, besides it.")
      .def(pickled<Load>())
      .def("__repr__", [](const Load& of) { return representation(of); });

  module.def("surrounded", &surrounded, py::arg("loads"), py::arg("environments"));

  module.attr("cylinder_reynolds_numbers") =
      py::make_tuple(cylinder_reynolds_numbers.lower, cylinder_reynolds_numbers.upper);
  module.def("cylinder_drag_coefficient", py::vectorize(&cylinder_drag_coefficient), py::arg("Re"),
             "C_d of a long cylinder across the flow at Reynolds numbers Re = v d/nu of 1e-4 to\n"
             "2e5, an array of any shape (Sucker and Brauer, 1975). InputError beyond.");

  module.def(
      "load_types",
      [] {
        py::dict result;
        for (const LoadType* type : load_types()) {
          py::dict parameters;
          for (const auto& parameter : type->parameters)
            parameters[py::str(std::string(parameter.name))] =
                fmt::format("{}{}{}", parameter.doc, parameter.quantity.unit.empty() ? "" : ", ",
                            parameter.quantity.unit);
          for (const auto& setting : type->settings)
            parameters[py::str(std::string(setting.name))] = std::string(setting.doc);
          for (const LoadTable& table : type->tables)
            for (const auto& key : table.keys)
              parameters[py::str(fmt::format("{}.{}", table.name, key.name))] =
                  std::string(key.doc);
          result[py::str(std::string(type->name))] = parameters;
        }
        return result;
      },
      "The load types: a dict of name to {parameter: meaning and unit}.");
}

}  // namespace ciliaval::python::core
