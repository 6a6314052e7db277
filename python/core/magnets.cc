// SPDX-License-Identifier: LGPL-2.1-or-later
#include <fmt/format.h>

#include <string>

#include "problem/description/environment.h"
#include "problem/error.h"
#include "problem/surroundings/magnets/field.h"
#include "problem/surroundings/magnets/magnet.h"
#include "python/core/calls.h"
#include "python/core/convert.h"
#include "python/core/pickle.h"

namespace ciliaval::python::core {
namespace {

namespace py = pybind11;
using surroundings::magnets::Magnet;
using surroundings::magnets::Shape;

/// A magnet without its sizes; M in its own axes, along the third or three components.
Magnet magnet(Shape shape, const Text& name, const Array& position, const Array& M,
              const Array& axis) {
  Magnet result;
  result.shape = shape;
  set_field(result, "name", name);
  set_field(result, "position", position);
  set_field(result, "magnetization", M);
  set_field(result, "axis", axis);
  if (result.rotation.norm() == 0) throw InputError("the `axis` of a magnet must point somewhere");
  return result;
}

Magnet valid(Magnet magnet) {
  require_valid(magnet);
  return magnet;
}

py::object field_of_magnet(const Magnet& magnet, const Array& where) {
  const std::vector<Vector3> at = points(where);
  std::vector<Vector3> B(at.size());
  {
    const Call call;
    const py::gil_scoped_release released;
    for (std::size_t i = 0; i < at.size(); ++i) {
      support::check_interruption();
      B[i] = jet(magnet, at[i]).B;
    }
  }
  return array(B);
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
          [](const Array& position, const Number& diameter, const Array& M, const Array& axis,
             const Text& name) {
            Magnet result = magnet(Shape::ball, name, position, M, axis);
            set_field(result, "diameter", diameter);
            return valid(result);
          },
          py::arg("position"), py::arg("diameter"), py::arg("magnetization"), py::arg("axis") = up,
          py::arg("name") = "magnet")
      .def_static(
          "cylinder",
          [](const Array& position, const Number& diameter, const Number& length, const Array& M,
             const Array& axis, const Text& name) {
            Magnet result = magnet(Shape::cylinder, name, position, M, axis);
            set_field(result, "diameter", diameter);
            set_field(result, "length", length);
            return valid(result);
          },
          "Magnetised along its axis.", py::arg("position"), py::arg("diameter"), py::arg("length"),
          py::arg("magnetization"), py::arg("axis") = up, py::arg("name") = "magnet")
      .def_static(
          "cuboid",
          [](const Array& position, const Array& edges, const Array& M, const Array& axis,
             const Text& name) {
            Magnet result = magnet(Shape::cuboid, name, position, M, axis);
            set_field(result, "edges", edges);
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
      .def("B", &field_of_magnet, "Flux density at points (n, 3) in m outside of it, (n, 3), T.",
           py::arg("points"))
      .def(pickled<Magnet>())
      .def(
          "__eq__", [](const Magnet& a, const Magnet& b) { return a == b; }, py::is_operator())
      .def("__repr__", [](const Magnet& of) {
        return fmt::format("Magnet.{}(name='{}', position=[{:.6g}, {:.6g}, {:.6g}])",
                           surroundings::magnets::name(of.shape), of.name, of.position.x(),
                           of.position.y(), of.position.z());
      });
}

}  // namespace ciliaval::python::core
