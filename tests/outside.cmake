# cmake -DBUILD=... -DTEMP=... -DSOURCE=... -DCXX=... -DVERSION=... -P outside.cmake: installs the core into an empty
# prefix, builds the project in SOURCE against it and runs it.
cmake_policy(VERSION 3.25)

function(run what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    message(NOTICE "${output}")
    message(FATAL_ERROR "${what} failed: ${result}")
  endif()
  message(STATUS "${what}: ok")
endfunction()

file(REMOVE_RECURSE ${TEMP})
run(install ${CMAKE_COMMAND} --install ${BUILD} --prefix ${TEMP}/prefix --component core)
run(configure ${CMAKE_COMMAND} -S ${SOURCE} -B ${TEMP}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${TEMP}/prefix -DPASSUNG_VERSION=${VERSION})
run(build ${CMAKE_COMMAND} --build ${TEMP}/build)
run(program ${TEMP}/build/outside)
