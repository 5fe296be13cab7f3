# Every third-party package, with the Debian package that provides it in the message.
function(marey_require package debian)
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "${package} was not found. On Debian 12: apt-get install ${debian} "
                        "(or run packaging/run, which installs every package).")
  endif()
endfunction()

macro(marey_require_here package debian)
  # A macro: imported targets and variables of the package must reach the caller.
  find_package(${package} ${ARGN} QUIET)
  if(NOT ${package}_FOUND)
    message(FATAL_ERROR "${package} was not found. On Debian 12: apt-get install ${debian} "
                        "(or run packaging/run, which installs every package).")
  endif()
endmacro()

find_package(Threads REQUIRED)
marey_require_here(Eigen3 libeigen3-dev)
marey_require_here(nlohmann_json nlohmann-json3-dev)
marey_require_here(CLI11 libcli11-dev)
marey_require_here(Torch libtorch-dev)
marey_require_here(OpenMP g++)
if(NOT MAREY_TRAIN_ONLY)
  find_package(fmt QUIET)
  marey_require_here(ZLIB zlib1g-dev)
  marey_require_here(Boost libboost-dev)
  marey_require_here(TinyGLTF libtinygltf-dev)
  find_package(PkgConfig REQUIRED)
  # Debian's libzip CMake files demand the programs zipcmp, zipmerge and ziptool; its
  # pkg-config file demands the library alone.
  pkg_check_modules(libzip QUIET IMPORTED_TARGET libzip)
  if(NOT libzip_FOUND)
    message(FATAL_ERROR "libzip was not found. On Debian 12: apt-get install libzip-dev "
                        "(or run packaging/run, which installs every package).")
  endif()
  foreach(part avcodec avfilter avformat avutil swscale)
    pkg_check_modules(LIB${part} QUIET lib${part})
    if(NOT LIB${part}_FOUND)
      message(FATAL_ERROR "lib${part} was not found. On Debian 12: apt-get install lib${part}-dev "
                          "(or run packaging/run, which installs every package).")
    endif()
  endforeach()
endif()

if(MAREY_MPI)
  marey_require_here(MPI libopenmpi-dev COMPONENTS CXX)
  marey_require_here(Boost libboost-mpi-dev COMPONENTS mpi serialization)
endif()

# fmt: the shared library where it is installed, else its headers alone.
add_library(marey_fmt INTERFACE)
if(fmt_FOUND)
  target_link_libraries(marey_fmt INTERFACE fmt::fmt)
else()
  target_compile_definitions(marey_fmt INTERFACE FMT_HEADER_ONLY)
endif()
