// SPDX-License-Identifier: LGPL-2.1-or-later
#include "fem/calculix/calculix_model.h"

#include <unistd.h>

#include <deal.II/base/mpi.h>
#include <deal.II/base/quadrature_lib.h>
#include <deal.II/fe/fe_values.h>

#include <Eigen/LU>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "fem/calculix/calculix.h"
#include "fem/parallel.h"
#include "fem/solid/postprocessing/body.h"
#include "fem/solid/postprocessing/centreline.h"
#include "fem/solid/solid.h"
#include "meshes/cylinder/cylinder_mesh.h"
#include "problem/error.h"
#include "problem/support/child_process.h"
#include "problem/support/interruption.h"

namespace ciliaval::fem::calculix {
namespace {

using namespace solid::discretisation;
using namespace solid::loads;
using namespace solid::material;
using namespace solid::postprocessing;

namespace fs = std::filesystem;

constexpr const char* job = "cilium";  ///< name of CalculiX's files

/// The lowest order seen of C3D20R's tip in the thickness of the finest layer
/// (docs/guide/referees.md): the estimate errs to the safe side where the mesh converges faster.
constexpr double tip_order = 0.7;

std::vector<Hyperelastic> materials(const Cilium& cilium) {
  std::vector<Hyperelastic> result;
  for (const Segment& segment : cilium.segments)
    result.push_back(Hyperelastic::neo_hooke(segment.shear_modulus(), segment.bulk_modulus()));
  return result;
}

/// One mesh, as CalculiX gets it and as the solid's extraction reads its displacements.
class CalculixMesh {
 public:
  CalculixMesh(const Cilium& cilium, const LoadPath& path, unsigned int level) {
    meshes::cylinder::CylinderMeshOptions mesh = solid::level_mesh(level);
    mesh.half = true;
    for (const Load& load : path)
      if (const auto section = load.as<SectionLoad>()) mesh.planes.push_back(section->arclength);
    finest_layer_ = mesh.finest_layer;
    meshes::cylinder::make_cylinder(turned(cilium, path.empty() ? 0 : -azimuth(path.front())), mesh,
                                    triangulation_);
    mapping_ = meshes::cylinder::cylinder_mapping(triangulation_, element_degree);
    nodes_ = meshes::mesh_nodes(triangulation_, *mapping_);
    space_ = std::make_unique<SolidSpace>(triangulation_, *mapping_, materials(cilium));
    quadrature_ = std::make_unique<ExtrudedQuadrature>(*space_, Extent::half);
  }

  const meshes::MeshNodes& nodes() const { return nodes_; }
  double finest_layer() const { return finest_layer_; }
  std::size_t unknowns() const {
    const std::vector<bool> used = calculix_node_set(nodes_);
    return 3 * static_cast<std::size_t>(std::count(used.begin(), used.end(), true));
  }
  /// Deformation by the displacements, three for each node, or by none: the undeformed cilium.
  /// Cilium and load are turned to the azimuth 0.
  Deformation deformation(const Cilium& cilium, const std::vector<double>& displacements,
                          const Load& load) const {
    const SolidState at = state(displacements);
    SpreadLoad spread;
    std::optional<PlaneForce> plane;
    if (const auto dead = load.as<DeadLoad>())
      spread.per_volume = displacements.empty() ? 0 : dead->force_per_length / quadrature_->area();
    if (const auto section = load.as<SectionLoad>(); section && !displacements.empty())
      plane = PlaneForce{section->arclength, section->force * Vector3::UnitX()};
    return {centreline_by_statics(*space_, *quadrature_, at, spread, plane),
            std::make_shared<const SolidBody>(solid_body(*space_, *quadrature_, cilium, at))};
  }

 private:
  /// The 20-node element's displacement at the 27 nodes of the solid's, which hold it exactly.
  SolidState state(const std::vector<double>& displacements) const {
    SolidState result = space_->undeformed();
    if (displacements.empty()) return result;
    Eigen::Matrix<double, element_nodes, 20> interpolation;
    for (int a = 0; a < element_nodes; ++a)
      interpolation.row(a) =
          serendipity_functions(Vector3(a % 3 - 1, a / 3 % 3 - 1, a / 9 - 1))  // NOLINT: whole
              .col(0)
              .transpose();
    for (std::size_t e = 0; e < nodes_.cells.size(); ++e) {
      Eigen::Matrix<double, 20, 3> u;
      for (std::size_t b = 0; b < calculix_nodes.size(); ++b)
        u.row(static_cast<Eigen::Index>(b)) = Eigen::Map<const Vector3>(
            &displacements[3 * nodes_.cells[e].nodes[static_cast<std::size_t>(calculix_nodes[b])]]);
      const Eigen::Matrix<double, element_nodes, 3> all = interpolation * u;
      for (std::size_t c = 0; c < 3; ++c)
        for (std::size_t a = 0; a < element_nodes; ++a)
          result.displacement[space_->elements()[e].dofs[c * element_nodes + a]] =
              all(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(c));
    }
    add_pressure(result);
    return result;
  }

  /// p = K(J − 1) at the eight points of reduced integration, where C3D20R has its stress, fitted
  /// on each element by least squares with the solid's linear pressure.
  void add_pressure(SolidState& state) const {
    dealii::FEValues<3> values(
        *mapping_, space_->scalar_element(), dealii::QGauss<3>(2),
        dealii::update_gradients | dealii::update_JxW_values | dealii::update_quadrature_points);
    for (std::size_t e = 0; e < space_->elements().size(); ++e) {
      const SolidElement& element = space_->elements()[e];
      values.reinit(element.cell);
      const auto u = nodal_displacements(element, state.displacement);
      PressureMatrix mass = PressureMatrix::Zero();
      PressureVector right = PressureVector::Zero();
      for (unsigned int q = 0; q < values.n_quadrature_points; ++q) {
        Matrix3 F = Matrix3::Identity();
        for (unsigned int a = 0; a < element_nodes; ++a) {
          const auto g = values.shape_grad(a, q);
          F += u.row(static_cast<Eigen::Index>(space_->lexicographic()[a])).transpose() *
               Vector3(g[0], g[1], g[2]).transpose();
        }
        const auto& X = values.quadrature_point(q);
        const PressureVector psi = element.pressure_basis(Vector3(X[0], X[1], X[2]));
        mass += values.JxW(q) * psi * psi.transpose();
        right += values.JxW(q) * element.material.bulk_modulus * (F.determinant() - 1) * psi;
      }
      state.pressure[e] = mass.ldlt().solve(right);
    }
  }

  double finest_layer_;
  dealii::Triangulation<3> triangulation_;
  std::unique_ptr<dealii::MappingQCache<3>> mapping_;
  meshes::MeshNodes nodes_;
  std::unique_ptr<SolidSpace> space_;
  std::unique_ptr<ExtrudedQuadrature> quadrature_;
};

/// The last error in a log, or its last lines, in one line.
std::string complaint(const fs::path& log) {
  std::ifstream in(log);
  std::vector<std::string> lines;
  std::size_t error = std::string::npos;
  for (std::string line; std::getline(in, line) && lines.size() < 1000000;) {
    if (line.find("*ERROR") != std::string::npos) error = lines.size();
    if (line.find_first_not_of(" \t\r") != std::string::npos) lines.push_back(line);
  }
  constexpr std::size_t most = 3;
  const std::size_t first =
      error == std::string::npos ? lines.size() - std::min(lines.size(), most) : error;
  std::string text;
  for (std::size_t i = first; i < std::min(lines.size(), first + most); ++i)
    text.append(text.empty() ? "" : " ").append(lines[i], lines[i].find_first_not_of(" \t"));
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20) c = ' ';
  constexpr std::size_t longest = 300;
  return text.substr(0, longest);
}

/// Throws SolverError unless the program ran to its end.
void require_success(const support::ChildEnd& end, const CalculixOptions& options,
                     const fs::path& log) {
  if (end.succeeded()) return;
  const std::string program = options.program.string();
  if (end.how == support::ChildEnd::How::not_found && program == "ccx")
    throw SolverError("ccx is not installed: apt-get install calculix-ccx");
  const std::string said = complaint(log);
  std::string message = "`" + program + "` " + end.text();
  if (end.how == support::ChildEnd::How::not_found)
    message +=
        " (models.calculix.program); CalculiX comes with apt-get install "
        "calculix-ccx";
  else if (end.how == support::ChildEnd::How::timed_out)
    message += ", models.calculix.time_limit: allow more, or a coarser refinement";
  else if (end.how != support::ChildEnd::How::not_started)
    message += said.empty() ? "; it said nothing" : "; it said: " + said;
  throw SolverError(message);
}

/// Sum of the iterations in CalculiX's .sta file; 0 if there is none.
int iterations(const fs::path& file) {
  std::ifstream in(file);
  int sum = 0;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    int step = 0;
    int increment = 0;
    std::string attempt;
    int count = 0;
    if (fields >> step >> increment >> attempt >> count) sum += count;
  }
  return sum;
}

/// The result of a run of CalculiX.
struct Solution {
  std::string failure;  ///< why there is none
  int iterations = 0;
  std::vector<double> displacements;  ///< three for each node, m
};

/// Variables that CalculiX takes its number of threads from.
std::map<std::string, std::string> thread_variables(unsigned int threads) {
  std::map<std::string, std::string> variables{{"OMP_NUM_THREADS", std::to_string(threads)},
                                               {"OMP_THREAD_LIMIT", ""},
                                               {"NUMBER_OF_CPUS", ""}};
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (const std::string_view variable = *entry; variable.starts_with("CCX_NPROC"))
      variables.emplace(variable.substr(0, variable.find('=')), "");
  return variables;
}

/// Runs CalculiX on one mesh. `label` names the folder if it is kept.
Solution run(const CalculixMesh& mesh, const Cilium& cilium, const Load& load,
             const CalculixOptions& options, const std::string& label) {
  const support::SignalPause pause;  // the folder is removed before a signal ends the program
  const auto folder = options.keep.empty()
                          ? std::make_unique<support::WorkFolder>()
                          : std::make_unique<support::WorkFolder>(options.keep / label);
  const fs::path base = folder->path() / job;
  const auto file = [&](const char* extension) { return fs::path(base.string() + extension); };
  std::error_code none;
  for (const char* old : {".dat", ".sta"}) fs::remove(file(old), none);  // of an earlier run
  std::ofstream input(file(".inp"));
  write_calculix(input, mesh.nodes(), cilium, load, options.first_increment);
  input.close();
  if (!input)
    throw FileError("cannot write `" + file(".inp").string() +
                    "`: is the folder writable, or the disk full?");
  const fs::path log = folder->path() / "ccx.log";
  const support::ChildEnd end = support::run_child({options.program.string(),
                                                    {"-i", job},
                                                    folder->path(),
                                                    log,
                                                    options.time_limit,
                                                    thread_variables(options.threads)});
  require_success(end, options, log);
  std::ifstream output(file(".dat"));
  if (!output)
    throw FileError("`" + options.program.string() +
                    "` wrote no .dat file; it said: " + complaint(log));
  Solution solution{{}, iterations(file(".sta")), {}};
  for (const Vector3& u : read_calculix(output, mesh.nodes()))
    solution.displacements.insert(solution.displacements.end(), u.begin(), u.end());
  return solution;
}

/// Rank 0 runs, all ranks have the solution, or all throw SolverError.
Solution run_on_first_rank(const std::function<Solution()>& work) {
  Solution solution;
  if (rank() == 0) {
    try {
      solution = work();
    } catch (const std::exception& error) {
      solution.failure = error.what();
    }
    support::check_interruption();  // rather than a failure for having been killed
  }
  if (rank_count() > 1) {
    namespace mpi = dealii::Utilities::MPI;
    solution.failure = mpi::broadcast(MPI_COMM_WORLD, solution.failure);
    solution.displacements = mpi::broadcast(MPI_COMM_WORLD, solution.displacements);
    solution.iterations = mpi::broadcast(MPI_COMM_WORLD, solution.iterations);
  }
  if (!solution.failure.empty()) throw SolverError(solution.failure);
  return solution;
}

void require_valid(const Cilium& cilium, const LoadPath& path) {
  ciliaval::require_valid(cilium);
  for (const Load& load : path) {
    ciliaval::require_valid(load, cilium);
    if (cilium.is_rectangular() && azimuth(load) != azimuth(path.front()))
      throw InputError("CalculiX takes a path of one azimuth only, if the section is a rectangle");
    if (!load.is<SectionLoad>() && !load.is<DeadLoad>())
      throw InputError("CalculiX takes the loads 'section' and 'dead', not '" +
                       std::string(type(load)) +
                       "', which follows the current height: leave out `calculix`, or state the "
                       "load as one of those");
  }
}

Vector3 tip(const Deformation& deformation) {
  return deformation.centreline.at(deformation.centreline.length()).position;
}

double total_force(const Cilium& cilium, const Load& load) {
  return magnitude(load) * (load.is<DeadLoad>() ? cilium.length() : 1);
}

/// A path of loads on two meshes.
struct Problem {
  const Cilium& cilium;
  const CalculixOptions& options;
  const CalculixMesh& mesh;
  const CalculixMesh* coarser;

  /// Richardson's rule for the order tip_order; none, and a remark, where the coarser run fails.
  std::optional<double> tip_uncertainty(const Load& load, const std::string& label,
                                        const Vector3& fine_tip, std::string& remark) const {
    if (coarser == nullptr) return std::nullopt;
    try {
      const Solution solution = run_on_first_rank(
          [&] { return run(*coarser, cilium, load, options, label + "_coarser"); });
      const Vector3 coarse_tip = tip(coarser->deformation(cilium, solution.displacements, load));
      const double ratio = std::pow(coarser->finest_layer() / mesh.finest_layer(), tip_order);
      return (fine_tip - coarse_tip).norm() / (ratio - 1);
    } catch (const SolverError& error) {
      remark = std::string("no estimate of the tip's error, for the next coarser mesh failed: ") +
               error.what();
      return std::nullopt;
    }
  }

  MechanicsStep step(const Load& asked, const std::string& label) const {
    const auto start = std::chrono::steady_clock::now();
    const double turn = azimuth(asked);
    const Load load = with_azimuth(asked, 0);
    MechanicsStep step;
    step.load = asked;
    step.unknowns = mesh.unknowns();
    try {
      Solution solution;
      if (magnitude(load) != 0)
        solution = run_on_first_rank([&] { return run(mesh, cilium, load, options, label); });
      const Deformation straight_up =
          mesh.deformation(turned(cilium, -turn), solution.displacements, load);
      if (magnitude(load) != 0)
        step.tip_uncertainty = tip_uncertainty(load, label, tip(straight_up), step.message);
      step.deformation = turned(straight_up, turn);
      step.applied_force = total_force(cilium, load);
      step.iterations = solution.iterations;
      step.status = Status::converged;
    } catch (const SolverError& error) {
      step.status = Status::failed;
      step.message = error.what();
    }
    step.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return step;
  }
};

}  // namespace

Calculix::Calculix(CalculixOptions options) : options_(std::move(options)) {
  solid::mesh_level(options_.refinement);
  if (!(options_.first_increment > 0 && options_.first_increment <= 1))
    throw InputError("CalculiX's first_increment must lie between 0 and 1");
  if (options_.threads == 0) throw InputError("CalculiX needs 1 thread or more");
  if (!(std::isfinite(options_.time_limit) && options_.time_limit > 0))
    throw InputError("CalculiX's time_limit must be finite and positive");
  if (options_.program.empty()) throw InputError("CalculiX's program must have a name");
  if (options_.program.has_parent_path())  // CalculiX works in another folder
    options_.program = fs::absolute(options_.program);
}

MechanicsResult Calculix::solve(const Cilium& cilium, const LoadPath& path,
                                const Progress& progress) const {
  require_valid(cilium, path);
  const unsigned int level = solid::mesh_level(options_.refinement);
  const CalculixMesh mesh(cilium, path, level);
  std::unique_ptr<CalculixMesh> coarser;
  if (options_.error_estimate) coarser = std::make_unique<CalculixMesh>(cilium, path, level - 1);
  const Problem problem{cilium, options_, mesh, coarser.get()};
  const double turn = path.empty() ? 0 : azimuth(path.front());
  MechanicsResult result{turned(mesh.deformation(turned(cilium, -turn), {}, DeadLoad{}), turn), {}};
  for (std::size_t i = 0; i < path.size(); ++i) {
    const std::string number = std::to_string(i + 1);
    if (progress)
      progress("step " + number + "/" + std::to_string(path.size()) + ", " +
               std::to_string(mesh.unknowns()) + " unknowns");
    result.steps.push_back(problem.step(path[i], "step_" + number));
    report_step(progress, result.steps, path.size());
  }
  return result;
}

}  // namespace ciliaval::fem::calculix
