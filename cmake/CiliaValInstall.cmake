# cmake --install, and find_package(CiliaVal) with the targets CiliaVal::problem, ::analytic, ::meshes, ::fem, ::compare.
include(CMakePackageConfigHelpers)
set(config_dir ${CMAKE_INSTALL_LIBDIR}/cmake/CiliaVal)

install(TARGETS ciliaval_problem ciliaval_analytic ciliaval_meshes ciliaval_fem ciliaval_case ciliaval_signal ciliaval_store ciliaval_compare EXPORT CiliaValTargets)
install(TARGETS ciliaval)
install(EXPORT CiliaValTargets NAMESPACE CiliaVal:: DESTINATION ${config_dir})
foreach(folder problem analytic meshes fem compare)
  install(DIRECTORY ${folder} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/ciliaval FILES_MATCHING PATTERN "*.h")
endforeach()
install(DIRECTORY cases DESTINATION ${CMAKE_INSTALL_DATADIR}/ciliaval FILES_MATCHING
  PATTERN "*.toml" PATTERN "*.baseline.json" PATTERN "*.msh" PATTERN "*.geo")
configure_package_config_file(cmake/CiliaValConfig.cmake.in CiliaValConfig.cmake INSTALL_DESTINATION ${config_dir})
write_basic_package_version_file(CiliaValConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/CiliaValConfig.cmake ${PROJECT_BINARY_DIR}/CiliaValConfigVersion.cmake
  cmake/CiliaValDependencies.cmake DESTINATION ${config_dir})
