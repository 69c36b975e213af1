# cmake -DTEMP=... -P measure.cmake: pages/measure.sh on a small tree writes what a command prints into the rows whose
# pattern finds it, says where it does not, and touches no other row.
cmake_policy(VERSION 3.25)

file(REMOVE_RECURSE ${TEMP})
set(script ${CMAKE_CURRENT_LIST_DIR}/pages/measure.sh)
set(header "section,id,what,figure,unit,mark,command,pattern,commit,date,machine,front\n")
set(kept "Depth,slow,\"by hand, once\",3,mm,,sleep,,0123abc,2026-01-01,another,\n")
set(measured "Depth,ball,\"of a \"\"ball\"\"\",1,mm,<= 2,\"printf 'depth 0.7 mm, cube 1.5 mm\\n'; false\",depth ([0-9.]+) mm,0123abc,2026-01-01,another,\n")

# Sets `result` and `errors`, and `table` to what stands in the table afterwards.
function(measure rows)
  file(WRITE ${TEMP}/docs/measured.csv "${header}${rows}")
  execute_process(COMMAND ${script} ${TEMP} ${TEMP} RESULT_VARIABLE result OUTPUT_QUIET ERROR_VARIABLE errors)
  file(READ ${TEMP}/docs/measured.csv table)
  set(result "${result}" PARENT_SCOPE)
  set(errors "${errors}" PARENT_SCOPE)
  set(table "${table}" PARENT_SCOPE)
endfunction()

foreach(folder core devices study analysis ui tests protocols docs)
  file(WRITE ${TEMP}/${folder}/README.md "# a card\n")
endforeach()
foreach(words init "add .")
  separate_arguments(words)
  execute_process(COMMAND git -C ${TEMP} ${words} OUTPUT_QUIET ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
endforeach()
execute_process(COMMAND git -C ${TEMP} -c user.name=a -c user.email=a@example.org commit -m "a tree"
  OUTPUT_QUIET COMMAND_ERROR_IS_FATAL ANY)
execute_process(COMMAND git -C ${TEMP} rev-parse --short=7 HEAD OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE)

measure("${kept}${measured}")
string(FIND "${table}" "${header}${kept}Depth,ball,\"of a \"\"ball\"\"\",0.7,mm," at)
if(NOT result EQUAL 0 OR NOT at EQUAL 0 OR NOT table MATCHES "mm,${commit},20[0-9-]+,.+,\n$")
  message(FATAL_ERROR "not written as measured (${result}): ${errors}\n${table}")
endif()

string(REPLACE "depth (" "height (" unreadable "${measured}")
measure("${kept}${unreadable}")
if(result EQUAL 0 OR NOT errors MATCHES "measured[.]csv:3: " OR NOT table STREQUAL "${header}${kept}${unreadable}")
  message(FATAL_ERROR "a command that prints no figure changed the table or was not told (${result}): ${errors}\n${table}")
endif()

# A figure of a tree that no commit has cannot be measured again.
file(APPEND ${TEMP}/core/README.md "a change\n")
measure("${measured}")
if(result EQUAL 0 OR NOT table STREQUAL "${header}${measured}")
  message(FATAL_ERROR "a tree with changes was measured (${result}): ${errors}\n${table}")
endif()
message(STATUS "figures are written where their commands print them, and nowhere else")
