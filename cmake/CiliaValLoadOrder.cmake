# Start-up time of our programs. The dynamic linker looks for each of 340,000 symbols in library after library, in the order in which they
# are named, first those that the program names itself. Most are found in deal.II and in the OpenCASCADE below it, which would be among the
# last of 220: naming these first takes a sixth off the start of each program, 0.25 to 0.21 s. Only libraries that deal.II needs anyway, and
# only from folders that need not be told to a linker; elsewhere the order stays as it is.
if(NOT CMAKE_CROSSCOMPILING AND DEAL_II_TARGET_RELEASE)
  get_target_property(dealii_file ${DEAL_II_TARGET_RELEASE} LOCATION)
  execute_process(COMMAND ldd ${dealii_file} OUTPUT_VARIABLE dealii_needs ERROR_QUIET)
  set(named_first "")
  foreach(toolkit TKSTEPBase TKBO TKIGES TKGeomAlgo TKMath TKernel TKXSBase TKSTEPAttr TKG3d TKV3d TKGeomBase TKSTEP TKTopAlgo TKBRep TKBool)
    if(dealii_needs MATCHES "=> (/[^ \n]*/lib${toolkit}\\.so[^ \n]*)")
      file(REAL_PATH ${CMAKE_MATCH_1} file)
      cmake_path(GET file PARENT_PATH folder)
      if(folder IN_LIST CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES)
        string(APPEND named_first " ${CMAKE_MATCH_1}")
      endif()
    endif()
  endforeach()
  if(named_first)
    target_link_options(CiliaVal::dealii INTERFACE "SHELL:-Wl,--push-state,--no-as-needed \
\"$<TARGET_FILE:$<IF:$<CONFIG:Debug>,${DEAL_II_TARGET_DEBUG},${DEAL_II_TARGET_RELEASE}>>\"${named_first} -Wl,--pop-state")
  endif()
endif()
