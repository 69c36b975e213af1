# cmake -DROOT=... -DCXX=... -DEIGEN=... -P draft_plan.cmake: no session runs a draft, and nothing but freeze() makes of it
# the plan that a session takes.
cmake_policy(VERSION 3.25)

include(${ROOT}/tests/support/must_not_compile.cmake)
must_not_compile(${ROOT}/tests/study/session/draft_plan.cpp 3)

file(GLOB_RECURSE sources ${ROOT}/study/*.h ${ROOT}/study/*.cpp ${ROOT}/analysis/*.cpp ${ROOT}/ui/*.cpp ${ROOT}/ui/*.h)
list(FILTER sources EXCLUDE REGEX "/study/(plan/frozen_plan[.]h|run/freeze[.]cpp)$")
foreach(file IN LISTS sources)
  file(STRINGS ${file} makes REGEX "FrozenPlan[ a-z_]*[({]")
  if(makes)
    message(SEND_ERROR "${file}: freeze() alone makes a frozen plan: ${makes}")
  endif()
endforeach()
