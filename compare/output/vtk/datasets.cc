// SPDX-License-Identifier: LGPL-2.1-or-later
#include "compare/output/vtk/datasets.h"

#include <vtkBiQuadraticQuad.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkTriQuadraticHexahedron.h>
#include <vtkUnsignedCharArray.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "compare/output/results.h"
#include "compare/output/vtk/files.h"
#include "compare/results/band.h"
#include "meshes/boundary_ids.h"
#include "problem/cilium.h"

namespace ciliaval::compare::output::vtk {
namespace {

/// The components of a symmetric tensor in VTK's order.
constexpr std::array<std::pair<vtkIdType, const char*>, 6> tensor_components{
    {{0, "XX"}, {1, "YY"}, {2, "ZZ"}, {3, "XY"}, {4, "YZ"}, {5, "XZ"}}};

/// A named array that grows tuple by tuple; its unit goes to the data set's field data.
class Column {
 public:
  Column(const char* name, int components, const char* unit) : unit_(unit) {
    array_->SetName(name);
    array_->SetNumberOfComponents(components);
    if (components == 6)  // add_symmetric()
      for (const auto& [index, component] : tensor_components)
        array_->SetComponentName(index, component);
  }
  Column(const std::string& name, int components, const char* unit)
      : Column(name.c_str(), components, unit) {}

  void add(double value) { array_->InsertNextValue(value); }
  void add(const Vector3& v) { array_->InsertNextTuple(v.data()); }
  void add_symmetric(const Matrix3& s) {
    const std::array<double, 6> voigt{s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(1, 2), s(0, 2)};
    array_->InsertNextTuple(voigt.data());
  }

  void attach(vtkDataSet& data) const {
    data.GetPointData()->AddArray(array_);
    vtkFieldData* fields = data.GetFieldData();
    auto* units = vtkStringArray::SafeDownCast(fields->GetAbstractArray("units"));
    if (units == nullptr) {
      vtkNew<vtkStringArray> made;
      made->SetName("units");
      fields->AddArray(made);
      units = made;
    }
    units->InsertNextValue(std::string(array_->GetName()) + ": " + unit_);
  }

 private:
  vtkNew<vtkDoubleArray> array_;
  std::string unit_;
};

vtkNew<vtkPoints> double_points() {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  return points;
}

vtkNew<vtkUnsignedCharArray> mask(const std::string& name) {
  vtkNew<vtkUnsignedCharArray> array;
  array->SetName(name.c_str());
  return array;
}

/// A field (T) and its mask: 0 where there is no value, which is then written as zero.
void attach_masked(vtkDataSet& data, const std::string& name, const models::AtSensors& values) {
  Column column(name, 3, "T");
  const vtkNew<vtkUnsignedCharArray> valid = mask("valid_" + name);
  for (const std::optional<Vector3>& value : values) {
    column.add(value.value_or(Vector3::Zero()));
    valid->InsertNextValue(value ? 1 : 0);
  }
  column.attach(data);
  data.GetPointData()->AddArray(valid);
}

/// Points with one vertex cell each.
vtkSmartPointer<vtkPolyData> vertices(const std::vector<Vector3>& positions) {
  const vtkNew<vtkPoints> points = double_points();
  const vtkNew<vtkCellArray> cells;
  for (const Vector3& x : positions) {
    const vtkIdType id = points->InsertNextPoint(x.data());
    cells->InsertNextCell(1, &id);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(cells);
  return data;
}

/// A linear combination of what is given at the nodes of a cell, without the nodes that have no
/// part in it: where a point is itself a node, that is most of them.
class Combination {
 public:
  void add(std::size_t node, double weight) {
    if (weight != 0) parts_.emplace_back(node, weight);
  }
  template <class Nodal, class T>
  T of(const Nodal& nodal, T sum) const {
    for (const auto& [node, weight] : parts_) sum += weight * nodal[node];
    return sum;
  }
  Vector3 of(const std::vector<Vector3>& nodal) const { return of(nodal, Vector3(0, 0, 0)); }

 private:
  std::vector<std::pair<std::size_t, double>> parts_;
};

/// Value and derivatives by ξ, η, ζ at a point of the unit cell.
struct PointOfCell {
  Vector3 position;
  Combination value;
  std::array<Combination, 3> slope;

  PointOfCell(const LagrangeBasis& nodes, const Vector3& xi) : position(xi) {
    const std::size_t n = nodes.size();
    std::array<std::vector<double>, 3> N;
    std::array<std::vector<double>, 3> dN;
    for (std::size_t d = 0; d < 3; ++d) {
      N[d].resize(n);
      dN[d].resize(n);
      nodes.values_and_derivatives(xi[static_cast<Eigen::Index>(d)], N[d], dN[d]);
    }
    std::size_t node = 0;
    for (std::size_t k = 0; k < n; ++k)
      for (std::size_t j = 0; j < n; ++j)
        for (std::size_t i = 0; i < n; ++i, ++node) {
          value.add(node, N[0][i] * N[1][j] * N[2][k]);
          slope[0].add(node, dN[0][i] * N[1][j] * N[2][k]);
          slope[1].add(node, N[0][i] * dN[1][j] * N[2][k]);
          slope[2].add(node, N[0][i] * N[1][j] * dN[2][k]);
        }
  }

  /// ∂v/∂ξ: column d is the derivative by ξ_d.
  Matrix3 gradient(const std::vector<Vector3>& nodal) const {
    Matrix3 result;
    for (std::size_t d = 0; d < 3; ++d)
      result.col(static_cast<Eigen::Index>(d)) = slope[d].of(nodal);
    return result;
  }
};

/// Triquadratic hexahedra on 27 points each of their own.
class Hexahedra {
 public:
  /// Cells with Lagrange nodes, which take the points in VTK's order.
  explicit Hexahedra(const LagrangeBasis& nodes) {
    const vtkNew<vtkTriQuadraticHexahedron> hexahedron;
    const double* coordinates = hexahedron->GetParametricCoords();
    for (int i = 0; i < hexahedron->GetNumberOfPoints(); ++i)
      points_of_cell_.emplace_back(nodes, Vector3(coordinates + std::ptrdiff_t{3} * i));
    grid_->SetPoints(points_);
  }
  /// Adds a cell; `place` gives the position of each of its points.
  template <class Place>
  void add(const Place& place) {
    std::vector<vtkIdType> ids;
    for (const PointOfCell& at : points_of_cell_)
      ids.push_back(points_->InsertNextPoint(place(at).data()));
    grid_->InsertNextCell(VTK_TRIQUADRATIC_HEXAHEDRON, static_cast<vtkIdType>(ids.size()),
                          ids.data());
  }
  vtkSmartPointer<vtkUnstructuredGrid> grid() const { return grid_; }

 private:
  std::vector<PointOfCell> points_of_cell_;
  vtkNew<vtkPoints> points_ = double_points();
  vtkSmartPointer<vtkUnstructuredGrid> grid_ = vtkSmartPointer<vtkUnstructuredGrid>::New();
};

/// The lexicographic number of each of a cell's n points in VTK's order.
template <std::size_t n>
std::array<std::size_t, n> lexicographic_order(vtkCell& cell) {
  const double* coordinates = cell.GetParametricCoords();
  std::array<std::size_t, n> order{};
  for (std::size_t i = 0; i < n; ++i)
    order[i] = static_cast<std::size_t>(std::lround(2 * coordinates[3 * i]) +
                                        3 * std::lround(2 * coordinates[3 * i + 1]) +
                                        9 * std::lround(2 * coordinates[3 * i + 2]));
  return order;
}

template <std::size_t n>
void add_mesh_cell(vtkUnstructuredGrid& grid, int type, const std::array<std::size_t, n>& nodes,
                   const std::array<std::size_t, n>& order) {
  std::array<vtkIdType, n> ids{};
  for (std::size_t i = 0; i < n; ++i) ids[i] = static_cast<vtkIdType>(nodes[order[i]]);
  grid.InsertNextCell(type, static_cast<vtkIdType>(n), ids.data());
}

}  // namespace

vtkSmartPointer<vtkUnstructuredGrid> solid_grid(const SolidBody& body) {
  Hexahedra hexahedra(body.nodes);
  Column displacement("displacement", 3, "m");
  Column jacobian("J", 1, "1");
  Column stress("cauchy_stress", 6, "Pa");
  Column magnetization("magnetization", 3, "A/m");
  const vtkNew<vtkIntArray> material;
  material->SetName("MaterialIDs");
  bool with_jacobian = true;
  bool with_stress = true;
  for (const SolidCell& cell : body.cells) {
    with_jacobian = with_jacobian && !cell.jacobian.empty();
    with_stress = with_stress && !cell.cauchy_stress.empty();
  }
  for (const SolidCell& cell : body.cells) {
    hexahedra.add([&](const PointOfCell& at) {
      Vector3 X = at.value.of(cell.reference);
      const Matrix3 F = at.gradient(cell.current) * at.gradient(cell.reference).inverse();
      displacement.add(Vector3(at.value.of(cell.current) - X));
      magnetization.add(Vector3(F * cell.magnetization / F.determinant()));
      if (with_jacobian) jacobian.add(at.value.of(cell.jacobian, 0.0));
      if (with_stress)
        stress.add_symmetric(at.value.of(cell.cauchy_stress, Matrix3(Matrix3::Zero())));
      return X;
    });
    material->InsertNextValue(static_cast<int>(cell.segment));
  }
  auto grid = hexahedra.grid();
  grid->GetCellData()->AddArray(material);
  displacement.attach(*grid);
  if (with_jacobian) jacobian.attach(*grid);
  if (with_stress) stress.attach(*grid);
  magnetization.attach(*grid);
  return grid;
}

vtkSmartPointer<vtkUnstructuredGrid> octree_grid(const FieldMesh& mesh) {
  Hexahedra hexahedra(LagrangeBasis({0, 0.5, 1}));
  Column psi("psi", 1, "A");
  Column H("H", 3, "A/m");
  Column B("B", 3, "T");
  const vtkNew<vtkDoubleArray> permeability;
  permeability->SetName("relative_permeability");
  const vtkNew<vtkDoubleArray> magnetization;
  magnetization->SetName("magnetization");
  magnetization->SetNumberOfComponents(3);
  for (const FieldMesh::Leaf& leaf : mesh.leaves) {
    hexahedra.add([&](const PointOfCell& at) {
      Vector3 gradient;
      for (std::size_t d = 0; d < 3; ++d)
        gradient[static_cast<Eigen::Index>(d)] = at.slope[d].of(leaf.psi, 0.0) / leaf.size;
      psi.add(at.value.of(leaf.psi, 0.0));
      H.add(Vector3(-gradient));
      B.add(Vector3(vacuum_permeability *
                    (leaf.magnetization - leaf.relative_permeability * gradient)));
      return Vector3(leaf.lower + leaf.size * at.position);
    });
    permeability->InsertNextValue(leaf.relative_permeability);
    magnetization->InsertNextTuple(leaf.magnetization.data());
  }
  auto grid = hexahedra.grid();
  grid->GetCellData()->AddArray(permeability);
  grid->GetCellData()->AddArray(magnetization);
  for (const Column* column : {&psi, &H, &B}) column->attach(*grid);
  return grid;
}

vtkSmartPointer<vtkPolyData> rod_polyline(const Cilium& cilium, const Centreline& centreline) {
  const vtkNew<vtkPoints> points = double_points();
  const vtkNew<vtkCellArray> line;
  Column arclength("S", 1, "m");
  Column radius("radius", 1, "m");
  Column displacement("displacement", 3, "m");
  Column d1("d1", 3, "1");
  Column d2("d2", 3, "1");
  Column d3("d3", 3, "1");
  Column theta("theta", 1, "rad");
  Column kappa("kappa", 1, "1/m");
  Column curvature("curvature", 3, "1/m");
  Column force("section_force", 3, "N");
  Column moment("section_moment", 3, "N m");
  const vtkNew<vtkIntArray> segment;
  segment->SetName("segment");
  const std::vector<double> material_points = output_points(centreline);
  line->InsertNextCell(static_cast<int>(material_points.size()));
  for (const double S : material_points) {
    const CentrelinePoint p = centreline.at(S);
    line->InsertCellPoint(points->InsertNextPoint(p.position.data()));
    arclength.add(S);
    radius.add(cilium.is_rectangular() ? cilium.thickness() / 2 : cilium.radius());
    displacement.add(Vector3(p.position - S * Vector3::UnitZ()));
    d1.add(Vector3(p.rotation * Vector3::UnitX()));
    d2.add(Vector3(p.rotation * Vector3::UnitY()));
    d3.add(p.normal());
    theta.add(p.theta());
    kappa.add(p.bending_curvature());
    curvature.add(p.curvature);
    force.add(p.forces.force);
    moment.add(p.forces.moment);
    segment->InsertNextValue(static_cast<int>(cilium.segment_at(S)));
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetLines(line);
  for (const Column* column : {&arclength, &radius, &displacement, &d1, &d2, &d3, &theta, &kappa,
                               &curvature, &force, &moment})
    column->attach(*data);
  data->GetPointData()->AddArray(segment);
  return data;
}

vtkSmartPointer<vtkPolyData> dipoles(const Cilium& cilium, const Centreline& centreline,
                                     analytic::sources::PushForward push_forward) {
  constexpr int slices = 64;
  const std::vector<double> ends = cilium.interfaces();
  std::vector<Vector3> positions;
  Column moment("moment", 3, "A m^2");
  for (std::size_t i = 0; i < cilium.segments.size(); ++i) {
    const Vector3 M = magnetization(cilium.segments[i]);
    if (M.isZero(0)) continue;
    const double dS = (ends[i + 1] - ends[i]) / slices;
    for (int k = 0; k < slices; ++k) {
      const double S = ends[i] + k * dS;
      const CentrelinePoint middle = centreline.at(S + dS / 2);
      positions.push_back(middle.position);
      const Vector3 axis = push_forward == analytic::sources::PushForward::F
                               ? Vector3(centreline.at(S + dS).position - centreline.at(S).position)
                               : Vector3(middle.normal() * dS);
      moment.add(Vector3(cilium.area() *
                         (middle.rotation * Vector3(M.x(), M.y(), 0) * dS + M.z() * axis)));
    }
  }
  auto data = vertices(positions);
  moment.attach(*data);
  return data;
}

vtkSmartPointer<vtkPolyData> sensors(const models::CaseResult& result, std::size_t step) {
  auto data = vertices(result.problem.sensors);
  for (const models::FieldRun& run : result.fields) {
    if (!run.steps[step] || !run.steps[step]->any()) continue;
    const std::string pair = run.mechanics + "_" + run.field;
    attach_masked(*data, "B_" + pair, run.steps[step]->B);
    attach_masked(*data, "dB_" + pair, run.steps[step]->dB);
    if (!run.steps[step]->dB_model_part.empty())
      attach_masked(*data, "band_dB_" + pair, results::field_bands(result, run, step, true).total);
  }
  return data;
}

vtkSmartPointer<vtkPolyData> surface_mesh(const Load& load, const Cilium& cilium) {
  constexpr int count = 1001;
  const auto sweep = load.as<SweepLoad>().value();
  const surroundings::Surface& surface = *load.surface();
  const Vector3 e = direction(load);
  const Vector3 across = cilium.radius() * 3 * Vector3::UnitZ().cross(e);
  const double length = cilium.length();
  double first = -length;
  double last = 1.5 * length;
  if (const auto* profile = std::get_if<surroundings::SampledProfile>(&surface.profile)) {
    first = std::clamp(first, profile->first() + sweep.travel, profile->last() + sweep.travel);
    last = std::clamp(last, first, profile->last() + sweep.travel);
  }
  const vtkNew<vtkPoints> points = double_points();
  const vtkNew<vtkCellArray> cells;
  Column height("height", 1, "m");
  for (int i = 0; i < count; ++i) {
    const double x = std::lerp(first, last, static_cast<double>(i) / (count - 1));
    const double p = surface.extended(x - sweep.travel).height;
    const Vector3 middle = x * e + (length - sweep.interference - p) * Vector3::UnitZ();
    for (const double side : {-1.0, 1.0}) {
      points->InsertNextPoint(Vector3(middle + side * across).data());
      height.add(p);
    }
    const vtkIdType last_point = points->GetNumberOfPoints() - 1;
    const std::array<vtkIdType, 4> corners{last_point - 3, last_point - 2, last_point,
                                           last_point - 1};
    if (i > 0) cells->InsertNextCell(4, corners.data());
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  height.attach(*data);
  return data;
}

vtkSmartPointer<vtkPolyData> contact_point(const Load& load, const SurfaceContact& contact) {
  const auto sweep = load.as<SweepLoad>().value();
  const Vector3 e = direction(load);
  const double slope = load.surface()->extended(contact.point.dot(e) - sweep.travel).slope;
  const Vector3 tangent = Vector3(e - slope * Vector3::UnitZ()).normalized();
  const Vector3 normal = Vector3(-slope * e - Vector3::UnitZ()).normalized();
  auto data = vertices({contact.point});
  Column force("force", 3, "N");
  Column normal_force("normal_force", 1, "N");
  Column friction_force("friction_force", 1, "N");
  force.add(Vector3(contact.normal_force * normal + contact.friction_force * tangent));
  normal_force.add(contact.normal_force);
  friction_force.add(contact.friction_force);
  for (const Column* column : {&force, &normal_force, &friction_force}) column->attach(*data);
  return data;
}

vtkSmartPointer<vtkImageData> field_image(const FieldGrid& grid, const FieldGrid::Step& step) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(grid.points.data());
  image->SetOrigin(grid.origin.x(), grid.origin.y(), grid.origin.z());
  image->SetSpacing(grid.spacing.x(), grid.spacing.y(), grid.spacing.z());
  Column B("B", 3, "T");
  for (const Vector3& value : step.B) B.add(value);
  B.attach(*image);
  const vtkNew<vtkUnsignedCharArray> valid = mask("valid");
  for (const std::uint8_t flag : step.valid) valid->InsertNextValue(flag);
  image->GetPointData()->AddArray(valid);
  return image;
}

vtkSmartPointer<vtkUnstructuredGrid> mesh_grid(const meshes::MeshNodes& mesh,
                                               const Cilium& cilium) {
  const vtkNew<vtkPoints> points = double_points();
  for (const auto& x : mesh.nodes) points->InsertNextPoint(x[0], x[1], x[2]);
  const vtkNew<vtkIntArray> materials;
  materials->SetName("MaterialIDs");
  const vtkNew<vtkIntArray> boundaries;
  boundaries->SetName("BoundaryIDs");
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->SetPoints(points);
  const vtkNew<vtkTriQuadraticHexahedron> hexahedron;
  const auto volume_order = lexicographic_order<27>(*hexahedron);
  for (const auto& cell : mesh.cells) {
    add_mesh_cell(*grid, VTK_TRIQUADRATIC_HEXAHEDRON, cell.nodes, volume_order);
    materials->InsertNextValue(static_cast<int>(cell.material));
    boundaries->InsertNextValue(-1);
  }
  const vtkNew<vtkBiQuadraticQuad> quadrilateral;
  const auto face_order = lexicographic_order<9>(*quadrilateral);
  for (const auto& face : mesh.faces) {
    add_mesh_cell(*grid, VTK_BIQUADRATIC_QUAD, face.nodes, face_order);
    materials->InsertNextValue(-1);
    boundaries->InsertNextValue(static_cast<int>(face.boundary));
  }
  grid->GetCellData()->AddArray(materials);
  grid->GetCellData()->AddArray(boundaries);
  std::vector<std::string> names;
  for (const Segment& segment : cilium.segments) names.push_back(segment.name);
  add_strings(*grid, "materials", names);
  add_strings(*grid, "boundaries", meshes::boundary_names);
  add_strings(*grid, "units", {"points: m"});
  return grid;
}

}  // namespace ciliaval::compare::output::vtk
