# cmake --install (components: program, development, python), cpack, and find_package(CiliaVal [COMPONENTS analytic]) with the targets CiliaVal::problem, ::analytic, ::meshes, ::fem, ::compare.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/CiliaVal)

install(TARGETS ciliaval_problem ciliaval_analytic ciliaval_meshes ciliaval_fem ciliaval_case ciliaval_store ciliaval_compare
  EXPORT CiliaValTargets COMPONENT development)
install(TARGETS ciliaval COMPONENT program)
install(EXPORT CiliaValTargets NAMESPACE CiliaVal:: DESTINATION ${config_dir} COMPONENT development)
# What a user calls: models, their problem and results, the closed forms of fields. What these headers include is installed too.
file(GLOB public_headers RELATIVE ${PROJECT_SOURCE_DIR} problem/*.h problem/surroundings/*.h analytic/sources/*.h)
list(APPEND public_headers analytic/elastica/elastica.h analytic/rod/field_models.h analytic/body/mesh_field.h
  meshes/cylinder/cylinder_mesh.h fem/parallel.h fem/beam/beam.h fem/solid/solid.h fem/potential/potential.h
  compare/input/case.h compare/models/registry.h compare/models/run.h compare/models/errors.h compare/output/results.h)
install(CODE "set(SOURCE \"${PROJECT_SOURCE_DIR}\")
  set(INCLUDE_DIR \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_INCLUDEDIR}\")
  set(HEADERS \"${public_headers}\")" COMPONENT development)
install(SCRIPT cmake/install_headers.cmake COMPONENT development)
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/ciliaval COMPONENT program FILES_MATCHING
  PATTERN "*.toml" PATTERN "*.baseline.json" PATTERN "*.msh" PATTERN "*.geo")
configure_package_config_file(cmake/CiliaValConfig.cmake.in CiliaValConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(CiliaValConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/CiliaValConfig.cmake ${PROJECT_BINARY_DIR}/CiliaValConfigVersion.cmake
  cmake/CiliaValDependencies.cmake DESTINATION ${config_dir} COMPONENT development)

# What a Debian user looks for: licence, documentation, manual page, completion.
set(doc_dir ${CMAKE_INSTALL_DATAROOTDIR}/doc/ciliaval)
install(FILES LICENSE README.md CHANGELOG.md CITATION.cff DESTINATION ${doc_dir} COMPONENT program)
install(DIRECTORY docs/ DESTINATION ${doc_dir} COMPONENT program FILES_MATCHING PATTERN "*.md" PATTERN "*.svg" PATTERN "*.png" REGEX "/gallery/[^/]*\\.(py|rst)$")
set(man_page ${PROJECT_BINARY_DIR}/ciliaval.1)
add_custom_command(OUTPUT ${man_page} DEPENDS ciliaval ${PROJECT_SOURCE_DIR}/cmake/man_page.cmake
  COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:ciliaval> -D PAGE=${man_page} -P ${PROJECT_SOURCE_DIR}/cmake/man_page.cmake)
add_custom_target(man ALL DEPENDS ${man_page})
install(FILES ${man_page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES cmake/completion/ciliaval.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME ciliaval COMPONENT program)
install(FILES cmake/completion/_ciliaval DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions COMPONENT program)

# cpack: one package of the program and the Python package, with the libraries that they need.
set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
if(CILIAVAL_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
endif()
set(CPACK_PACKAGE_CONTACT "CiliaVal developers <ciliaval@example.org>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "python3 (>= 3.11), python3-numpy, python3-scipy, python3-pandas")
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "python3-numpy, python3-matplotlib, python3-jinja2, libjs-three")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "calculix-ccx, paraview")
set(CPACK_STRIP_FILES ON)
include(CPack)
