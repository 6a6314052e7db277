# ciliaval_precompile(name LIBRARIES targets… HEADERS files…): headers that many units spend their compile time on, parsed once for
# all targets that say `target_precompile_headers(… REUSE_FROM precompiled_name)`. Each file still includes what it uses:
# scripts/lint.sh builds without (CMAKE_DISABLE_PRECOMPILE_HEADERS).
function(ciliaval_precompile name)
  cmake_parse_arguments(ARG "" "" "LIBRARIES;HEADERS" ${ARGN})
  set(target precompiled_${name})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${name}.cc CONTENT "")
  add_library(${target} OBJECT ${PROJECT_BINARY_DIR}/precompiled/${name}.cc)
  target_compile_features(${target} PRIVATE cxx_std_20)
  target_link_libraries(${target} PRIVATE ${ARG_LIBRARIES} ciliaval_compiler)
  target_precompile_headers(${target} PRIVATE ${ARG_HEADERS})
endfunction()

# GCC uses a precompiled header only where the same macros are defined. Boost::headers defines BOOST_ALL_NO_LIB, so a target that
# links it cannot use these headers; it needs no Boost::headers, because deal.II brings Boost.
set(ciliaval_dealii_headers <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <deal.II/dofs/dof_handler.h> <deal.II/dofs/dof_tools.h>
  <deal.II/fe/fe_q.h> <deal.II/fe/fe_values.h> <deal.II/grid/grid_tools.h> <deal.II/grid/tria.h> <deal.II/lac/affine_constraints.h>
  <deal.II/lac/dynamic_sparsity_pattern.h> <deal.II/lac/sparse_matrix.h> <deal.II/lac/vector.h>)
ciliaval_precompile(dealii LIBRARIES CiliaVal::dealii Eigen3::Eigen HEADERS ${ciliaval_dealii_headers})
ciliaval_precompile(numbers LIBRARIES Eigen3::Eigen
  HEADERS <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <algorithm> <cmath> <functional> <map> <memory> <optional> <string> <vector>)
set(text_headers <Eigen/Core> <Eigen/Geometry> <algorithm> <cmath> <filesystem> <fmt/core.h> <fmt/ranges.h> <fstream> <functional> <map>
  <nlohmann/json.hpp> <sstream> <string> <vector>)
ciliaval_precompile(text LIBRARIES Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json HEADERS ${text_headers})
ciliaval_precompile(commands LIBRARIES Eigen3::Eigen fmt::fmt nlohmann_json::nlohmann_json CLI11::CLI11
  HEADERS ${text_headers} <CLI/CLI.hpp>)
foreach(name text commands) # as compare/ is compiled
  target_compile_options(precompiled_${name} PRIVATE $<$<CONFIG:Release>:-O2>)
endforeach()

# ciliaval_library(name SOURCES files… PUBLIC targets… PRIVATE targets…): one library of the suite, CiliaVal::name.
function(ciliaval_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  set(target ciliaval_${name})
  add_library(${target} STATIC ${ARG_SOURCES})
  add_library(CiliaVal::${name} ALIAS ${target})
  set_property(GLOBAL APPEND PROPERTY ciliaval_libraries ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:ciliaval_compiler>)
endfunction()
