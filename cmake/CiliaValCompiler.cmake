# Warnings and sanitizers of our own code.
add_library(ciliaval_compiler INTERFACE)
target_compile_options(ciliaval_compiler INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion
  # deal.II 9.4 and Boost 1.74 use features that C++20 deprecates; -Wno-psabi: a note about GCC 4.6.
  -Wno-deprecated-declarations -Wno-psabi)
if(CILIAVAL_SANITIZE)
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  add_link_options(-fsanitize=address,undefined)
endif()
