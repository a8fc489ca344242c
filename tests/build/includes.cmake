# Who may include whom: rheology <- sph <- drivers, and each outside library in one place.
#   cmake -DSOURCE=... -P includes.cmake
set(wrong "")
set(looked 0)

# Reports every include of the files that matches `forbidden` and not `allowed`.
function(check files forbidden allowed why)
  foreach(file IN LISTS files)
    file(STRINGS ${file} lines REGEX "^[ \t]*#[ \t]*include")
    foreach(line IN LISTS lines)
      string(REGEX REPLACE ".*#[ \t]*include[ \t]*[<\"]([^>\"]*)[>\"].*" "\\1" header "${line}")
      math(EXPR looked "${looked} + 1")
      if(header MATCHES "${forbidden}" AND NOT header MATCHES "${allowed}")
        file(RELATIVE_PATH where ${SOURCE} ${file})
        list(APPEND wrong "${where} includes ${header}: ${why}")
      endif()
    endforeach()
  endforeach()
  set(wrong "${wrong}" PARENT_SCOPE)
  set(looked ${looked} PARENT_SCOPE)
endfunction()

# the laws: the standard library (no dot, no slash), Eigen, vector intrinsics and each other, found beside themselves
file(GLOB_RECURSE rheology ${SOURCE}/rheology/*.[ch]pp)
check("${rheology}" "." "^[a-z_]+$|^Eigen/[A-Z][A-Za-z]*$|^immintrin\\.h$|^[a-z_]+\\.hpp$"
      "the laws may use the standard library and Eigen alone")
foreach(file IN LISTS rheology)
  file(STRINGS ${file} lines REGEX "^[ \t]*#[ \t]*include[ \t]*\"")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE ".*\"([^\"]*)\".*" "\\1" header "${line}")
    get_filename_component(folder ${file} DIRECTORY)
    if(NOT EXISTS ${folder}/${header})
      list(APPEND wrong "${file} includes ${header}, which is no header of the laws")
    endif()
  endforeach()
endforeach()

file(GLOB_RECURSE sph ${SOURCE}/sph/*.[ch]pp)
check("${sph}" "drivers/|sundials|arkode|cvode|nvector|yaml-cpp|CLI/|nlohmann" "^$" "the particle solver knows no drivers")

file(GLOB_RECURSE drivers ${SOURCE}/drivers/*.[ch]pp)
list(FILTER drivers EXCLUDE REGEX "drivers/element/integrator\\.cpp$")
check("${drivers}" "^(sundials|arkode|cvode|cvodes|ida|idas|kinsol|nvector|sunmatrix|sunlinsol|sunnonlinsol)/" "^$"
      "SUNDIALS belongs to drivers/element/integrator.cpp")
list(FILTER drivers EXCLUDE REGEX "drivers/input/")
check("${drivers}" "^yaml-cpp/" "^$" "YAML belongs to drivers/input")

if(looked LESS 50)
  message(FATAL_ERROR "only ${looked} includes were found: nothing was tested")
endif()
if(wrong)
  list(JOIN wrong "\n" wrong)
  message(FATAL_ERROR "${wrong}")
endif()
message("${looked} includes point the right way")

# The law printed in rheology/README.md is the one that compiles.
file(READ ${SOURCE}/tests/build/coulomb.hpp example)
string(FIND "${example}" "struct Coulomb {" from)
string(FIND "${example}" "static_assert(Law<Coulomb>);" to)
math(EXPR length "${to} - ${from}")
string(SUBSTRING "${example}" ${from} ${length} example)
string(STRIP "${example}" example)
file(READ ${SOURCE}/rheology/README.md readme)
string(FIND "${readme}" "${example}" found)
if(found EQUAL -1)
  message(FATAL_ERROR "rheology/README.md does not show the law of tests/build/coulomb.hpp as it is")
endif()
