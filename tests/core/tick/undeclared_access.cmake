# cmake -DROOT=... -DCXX=... -DEIGEN=... -P undeclared_access.cmake: what a stage does not declare does not compile.
# Compiles undeclared_access.cpp as it stands, which must succeed, and with its faults, each of which must be an error at
# its own line. No header or source of a stage includes the wholes, from which it could reach any part.
cmake_policy(VERSION 3.25)

include(${ROOT}/tests/support/must_not_compile.cmake)
must_not_compile(${ROOT}/tests/core/tick/undeclared_access.cpp 14)

file(GLOB sources ${ROOT}/core/tick/*.h ${ROOT}/core/tick/*.cpp)
list(FILTER sources EXCLUDE REGEX "/((step|pick|pressed_run|scene_sequence|tick_query|hand_state|tick_model|tick_state)[.](h|cpp)|(hand_model|hand_balance)[.]cpp)$")
foreach(file IN LISTS sources)
  file(STRINGS ${file} includes REGEX "#include \"core/tick/(hand_state|tick_model|tick_state|step|scene_sequence|pressed_run|tick_query)[.]h\"")
  if(includes)
    message(SEND_ERROR "${file}: a stage may not include the wholes")
  endif()
endforeach()
