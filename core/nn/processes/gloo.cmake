# Training in several processes needs Gloo within libtorch, and Gloo's headers. Without them
# everything else is built.
include(CheckCXXSourceCompiles)
find_path(GLOO_INCLUDE_DIR gloo/algorithm.h HINTS ${TORCH_INCLUDE_DIRS})
find_path(C10D_INCLUDE_DIR torch/csrc/distributed/c10d/ProcessGroupGloo.hpp
          HINTS ${TORCH_INCLUDE_DIRS})
set(CMAKE_REQUIRED_LIBRARIES ${TORCH_LIBRARIES})
# By its name in the library: libtorch's headers take most of a minute to read.
check_cxx_source_compiles("
  extern \"C\" void _ZN4c10d16ProcessGroupGloo19createDefaultDeviceEv();
  int main() { _ZN4c10d16ProcessGroupGloo19createDefaultDeviceEv(); return 0; }"
  MAREY_TORCH_HAS_GLOO)
unset(CMAKE_REQUIRED_LIBRARIES)
if(GLOO_INCLUDE_DIR AND C10D_INCLUDE_DIR AND MAREY_TORCH_HAS_GLOO)
  target_sources(marey_processes PRIVATE gloo_group.cpp)
  set_source_files_properties(gloo_group.cpp PROPERTIES
                              COMPILE_DEFINITIONS "USE_C10D_GLOO" SKIP_PRECOMPILE_HEADERS ON)
  target_include_directories(marey_processes PRIVATE ${GLOO_INCLUDE_DIR})
else()
  message(STATUS "No Gloo (Debian: libgloo-dev): training in several processes is left out")
  target_sources(marey_processes PRIVATE no_gloo_group.cpp)
endif()
