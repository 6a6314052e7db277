// SPDX-License-Identifier: LGPL-2.1-or-later
// What must hold between the tables of a case file.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <system_error>

#include "compare/input/case_sections.h"
#include "fem/solid/material/hyperelastic.h"

namespace ciliaval::compare::input {
namespace {

constexpr double longest_cilium = 100;  ///< m
constexpr double most_slender = 1e5;    ///< length over diameter: bounds the graded quadratures
constexpr std::size_t most_rows =
    200000;  ///< of results; a row takes about 3 kB of memory in a run

bool asks_for(const std::vector<std::string>& ids, std::string_view id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

/// Where the value of a dotted path stands; of a path that is not in the file, its table.
Place place_of(const toml::table& root, std::string path) {
  while (!path.empty()) {
    if (const toml::node* node = root.at_path(path).node()) return place(*node);
    const std::size_t end = path.find_last_of(".[");
    path.resize(end == std::string::npos ? 0 : end);
  }
  return {};
}

/// Where the value of a load's key for one step stands.
Place place_of_step(const toml::table& root, std::string_view key, std::size_t step) {
  return place_of(root, fmt::format("load.{}[{}]", key, step));
}

/// Where a list of ids names one of them.
Place place_of_id(const toml::table& root, std::string_view list, std::string_view id) {
  const toml::node_view<const toml::node> ids = root.at_path(fmt::format("models.{}", list));
  if (const toml::array* array = ids.as_array())
    for (const toml::node& element : *array)
      if (element.value<std::string_view>() == id) return place(element);
  return place_of(root, fmt::format("models.{}", list));
}

/// Whether a step is the first one with this place: one value that stands for all steps is told
/// once.
bool is_told_first(const toml::table& root, std::string_view key, std::size_t step) {
  return step == 0 || root.at_path(fmt::format("load.{}", key)).is_array();
}

void check_contact(const toml::table& root, const Case& c, Faults& faults) {
  const double length = c.cilium.length();
  const double w = c.options.solid.kernel_width;
  for (std::size_t i = 0; i < c.load_path.size(); ++i) {
    const std::optional<double> height = contact_height(c.load_path[i]);
    if (!height || !is_told_first(root, "height", i)) continue;
    const double h = *height;
    const Place where = place_of_step(root, "height", i);
    if (!(h > 0 && h < length)) {
      faults.add(where, fmt::format("the contact height {:g} m must lie between the base and the "
                                    "tip of the cilium, which is {:g} m high",
                                    h, length));
    } else if (asks_for(c.mechanics, "solid") && !(h - w > 0 && h + w < length)) {
      faults.add(where,
                 fmt::format("the solid's contact kernel, {:g} m below and above the contact "
                             "height {:g} m, must lie between the base and the tip at {:g} m: move "
                             "the contact or set a smaller 'kernel_width' in [models.solid]",
                             w, h, length));
    }
  }
}

/// The mesh itself is checked when it is read: here, that there is one.
void check_mesh(const toml::table& root, const Case& c, Faults& faults) {
  const std::filesystem::path& mesh = c.options.solid.mesh;
  std::error_code error;
  if (!mesh.empty() && !std::filesystem::is_regular_file(mesh, error))
    faults.add(place_of(root, "models.solid.mesh"),
               fmt::format("there is no mesh file '{}': a name without a leading / is looked for "
                           "beside the case file",
                           mesh.string()));
}

void check_section(const toml::table& root, const Case& c, Faults& faults) {
  for (std::size_t i = 0; i < c.load_path.size(); ++i) {
    const std::optional<double> arclength = loaded_arclength(c.load_path[i]);
    if (!arclength || !is_told_first(root, "arclength", i)) continue;
    if (*arclength > c.cilium.length())
      faults.add(
          place_of_step(root, "arclength", i),
          fmt::format("the loaded section at arc length {:g} m lies beyond the tip at {:g} m",
                      *arclength, c.cilium.length()));
  }
}

void check_elastica_form(const toml::table& root, const Case& c, Faults& faults) {
  if (c.options.elastica.form != analytic::elastica::ElasticaOptions::Form::height ||
      !asks_for(c.mechanics, "elastica") || c.load_path.empty())
    return;
  const Load& load = c.load_path.front();
  if (load.is<ContactLoad>() || load.is<FlowLoad>() || load.is<ProbeLoad>()) return;
  faults.add(place_of(root, "models.elastica.form"),
             fmt::format("the elastica's form 'height' (Eq. 1-4) takes the load types "
                         "'contact', 'flow' and 'probe', not '{}': use the form 'arclength'",
                         type(load)));
}

void check_calculix(const toml::table& root, const Case& c, bool load_is_right, Faults& faults) {
  if (!c.options.calculix.program.has_filename())
    faults.add(place_of(root, "models.calculix.program"),
               "'program' must name a program, such as \"ccx\"");
  if (!asks_for(c.mechanics, "calculix") || !load_is_right || c.load_path.empty()) return;
  const Load& load = c.load_path.front();
  if (load.is<SectionLoad>() || load.is<DeadLoad>()) return;
  faults.add(place_of_id(root, "mechanics", "calculix"),
             fmt::format("CalculiX takes the load types 'section' and 'dead', not '{}', which "
                         "follows the current height: leave out 'calculix', or state the load as "
                         "one of those",
                         type(load)));
}

void check_fields(const toml::table& root, const Case& c, bool cilium_is_right, Faults& faults) {
  if (c.fields.empty()) return;
  if (root.get("sensor") == nullptr)
    faults.add(place_of(root, "models.fields"),
               "'fields' need a place: add [sensor] with 'position'");
  const bool magnetic = std::any_of(c.cilium.segments.begin(), c.cilium.segments.end(),
                                    [](const Segment& s) { return s.magnetization != 0; });
  if (cilium_is_right && !magnetic)
    faults.add(place_of(root, "models.fields"),
               "'fields' need a magnet: no [[cilium.segment]] has a 'magnetization'");
  if (asks_for(c.fields, "mesh") && !asks_for(c.mechanics, "solid") &&
      !asks_for(c.mechanics, "calculix"))
    faults.add(place_of_id(root, "fields", "mesh"),
               "the field model 'mesh' is that of a solid's own magnet: add 'solid' to "
               "'mechanics'");
}

std::size_t pairs(std::size_t n) {
  return n * (n - 1) / 2;  // none of 0
}

void check_material(const toml::table& root, const Case& c, Faults& faults) {
  const auto [ratio_2, ratio_3] = c.options.solid.yeoh_ratios;
  if (fem::solid::material::yeoh_is_stable(ratio_2, ratio_3)) return;
  faults.add(place_of(root, "models.solid.yeoh_ratios"),
             fmt::format("a Yeoh solid with C20/C10 = {:g} and C30/C10 = {:g} is unstable: from "
                         "some shear on its shear stress falls; {}",
                         ratio_2, ratio_3,
                         ratio_3 < 0 ? "C30/C10 must not be negative"
                                     : fmt::format("C30/C10 must be above 3/5 (C20/C10)² = {:g}",
                                                   0.6 * ratio_2 * ratio_2)));
}

/// The figures of a run: B and ΔB of each field run at each sensor, straight and at each step, and
/// the comparisons of each pair of runs (compare/models/errors.h): of mechanics five a step, of
/// fields six components at each sensor a step and over the path.
void check_size(const toml::table& root, const Case& c, Faults& faults) {
  const std::size_t steps = c.load_path.size();
  const std::size_t sensors = c.sensors.size();
  const std::size_t mesh_fields = asks_for(c.fields, "mesh") ? 1 : 0;
  std::size_t bodies = 0;
  std::size_t mechanics = c.mechanics.size();
  std::size_t readings = 0;
  for (const external::ExternalModel& model : c.external) {
    if (!model.centreline_files.empty()) ++mechanics;
    if (!model.readings_file.empty()) ++readings;
  }
  for (const std::string_view id : {"calculix", "solid"}) bodies += asks_for(c.mechanics, id);
  const std::size_t runs =
      (c.fields.size() - mesh_fields) * mechanics + mesh_fields * bodies + readings;
  const std::size_t rows =
      5 * pairs(mechanics) * steps + (runs + 6 * pairs(runs)) * sensors * (steps + 1);
  if (rows > most_rows)
    faults.add(place_of(root, "sensor.position"),
               fmt::format("{} sensor points, {} steps and {} pairs of mechanics and field model "
                           "with {} comparisons among them make {} rows of results, more than {}: "
                           "list fewer points, steps or models",
                           sensors, steps, runs, pairs(runs), rows, most_rows));
}

}  // namespace

void check_together(const toml::table& root, const Case& c, const RightTables& right,
                    Faults& faults) {
  if (right.cilium && c.cilium.length() > longest_cilium)
    faults.add(place_of(root, "cilium.segment"),
               fmt::format("the segments are {:g} m long together; more than {:g} m is taken for a "
                           "slip in the unit",
                           c.cilium.length(), longest_cilium));
  else if (right.cilium && c.cilium.length() > most_slender * c.cilium.diameter)
    faults.add(place_of(root, "cilium.diameter"),
               fmt::format("the cilium is {:g} diameters long; more than {:g} is taken for a slip "
                           "in the unit",
                           c.cilium.length() / c.cilium.diameter, most_slender));
  if (right.cilium && right.load && right.models) check_contact(root, c, faults);
  if (right.cilium && right.load) check_section(root, c, faults);
  if (right.load && right.models) check_elastica_form(root, c, faults);
  if (right.models) check_calculix(root, c, right.load, faults);
  if (right.load && right.models) check_external(root, c, faults);
  if (right.models) check_material(root, c, faults);
  if (right.models) check_mesh(root, c, faults);
  if (right.models) check_fields(root, c, right.cilium, faults);
  if (right.load && right.models) check_size(root, c, faults);
}

}  // namespace ciliaval::compare::input
