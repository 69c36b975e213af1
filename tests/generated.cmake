# cmake -DROOT=... -P generated.cmake: pages that are drawn or written from the tree are what their command writes today:
# the rooms and their arrows from the includes, measured figures from docs/measured.csv. Prints every page that differs as
# file:line: message and fails.
cmake_policy(VERSION 3.25)

set(scripts ${CMAKE_CURRENT_LIST_DIR}/pages)
set(pages
  "docs/architecture.svg | architecture.sh | ./dev architecture"
  "docs/MEASURED.md      | measured.sh     | ./dev pages"
  "README.md             | measured.sh     | ./dev pages")

# The number of the first line in which two texts differ.
function(first_difference one other result)
  set(number 1)
  while(TRUE)
    string(FIND "${one}" "\n" one_end)
    string(FIND "${other}" "\n" other_end)
    string(SUBSTRING "${one}" 0 ${one_end} one_line)
    string(SUBSTRING "${other}" 0 ${other_end} other_line)
    if(NOT one_line STREQUAL other_line OR one_end EQUAL -1 OR other_end EQUAL -1)
      break()
    endif()
    math(EXPR one_end "${one_end} + 1")
    math(EXPR other_end "${other_end} + 1")
    string(SUBSTRING "${one}" ${one_end} -1 one)
    string(SUBSTRING "${other}" ${other_end} -1 other)
    math(EXPR number "${number} + 1")
  endwhile()
  set(${result} ${number} PARENT_SCOPE)
endfunction()

set(faults)
foreach(row IN LISTS pages)
  string(REGEX REPLACE " +[|] +" ";" row "${row}")
  list(GET row 0 page)
  list(GET row 1 script)
  list(GET row 2 command)
  execute_process(COMMAND ${scripts}/${script} ${ROOT} ${page}
    RESULT_VARIABLE result OUTPUT_VARIABLE written ERROR_VARIABLE errors)
  if(NOT result EQUAL 0)
    list(APPEND faults "${page}:1: ${script} fails: ${errors}")
    continue()
  endif()
  set(kept "")
  if(EXISTS ${ROOT}/${page})
    file(READ ${ROOT}/${page} kept)
  endif()
  if(NOT kept STREQUAL written)
    first_difference("${kept}" "${written}" number)
    list(APPEND faults "${page}:${number}: is not what the tree says today: run ${command} and read what changed")
  endif()
endforeach()

list(LENGTH pages page_count)
if(faults)
  list(LENGTH faults count)
  list(JOIN faults "\n" text)
  message(NOTICE "${text}")
  message(FATAL_ERROR "${count} violations in ${page_count} pages")
endif()
message(STATUS "${page_count} pages are what the tree says")
