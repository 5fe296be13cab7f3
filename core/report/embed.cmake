# cmake -DTEMPLATE=... -DSTYLE=... -DOUTPUT=... -P embed.cmake
# Writes a C++ source that holds both files. Compilers limit the length of one literal, so files
# are cut into pieces, which the compiler joins.
function(literal file variable)
  file(READ "${file}" rest)
  set(pieces "")
  string(LENGTH "${rest}" length)
  while(length GREATER 0)
    string(SUBSTRING "${rest}" 0 4000 piece)
    string(APPEND pieces "\n    R\"marey(${piece})marey\"")
    if(length GREATER 4000)
      string(SUBSTRING "${rest}" 4000 -1 rest)
    else()
      set(rest "")
    endif()
    string(LENGTH "${rest}" length)
  endwhile()
  set(${variable} "${pieces}" PARENT_SCOPE)
endfunction()

literal("${TEMPLATE}" template)
literal("${STYLE}" style)
file(WRITE "${OUTPUT}" "#include \"report/resources.h\"

namespace marey::report {

const std::string templateText =${template};

const std::string styleText =${style};

}  // namespace marey::report
")
