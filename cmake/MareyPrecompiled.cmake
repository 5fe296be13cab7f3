# marey_precompile(TARGET GROUP)
#
# The large headers of cmake/precompiled/GROUP.h are compiled once for all targets of the group,
# which must have the same compiler options and the macros of the first: it compiles, the others
# reuse.
# Sources still include what they need: CMAKE_DISABLE_PRECOMPILE_HEADERS leaves all of this out.
function(marey_precompile target group)
  get_property(owner GLOBAL PROPERTY "MAREY_PRECOMPILED_${group}")
  if(owner)
    target_precompile_headers(${target} REUSE_FROM ${owner})
  else()
    target_precompile_headers(${target} PRIVATE "${CMAKE_SOURCE_DIR}/cmake/precompiled/${group}.h")
    set_property(GLOBAL PROPERTY "MAREY_PRECOMPILED_${group}" ${target})
  endif()
  # GCC 12 forgets which precompiled headers are the system's and warns of std::string (GCC bug
  # 105651); the presets without precompiled headers keep these warnings.
  if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
    target_compile_options(${target} PRIVATE
      "$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread>")
  endif()
endfunction()
