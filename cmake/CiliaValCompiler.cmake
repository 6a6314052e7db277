# Warnings and sanitizers of our own code.
add_library(ciliaval_compiler INTERFACE)
target_compile_options(ciliaval_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  # deal.II 9.4 and Boost 1.74 use features that C++20 deprecates; -Wno-psabi: a note about GCC 4.6.
  -Wno-deprecated-declarations -Wno-psabi
  # A precompiled header that does not fit would be passed over.
  -Werror=invalid-pch)
if(CMAKE_UNITY_BUILD)
  # What is only due to files compiled together, and GCC 12's false alarms in std::string (its bug 105329) where it inlines more.
  # With CMAKE_UNITY_BUILD=OFF, as in the preset `debug`, each file is compiled alone.
  target_compile_options(ciliaval_compiler INTERFACE -Wno-shadow -Wshadow=local -Wno-subobject-linkage -Wno-array-bounds -Wno-restrict -Wno-stringop-overflow
    -Wno-stringop-overread)
endif()
if(CILIAVAL_ODR)
  # Intermediate code beside the machine code, for the test odr.EveryTypeIsDefinedOnce alone: programs are linked without it.
  add_compile_options(-flto -ffat-lto-objects)
  add_link_options(-fno-lto)
endif()
if(CILIAVAL_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
  # With the sanitizer Eigen aligns by itself and frees accordingly; Gmsh's library has templates of Eigen in common with us and
  # was built without, so that one would free what the other has allocated.
  add_compile_definitions(EIGEN_MALLOC_ALREADY_ALIGNED=1)
endif()

# ccache keeps what it has compiled. It takes a precompiled header only with -fpch-preprocess. A sixteenth of its size must hold two of
# these headers, or it throws them away and finds nothing that was compiled with them.
find_program(CILIAVAL_CCACHE ccache)
if(CILIAVAL_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_NOHASHDIR=1
    CCACHE_MAXSIZE=10G CCACHE_SLOPPINESS=pch_defines,time_macros ${CILIAVAL_CCACHE})
  add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
endif()

# GNU ld takes ten times as long to link a program against deal.II's libraries.
include(CheckLinkerFlag)
check_linker_flag(CXX -fuse-ld=gold CILIAVAL_HAS_GOLD)
if(CILIAVAL_HAS_GOLD)
  add_link_options(-fuse-ld=gold)
endif()
