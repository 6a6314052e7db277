// SPDX-License-Identifier: LGPL-2.1-or-later
// Makes problem/joints/table.cc, on standard output:
//   cmake --build build/release --target joint_table && build/release/tools/joint_table > table.cc
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <string>
#include <vector>

#include "problem/joints/joints.h"
#include "problem/joints/table.h"
#include "tools/end_problem/excess.h"

namespace {

namespace problem = ciliaval::joints;
using ciliaval::tools::end_problem::Bar;
using ciliaval::tools::end_problem::Base;
using ciliaval::tools::end_problem::Excess;
using ciliaval::tools::end_problem::excess;
using problem::Entry;

constexpr double EA = std::numbers::pi / 4;
constexpr double EI = EA / 16;
constexpr double far = 2;  // diameters, to the ends of a long segment

Entry entry(const Excess& e) {
  return {e.rotation * EI, e.coupling * EI, e.displacement * EI, e.extension * EA};
}

Entry difference(const Entry& a, const Entry& b) {
  Entry result = a;
  for (const auto c : problem::components) result.*c -= b.*c;
  return result;
}

/// The same with M at a place `up` above, where it is less by `up` Q.
Entry moved(Entry e, double up) {
  e.displacement += 2 * up * e.coupling + up * up * e.rotation;
  e.coupling += up * e.rotation;
  return e;
}

Entry joint(double soft, double stiff, double t) {
  if (t > 0) return entry(excess({{far, 1, soft}, {far, 1 / t, stiff}}, Base::free, far));
  Entry mirrored = entry(excess({{far, 1, soft}}, Base::clamped, 0));
  mirrored.coupling = -mirrored.coupling;
  return mirrored;
}

Entry clamp(double poisson) {
  Entry mirrored = joint(poisson, poisson, 0);
  mirrored.coupling = -mirrored.coupling;
  return mirrored;
}

/// Segments of all lengths between a rigid body and a stiffer one, less their joints alone.
std::vector<Entry> segments_between(double poisson, double t) {
  // A rigid body above: the ratio of moduli that the direct solver still resolves.
  t = std::max(t, 1e-4);
  const Entry below = clamp(poisson);
  const Entry above = joint(poisson, poisson, t);
  std::vector<Entry> result;
  for (const double length : problem::length_nodes()) {
    const Entry all =
        entry(excess({{length, 1, poisson}, {far, 1 / t, poisson}}, Base::clamped, length / 2));
    result.push_back(
        difference(difference(all, moved(below, length / 2)), moved(above, -length / 2)));
  }
  return result;
}

std::string text(const Entry& e) {
  return fmt::format("{{{:.5e}, {:.5e}, {:.5e}, {:.5e}}}", e.rotation, e.coupling, e.displacement,
                     e.extension);
}

/// The last index of the array, and the braces of the one before it.
void print_row(const std::vector<Entry>& row, bool first, bool last) {
  for (std::size_t i = 0; i < row.size(); ++i)
    fmt::print("{}{}{}\n", i > 0 ? "" : (first ? "{{" : "{"), text(row[i]),
               i + 1 < row.size() ? "," : (last ? "}}," : "},"));
}

void tell(std::size_t done, std::size_t all) {
  fmt::print(stderr, "\r{} of {}", done, all);
  if (done == all) fmt::print(stderr, "\n");
}

}  // namespace

int main() {
  using namespace problem;
  std::size_t done = 0;
  const std::size_t all = n_poisson * n_poisson * n_ratio + n_poisson * n_ratio * n_length;
  fmt::print(
      "// SPDX-License-Identifier: LGPL-2.1-or-later\n"
      "// Made by tools/end_problem/make_table.cc; not to be edited.\n"
      "// clang-format off\n"
      "#include \"problem/joints/table.h\"\n\n"
      "namespace ciliaval::joints {{\n\n"
      "const Entry alone[n_poisson][n_poisson][n_ratio] = {{\n");
  const std::vector<double> poisson = poisson_nodes();
  const std::vector<double> ratios = ratio_nodes();
  for (const double soft : poisson)
    for (const double stiff : poisson) {
      std::vector<Entry> row;
      for (const double t : ratios) row.push_back(joint(soft, stiff, t));
      print_row(row, stiff == poisson.front(), stiff == poisson.back());
      tell(done += n_ratio, all);
    }
  fmt::print("}};\n\nconst Entry together[n_poisson][n_ratio][n_length] = {{\n");
  for (const double nu : poisson)
    for (const double t : ratios) {
      print_row(segments_between(nu, t), t == ratios.front(), t == ratios.back());
      tell(done += n_length, all);
    }
  fmt::print("}};\n\n}}  // namespace ciliaval::joints\n");
}
