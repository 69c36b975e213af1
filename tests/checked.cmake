# cmake -DTEMP=... -P checked.cmake: jobs.sh runs the checks that have a word in their name, writes their rows into the page
# and no other's, and says which never ran. Truth: the rows that these commands, known to pass or fail, must give.
cmake_policy(VERSION 3.25)

file(REMOVE_RECURSE ${TEMP})
file(MAKE_DIRECTORY ${TEMP}/docs)
file(WRITE ${TEMP}/file "a file\n")
foreach(words init "add file")
  separate_arguments(words)
  execute_process(COMMAND git -C ${TEMP} ${words} OUTPUT_QUIET ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND git -C ${TEMP} -c user.name=a -c user.email=a@example.org commit -m "a tree"
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND git -C ${TEMP} rev-parse --short HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE)

set(passes "echo '98% tests passed, 1 tests failed out of 40'")
set(jobs "all() { job 'one check' sh -c \"${passes}\"; job 'another check' false; job 'a third' true; }")

# check(WORD RESULT): runs them and sets `page` to what stands there, `errors` to what was said.
function(check word expected)
  execute_process(COMMAND bash -euo pipefail -c ". ${CMAKE_CURRENT_LIST_DIR}/jobs.sh; ${jobs}; check_jobs docs/CHECKED.md '${word}' all"
    WORKING_DIRECTORY ${TEMP} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors)
  set(page "")
  if(EXISTS ${TEMP}/docs/CHECKED.md)
    file(READ ${TEMP}/docs/CHECKED.md page)
  endif()
  if(NOT result EQUAL ${expected})
    message(FATAL_ERROR "ends in ${result}, not ${expected}, with the word '${word}': ${errors}\n${page}")
  endif()
  set(page "${page}" PARENT_SCOPE)
  set(errors "${errors}" PARENT_SCOPE)
endfunction()

function(require pattern)
  if(NOT page MATCHES "${pattern}")
    message(FATAL_ERROR "no row ${pattern} in:\n${page}")
  endif()
endfunction()

set(never "[|]  [|]  [|]  [|]  [|] not yet run at this length [|]")
check(none 2)
if(NOT errors MATCHES "another check" OR NOT page STREQUAL "")
  message(FATAL_ERROR "a word that no check has was not told or wrote a page: ${errors}\n${page}")
endif()

check(third 0)
require("\n[|] one check ${never}\n[|] another check ${never}\n[|] a third [|] ${commit} [|] 20[0-9-]+ [|] 0 [|] 1 / 0 [|] ok [|]\n$")

# A tree with changes is no commit's; the row from before stays as it was.
file(APPEND ${TEMP}/file "a change\n")
check(check 1)
require("\n[|] one check [|] ${commit} with changes [|] 20[0-9-]+ [|] 0 [|] 39 / 1 [|] ok [|]\n")
require("\n[|] another check [|] ${commit} with changes [|] 20[0-9-]+ [|] 0 [|] 0 / 1 [|] FAILED [|]\n[|] a third [|] ${commit} [|] ")

# What is no check any more leaves the page.
set(jobs "all() { job 'a third' true; }")
check("" 0)
if(page MATCHES "one check")
  message(FATAL_ERROR "a check that is no more has a row:\n${page}")
endif()
message(STATUS "checks write their own rows, and a check that never ran says so")
