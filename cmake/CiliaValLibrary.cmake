# Headers of deal.II and Eigen that most units of meshes and fem spend their compile time on, parsed once for all targets
# that say `target_precompile_headers(… REUSE_FROM precompiled_dealii)`. Each file still includes what it uses: scripts/lint.sh builds
# without (CMAKE_DISABLE_PRECOMPILE_HEADERS).
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/dealii.cc CONTENT "")
add_library(precompiled_dealii OBJECT ${PROJECT_BINARY_DIR}/precompiled/dealii.cc)
target_compile_features(precompiled_dealii PRIVATE cxx_std_20)
target_link_libraries(precompiled_dealii PRIVATE CiliaVal::dealii Eigen3::Eigen ciliaval_compiler)
target_precompile_headers(precompiled_dealii PRIVATE
  <Eigen/Core> <Eigen/Geometry> <Eigen/LU> <deal.II/dofs/dof_handler.h> <deal.II/dofs/dof_tools.h> <deal.II/fe/fe_q.h>
  <deal.II/fe/fe_values.h> <deal.II/grid/grid_tools.h> <deal.II/grid/tria.h> <deal.II/lac/affine_constraints.h>
  <deal.II/lac/dynamic_sparsity_pattern.h> <deal.II/lac/sparse_matrix.h> <deal.II/lac/vector.h>)

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
    $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/ciliaval>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC ${ARG_PUBLIC} PRIVATE ${ARG_PRIVATE} $<BUILD_INTERFACE:ciliaval_compiler>)
endfunction()
