# cmake -DBUILD=... -DTEMP=... -DSOURCE=... -DCXX=... -DVERSION=... -P outside.cmake: installs the libraries into
# an empty prefix, builds the project in SOURCE against them and runs its programs.
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
foreach(component core engine)
  run("install ${component}" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${TEMP}/prefix --component ${component})
endforeach()
run(configure ${CMAKE_COMMAND} -S ${SOURCE} -B ${TEMP}/build -G Ninja -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_CXX_COMPILER=${CXX} -DCMAKE_PREFIX_PATH=${TEMP}/prefix -DPASSUNG_VERSION=${VERSION})
run(build ${CMAKE_COMMAND} --build ${TEMP}/build)
run(outside ${TEMP}/build/outside)
run(engine ${TEMP}/build/engine ${SOURCE}/study.toml ${TEMP}/study.db)
