# marey_library(NAME SOURCES ... [PUBLIC ...] [PRIVATE ...] [ROOT folder])
#
# One static library per folder. Headers are included as "folder/header.h", so the
# include root is the parent of the calling folder, where no other is given. Links are recorded in the global
# property MAREY_LINKS for the test that guards the layering.
function(marey_library name)
  cmake_parse_arguments(ARG "" "ROOT" "SOURCES;PUBLIC;PRIVATE" ${ARGN})
  add_library(${name} STATIC ${ARG_SOURCES})
  cmake_path(GET CMAKE_CURRENT_SOURCE_DIR PARENT_PATH include_root)
  if(ARG_ROOT)
    set(include_root "${ARG_ROOT}")
  endif()
  target_include_directories(${name} PUBLIC "${include_root}")
  target_link_libraries(${name} PUBLIC ${ARG_PUBLIC} PRIVATE marey_settings ${ARG_PRIVATE})
  set_property(GLOBAL APPEND PROPERTY MAREY_LINKS
               "${name}: ${ARG_PUBLIC} ${ARG_PRIVATE}")
endfunction()
