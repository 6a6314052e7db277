# Every package that CiliaVal uses, for its own build and, through CiliaValConfig.cmake, for its users.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(Boost 1.74 REQUIRED COMPONENTS filesystem)
find_package(TBB REQUIRED)
if(CILIAVAL_ANALYTIC_ALONE) # the paper's models need no more
  return()
endif()
find_package(deal.II 9.4 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(CLI11 REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(SQLite3 3.37 REQUIRED)
# Only these: every further component drags in VTK's own HDF5, beside the one of deal.II.
find_package(VTK 9.1 REQUIRED COMPONENTS CommonCore CommonDataModel IOXML)
# The library that deal.II itself is linked to: it costs no start-up time.
find_path(GMSH_INCLUDE_DIR gmsh.h REQUIRED)
find_library(GMSH_LIBRARY gmsh REQUIRED)
find_path(MUMPS_INCLUDE_DIR dmumps_c.h REQUIRED)
find_library(MUMPS_LIBRARY dmumps REQUIRED)
find_path(METIS_INCLUDE_DIR metis.h REQUIRED)
find_library(METIS_LIBRARY metis REQUIRED)
find_path(UDUNITS2_INCLUDE_DIR udunits2.h PATH_SUFFIXES udunits2 REQUIRED)
find_library(UDUNITS2_LIBRARY udunits2 REQUIRED)

# deal.II as one usage requirement. Its own macro deal_ii_setup_target() sets flags on the target (-Wall, -O0, -rdynamic, the linker)
# that would override our presets, so only what its ABI needs is taken over here: include folders, the library of the same flavour.
# The library names 200 others: --as-needed leaves out those that nothing refers to, and halves the start-up time.
if(NOT TARGET CiliaVal::dealii)
  include(${DEAL_II_TARGET_CONFIG})
  add_library(CiliaVal::dealii INTERFACE IMPORTED)
  target_include_directories(CiliaVal::dealii SYSTEM INTERFACE ${DEAL_II_INCLUDE_DIRS})
  target_compile_definitions(CiliaVal::dealii INTERFACE $<$<CONFIG:Debug>:${DEAL_II_USER_DEFINITIONS_DEBUG}>)
  target_link_options(CiliaVal::dealii BEFORE INTERFACE -Wl,--as-needed)
  target_link_libraries(CiliaVal::dealii INTERFACE
    $<IF:$<CONFIG:Debug>,${DEAL_II_TARGET_DEBUG},${DEAL_II_TARGET_RELEASE}>)
endif()

if(NOT TARGET CiliaVal::udunits)
  add_library(CiliaVal::udunits INTERFACE IMPORTED)
  target_include_directories(CiliaVal::udunits SYSTEM INTERFACE ${UDUNITS2_INCLUDE_DIR})
  target_link_libraries(CiliaVal::udunits INTERFACE ${UDUNITS2_LIBRARY})
endif()

if(NOT TARGET CiliaVal::gmsh)
  add_library(CiliaVal::gmsh INTERFACE IMPORTED)
  target_include_directories(CiliaVal::gmsh SYSTEM INTERFACE ${GMSH_INCLUDE_DIR})
  target_link_libraries(CiliaVal::gmsh INTERFACE ${GMSH_LIBRARY})
endif()

# With METIS, whose orderings it is given.
if(NOT TARGET CiliaVal::mumps)
  add_library(CiliaVal::mumps INTERFACE IMPORTED)
  target_include_directories(CiliaVal::mumps SYSTEM INTERFACE ${MUMPS_INCLUDE_DIR} ${METIS_INCLUDE_DIR})
  target_link_libraries(CiliaVal::mumps INTERFACE ${MUMPS_LIBRARY} ${METIS_LIBRARY})
endif()
