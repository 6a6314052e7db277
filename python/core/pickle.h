// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace ciliaval::python::core {

/// The value as bytes that this build of the program reads again: of Segment, Cilium, Load,
/// Environment, Magnet and MechanicsResult.
template <class T>
pybind11::bytes packed(const T& value);
template <class T>
T unpacked(const pybind11::bytes& bytes);

/// "ciliaval 0.1.0 …": what a pickle is good for.
std::string build();
/// Throws InputError if the pickle is of another build.
void require_own_build(const std::string& other);

/// Makes a bound class of one of these types one that pickle and copy take.
template <class T>
auto pickled() {
  namespace py = pybind11;
  return py::pickle([](const T& value) { return py::make_tuple(build(), packed(value)); },
                    [](const py::tuple& state) {
                      require_own_build(state[0].cast<std::string>());
                      return unpacked<T>(state[1].cast<py::bytes>());
                    });
}

}  // namespace ciliaval::python::core
