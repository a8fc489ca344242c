# Installs the laws alone, then configures, builds and runs the program of another project against them.
#   cmake -DSOURCE=... -DWORK=... -DCXX=... -P consumer.cmake
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(failed)
    message(FATAL_ERROR "${ARGN}\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK})
# a compiler and nothing else: what a user of the laws has
set(common -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_BUILD_TYPE=Release)
run(${CMAKE_COMMAND} -S ${SOURCE} -B ${WORK}/library ${common} -DGRAINLAW_DRIVERS=OFF -DGRAINLAW_TESTS=OFF)
run(${CMAKE_COMMAND} --install ${WORK}/library --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -S ${CMAKE_CURRENT_LIST_DIR}/consumer -B ${WORK}/consumer ${common}
    -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_COMMAND} --build ${WORK}/consumer)
run(${WORK}/consumer/consumer)
# The stress of the undrained simple shear test at e = 0.845 and a strain of 1, from an independent integration to
# twelve digits; the tolerance of each of the steps is 1e-9, and a hundredth of a pascal is 7e-7 of the result.
if(NOT output MATCHES "shear stress 14972\\.3[34][0-9]* Pa, reasons 0")
  message(FATAL_ERROR "expected 14972.34 Pa and no reasons, got: ${output}")
endif()
message("${output}")
