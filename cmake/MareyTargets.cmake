# marey_library(NAME SOURCES ... [PUBLIC ...] [PRIVATE ...] [ROOT folder])
#
# One static library per folder. Headers are included by their path below core/ or plugins/
# ("nn/engine/team.h"), where no other root is given. Links are recorded in the global
# property MAREY_LINKS for the test that guards the layering.
function(marey_library name)
  cmake_parse_arguments(ARG "" "ROOT" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  cmake_path(RELATIVE_PATH CMAKE_CURRENT_SOURCE_DIR BASE_DIRECTORY "${CMAKE_SOURCE_DIR}" OUTPUT_VARIABLE folder)
  string(REGEX MATCH "^[^/]+" top "${folder}")
  set(include_root "${CMAKE_SOURCE_DIR}/${top}")
  if(ARG_ROOT)
    set(include_root "${ARG_ROOT}")
  endif()
  target_include_directories(${name} PUBLIC "${include_root}")
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE marey_settings ${ARG_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY MAREY_LINKS
               "${name}: ${ARG_PUBLIC} ${ARG_PRIVATE}")
endfunction()
