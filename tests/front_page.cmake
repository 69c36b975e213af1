# cmake -DROOT=... -P front_page.cmake: README.md stays a front page, read in two minutes. Words are what spaces part,
# code included; a figure is a number as written, but for the name of a commit. Prints every violation as file:line:
# message and fails.
cmake_policy(VERSION 3.25)

set(most_lines 120)
set(most_words 900)
set(most_figures 30)

file(READ ${ROOT}/README.md text)
string(REGEX REPLACE "[][;\\]" "_" text "${text}")
string(REGEX MATCHALL "\n" lines "${text}")
string(REGEX MATCHALL "[^ \t\n]+" words "${text}")
string(REGEX REPLACE "commit `[0-9a-f]+`" "" without_commits "${text}")
string(REGEX MATCHALL "[0-9]+([.,][0-9]+)*" figures "${without_commits}")

set(faults)
set(counted)
foreach(what lines words figures)
  list(LENGTH ${what} count)
  list(APPEND counted "${count} ${what}")
  if(count GREATER most_${what})
    list(APPEND faults "README.md:1: ${count} ${what}, at most ${most_${what}}: the rest belongs on a page of its own")
  endif()
endforeach()
list(JOIN counted ", " text)
if(faults)
  list(LENGTH faults count)
  list(JOIN faults "\n" message)
  message(NOTICE "${message}")
  message(FATAL_ERROR "${count} violations in ${text}")
endif()
message(STATUS "README.md: ${text}")
