// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>

#include <string>

#include "problem/error.h"
#include "problem/surroundings/magnets/field.h"
#include "problem/surroundings/magnets/magnet.h"
#include "python/core/convert.h"

namespace ciliaval::python::core {
namespace {

namespace py = pybind11;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

/// M in the magnet's own axes: along the third, or three components.
Vector3 magnetization(const py::object& value) {
  if (py::isinstance<py::float_>(value) || py::isinstance<py::int_>(value))
    return value.cast<double>() * Vector3::UnitZ();
  return vector(value, "magnetization");
}

Magnet magnet(Shape shape, const std::string& name, const py::object& position, const py::object& M,
              const py::object& axis) {
  Magnet result;
  result.name = name;
  result.shape = shape;
  result.position = vector(position, "position");
  result.magnetization = magnetization(M);
  const Vector3 direction = vector(axis, "axis");
  if (direction.isZero(0)) throw InputError("the `axis` of a magnet must point somewhere");
  result.rotation = surroundings::magnets::turn_to(direction);
  return result;
}

Magnet valid(Magnet magnet) {
  require_valid(magnet);
  return magnet;
}

}  // namespace

void bind_magnets(py::module_& module) {
  const py::tuple up = py::make_tuple(0.0, 0.0, 1.0);
  py::class_<Magnet>(
      module, "Magnet",
      "A permanent magnet at rest beside the cilium: Magnet.ball, .cylinder or .cuboid.\n\n"
      "position of its centre in m, magnetization in A/m along its axis, or its three components\n"
      "in the magnet's own axes, whose third one is `axis`. Environment(magnets=[...]) has them.")
      .def_static(
          "ball",
          [](const py::object& position, double diameter, const py::object& M,
             const py::object& axis, const std::string& name) {
            Magnet result = magnet(Shape::ball, name, position, M, axis);
            result.diameter = diameter;
            return valid(result);
          },
          py::arg("position"), py::arg("diameter"), py::arg("magnetization"), py::arg("axis") = up,
          py::arg("name") = "magnet")
      .def_static(
          "cylinder",
          [](const py::object& position, double diameter, double length, const py::object& M,
             const py::object& axis, const std::string& name) {
            Magnet result = magnet(Shape::cylinder, name, position, M, axis);
            result.diameter = diameter;
            result.length = length;
            return valid(result);
          },
          "Magnetised along its axis.", py::arg("position"), py::arg("diameter"), py::arg("length"),
          py::arg("magnetization"), py::arg("axis") = up, py::arg("name") = "magnet")
      .def_static(
          "cuboid",
          [](const py::object& position, const py::object& edges, const py::object& M,
             const py::object& axis, const std::string& name) {
            Magnet result = magnet(Shape::cuboid, name, position, M, axis);
            result.edges = vector(edges, "edges");
            return valid(result);
          },
          "edges: its three lengths, m, the third along its axis.", py::arg("position"),
          py::arg("edges"), py::arg("magnetization"), py::arg("axis") = up,
          py::arg("name") = "magnet")
      .def_readonly("name", &Magnet::name)
      .def_property_readonly("position", [](const Magnet& of) { return array(of.position); })
      .def_property_readonly(
          "moment", [](const Magnet& of) { return array(surroundings::magnets::moment(of)); },
          "m, A m^2, (3,).")
      .def(
          "B",
          [](const Magnet& of, const py::object& at) {
            std::vector<Vector3> field;
            for (const Vector3& x : points(at)) field.push_back(jet(of, x).B);
            return array(field);
          },
          "Flux density at points (n, 3) in m outside of it, (n, 3), T.", py::arg("points"))
      .def("__eq__", [](const Magnet& a, const Magnet& b) { return a == b; })
      .def("__repr__", [](const Magnet& of) {
        return fmt::format("Magnet.{}(name='{}', position=[{:.6g}, {:.6g}, {:.6g}])",
                           surroundings::magnets::name(of.shape), of.name, of.position.x(),
                           of.position.y(), of.position.z());
      });
}

}  // namespace ciliaval::python::core
