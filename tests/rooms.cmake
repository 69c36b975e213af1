# cmake -DROOT=... -P rooms.cmake: every include of every source file against the table of rooms and the doors of the
# cards, and every folder of the product against the most sources that it may have. Prints every violation as
# file:line: message and fails.
cmake_policy(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/../cmake/doors.cmake)
include(${CMAKE_CURRENT_LIST_DIR}/../cmake/tick_rooms.cmake)

# Each room and the rooms it may include besides itself. Arrows point only upward.
set(model_rooms "core/geometry core/import core/shape core/field core/shell core/scene")
set(contact_rooms "core/base ${model_rooms} core/contact core/motion core/closed_form core/surface")
set(core_rooms "${contact_rooms} core/path core/tick core/query core/loop core/replay")
set(plan_rooms "study/plan study/design study/questionnaire study/measures")
set(row_rooms "core/base ${plan_rooms} study/session")
set(study_rooms "${plan_rooms} study/protocol study/person")
set(front_rooms "${core_rooms} devices study analysis ui/presenter")
set(rooms
  "core/base           |"
  "core/geometry       | core/base"
  "core/import         | core/base core/geometry"
  "core/shape          | core/base core/geometry core/import"
  "core/field          | core/base core/geometry core/import core/shape"
  "core/shell          | core/base core/geometry core/import core/shape core/field"
  "core/scene          | core/base core/geometry core/import core/shape core/field core/shell"
  "core/contact        | core/base ${model_rooms}"
  "core/motion         | core/base ${model_rooms} core/contact"
  "core/closed_form    | core/base core/geometry core/import core/shape core/field core/motion"
  "core/surface        | core/base ${model_rooms} core/contact core/motion"
  "core/path           | ${contact_rooms}"
  "core/tick           | ${contact_rooms}"
  "core/query          | ${contact_rooms}"
  "core/loop           | ${contact_rooms} core/tick"
  "core/replay         | ${contact_rooms} core/tick"
  "devices             | core/base core/loop"
  "study/design        | core/base"
  "study/questionnaire | core/base"
  "study/plan          | core/base ${model_rooms} study/design study/questionnaire"
  "study/protocol      | core/base ${model_rooms} study/plan study/design study/questionnaire"
  "study/measures      | core/base ${model_rooms}"
  "study/person        | core/base study/questionnaire"
  "study/session       | core/base ${model_rooms} ${plan_rooms}"
  "study/store/schema   | core/base ${plan_rooms}"
  "study/store/samples  | core/base"
  "study/store/rows     | ${row_rooms} study/store/schema"
  "study/store/read     | ${row_rooms} study/store/schema study/store/samples study/store/rows"
  "study/store/write    | ${row_rooms} study/store/schema study/store/samples study/store/rows study/store/read"
  "study/store/people   | ${row_rooms} study/store/schema study/store/samples study/store/rows study/store/read study/store/write"
  "study/store/transfer | ${row_rooms} study/store/schema study/store/samples study/store/rows study/store/read study/store/write study/store/people"
  "study/store/postgres | ${row_rooms} study/store/schema study/store/rows study/store/read study/store/transfer"
  "analysis/truth      | ${contact_rooms} core/tick core/query"
  "analysis/stats      | core/base"
  "analysis/export     | core/base ${plan_rooms} study/protocol study/store analysis/stats"
  "analysis/report     | core/base ${plan_rooms} study/store analysis/export analysis/stats"
  "study/feasible      | ${contact_rooms} core/path ${plan_rooms} analysis/truth"
  "study/run           | ${core_rooms} devices ${study_rooms} study/session study/store analysis/truth"
  "analysis/power      | core/base ${study_rooms} study/session study/store study/run analysis/export analysis/report analysis/stats"
  "ui/presenter        | core/base ${model_rooms} core/loop ${study_rooms} study/session study/store study/run analysis/export analysis/stats"
  "ui/sound            | core/base core/loop study/measures"
  "ui/controls         |"
  "ui/experimenter     | ui/controls ui/presenter"
  "ui/participant      | ui/presenter"
  "ui/window           | ${front_rooms} ui/sound ui/controls ui/experimenter ui/participant"
  "ui/cli              | ${front_rooms}"
  "tests               | *")

# Headers from outside: what the path between the angle brackets looks like, the rooms that may include it, and
# whether only their .cpp files may (so that nothing built on the room sees it).
set(libraries
  "Eigen    | ^(unsupported/)?Eigen/           | *                                      | any"
  "fmt      | ^fmt/                            | core/base core/loop core/replay devices study analysis ui tests | any"
  "assimp   | ^assimp/                         | core/import tests                      | cpp"
  "minizip  | ^minizip/                        | core/import                            | cpp"
  "toml++   | ^toml[+][+]/                     | study/protocol tests                   | cpp"
  "SQLite   | ^sqlite3[.]h$                    | study/store tests                      | any"
  "zlib     | ^zlib[.]h$                       | study/store/samples analysis/export tests | cpp"
  "OpenSSL  | ^openssl/                        | core/base tests                         | cpp"
  "libpqxx  | ^pqxx/                           | study/store/postgres tests             | cpp"
  "FCL      | ^fcl/                            | analysis/truth tests                   | cpp"
  "Boost.Math | ^boost/math/                     | analysis/stats tests                   | cpp"
  "Beast    | ^boost/(asio|beast|system)/      | devices tests                          | cpp"
  "nlohmann | ^nlohmann/                       | devices tests                          | cpp"
  "spdlog   | ^spdlog/                         | study/run tests                        | cpp"
  "CLI11    | ^CLI/                            | ui/cli tests                           | cpp"
  "OMPL     | ^ompl/                           | core/path                              | cpp"
  "ODE      | ^ode/                            | tests                                  | cpp"
  "Bullet   | ^(btBullet|Bullet)               | tests                                  | cpp"
  "OpenVDB  | ^openvdb/                        | tests                                  | cpp"
  "Qt       | ^Q[A-Zt]                         | ui/experimenter ui/participant ui/window tests | any"
  "spnav    | ^spnav[.]h$                      | tests                                   | cpp"
  "XCB      | ^xcb/                            | ui/window tests                        | cpp"
  "gbench   | ^benchmark/                      | tests                                  | cpp"
  "gtest    | ^g(test|mock)/                   | tests                                  | any"
  "POSIX    | ^(sys|linux|arpa|netinet)/|^(unistd|pthread|sched|fcntl|poll|semaphore|spawn|signal|time|dlfcn|termios|malloc|netdb|pwd|grp)[.]h$ | core/base core/loop devices study/store study/run analysis/report ui tests | cpp")

# The tick: a positive list. What is not here allocates, locks, throws, waits or talks to the system.
set(tick_standard_headers algorithm array atomic bit bitset cassert cfloat climits cmath compare concepts cstddef
  cstdint cstdlib cstring initializer_list iterator limits numbers numeric optional span tuple type_traits utility
  variant vector)
# Rooms without a thread or a lock of their own.
set(threadless_rooms core/base core/query core/replay study/plan study/protocol study/design study/questionnaire study/measures
  study/person study/session ui/presenter)
set(thread_headers barrier condition_variable future latch mutex semaphore shared_mutex stop_token thread)

set(room_names)
foreach(row IN LISTS rooms)
  string(REGEX MATCH "^([^| ]+) *[|] *(.*)$" matched "${row}")
  set(name ${CMAKE_MATCH_1})
  list(APPEND room_names ${name})
  string(REPLACE " " ";" allowed_${name} "${CMAKE_MATCH_2}")
endforeach()

# The room that `path` (relative to the root) lies in; empty if in none.
function(room_of path result)
  set(${result} "" PARENT_SCOPE)
  foreach(name IN LISTS room_names)
    string(FIND "${path}" "${name}/" position)
    if(position EQUAL 0)
      set(${result} ${name} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Is `room` one of `names`, below one of them, or is there a * among them?
function(is_among room names result)
  set(${result} FALSE PARENT_SCOPE)
  foreach(name IN LISTS names)
    string(FIND "${room}/" "${name}/" position)
    if(name STREQUAL "*" OR position EQUAL 0)
      set(${result} TRUE PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

set(doors)
set(house_doors)
set(inner_doors)
foreach(folder core devices study analysis ui)
  read_doors(${ROOT} ${folder} new_doors new_house_doors new_inner_doors)
  list(APPEND doors ${new_doors})
  list(APPEND house_doors ${new_house_doors})
  list(APPEND inner_doors ${new_inner_doors})
endforeach()

# Sets `complaint` if `file` of `room` may not include "path" of the room `target`, because it is no door.
function(judge_door room file target path)
  set(complaint "" PARENT_SCOPE)
  if(path IN_LIST doors OR (path IN_LIST house_doors AND NOT file IN_LIST doors))
    return()
  endif()
  if(file IN_LIST doors)
    set(complaint "\"${path}\": a door includes doors only, and this is none" PARENT_SCOPE)
  elseif(file IN_LIST house_doors)
    set(complaint "\"${path}\": a house door includes doors and house doors only, and this is none" PARENT_SCOPE)
  elseif(NOT target STREQUAL room)
    get_filename_component(around ${target} DIRECTORY)
    string(FIND "${room}/" "${around}/" position)
    if(NOT path IN_LIST inner_doors OR NOT position EQUAL 0)
      set(complaint "\"${path}\": private to ${target}, no door of its card" PARENT_SCOPE)
    endif()
  endif()
endfunction()

# Sets `complaint` if `file` of `room` may not include "path" from our own tree.
function(judge_own room file path)
  set(complaint "" PARENT_SCOPE)
  room_of("${path}" target)
  if(NOT target)
    set(complaint "\"${path}\" names no room: write the path from the repository's root" PARENT_SCOPE)
  elseif(NOT EXISTS "${ROOT}/${path}")
    set(complaint "\"${path}\" does not exist" PARENT_SCOPE)
  elseif(target STREQUAL "tests" AND NOT room STREQUAL "tests")
    set(complaint "\"${path}\": only tests may include tests" PARENT_SCOPE)
  elseif(NOT room STREQUAL "tests")
    set(fine TRUE)
    if(NOT target STREQUAL room)
      is_among(${target} "${allowed_${room}}" fine)
    endif()
    if(fine)
      judge_door(${room} ${file} ${target} ${path})
      set(complaint "${complaint}" PARENT_SCOPE)
    else()
      set(complaint "\"${path}\": ${room} may not include ${target}" PARENT_SCOPE)
    endif()
  endif()
endfunction()

# Sets `complaint` if `file` of `room` may not include <path>.
function(judge_foreign room file path)
  set(complaint "" PARENT_SCOPE)
  if(path MATCHES "^[a-z0-9_]+$")
    if(room MATCHES "^core/(contact|motion|closed_form|surface|tick)$" AND NOT path IN_LIST tick_standard_headers)
      set(complaint "<${path}> has no place in the tick" PARENT_SCOPE)
    elseif(room IN_LIST threadless_rooms AND path IN_LIST thread_headers)
      set(complaint "<${path}>: ${room} has no threads" PARENT_SCOPE)
    endif()
    return()
  endif()
  foreach(row IN LISTS libraries)
    # Fields are parted by " | " so that a pattern may hold alternatives.
    string(REGEX REPLACE " +[|] +" ";" fields "${row}")
    list(GET fields 0 library)
    list(GET fields 1 pattern)
    list(GET fields 2 names)
    list(GET fields 3 kind)
    if(NOT path MATCHES "${pattern}")
      continue()
    endif()
    string(REPLACE " " ";" names "${names}")
    is_among(${room} "${names}" fine)
    if(NOT fine)
      set(complaint "<${path}>: ${library} has no place in ${room}" PARENT_SCOPE)
    elseif(kind STREQUAL "cpp" AND NOT file MATCHES "[.]cpp$" AND NOT room STREQUAL "tests")
      set(complaint "<${path}>: ${library} in .cpp files only" PARENT_SCOPE)
    endif()
    return()
  endforeach()
  set(complaint "<${path}> is in no row of the table of libraries" PARENT_SCOPE)
endfunction()

# What defines a type and a constant at the margin; the second group is its name.
set(type_pattern "^(struct|class|enum class|using) ([A-Za-z0-9]+)( final)?( : .*)? [{=]")
set(constant_pattern "^(constexpr|const) [^=({]* (k[A-Z][A-Za-z0-9]*)( =|{|_|$)")

# Sets `result` to the name that the line defines as one of the patterns says; empty if none.
function(defined_name result line)
  set(${result} "" PARENT_SCOPE)
  foreach(pattern IN LISTS ARGN)
    if(line MATCHES "${pattern}")
      set(${result} ${CMAKE_MATCH_2} PARENT_SCOPE)
      return()
    endif()
  endforeach()
endfunction()

# Sets `complaint` if another source of the folder defines the name too: the preset `program` compiles both as one piece.
function(judge_name file name)
  set(complaint "" PARENT_SCOPE)
  get_filename_component(folder ${file} DIRECTORY)
  set(other "${source_of_${folder}_${name}}")
  if(name AND other AND NOT other STREQUAL file)
    set(complaint "${name} is defined by ${other} too" PARENT_SCOPE)
  elseif(name)
    set(source_of_${folder}_${name} ${file} PARENT_SCOPE)
  endif()
endfunction()

set(faults)
set(types)  # that headers define; rooms_of_<type> says where
set(hidden_types)  # file|line|room|type of those that a .cpp keeps to itself
set(file_count 0)
set(include_count 0)
foreach(folder core devices study analysis ui protocols tests)
  file(GLOB_RECURSE files RELATIVE ${ROOT}
    ${ROOT}/${folder}/*.h ${ROOT}/${folder}/*.hpp ${ROOT}/${folder}/*.cpp ${ROOT}/${folder}/*.c ${ROOT}/${folder}/*.qml)
  foreach(file IN LISTS files)
    math(EXPR file_count "${file_count} + 1")
    room_of(${file} room)
    if(NOT room)
      list(APPEND faults "${file}:1: this folder is no room of the table")
      continue()
    endif()
    if(file MATCHES "[.]qml$" AND NOT room MATCHES "^ui/(controls|experimenter|participant)$")
      list(APPEND faults "${file}:1: QML has no place in ${room}")
      continue()
    endif()
    file(READ ${ROOT}/${file} text)
    # One list item a line, whatever the lines contain.
    string(REGEX REPLACE "[][;\\]" "_" text "${text}")
    string(REPLACE "\n" ";" lines "${text}")
    set(number 0)
    foreach(line IN LISTS lines)
      math(EXPR number "${number} + 1")
      if(line MATCHES "^[ \t]*#[ \t]*include[ \t]*\"([^\"]+)\"")
        judge_own(${room} ${file} "${CMAKE_MATCH_1}")
      elseif(line MATCHES "^[ \t]*#[ \t]*include[ \t]*<([^>]+)>")
        judge_foreign(${room} ${file} "${CMAKE_MATCH_1}")
      elseif(line MATCHES "^[ \t]*#[ \t]*include")
        set(complaint "an include that is neither \"...\" nor <...>")
      else()
        if(NOT room STREQUAL "tests" AND line MATCHES "^(struct|class|enum|using) ")
          defined_name(type "${line}" "${type_pattern}")
          if(type AND file MATCHES "[.]h$")
            list(APPEND types ${type})
            list(APPEND rooms_of_${type} ${room})
          elseif(type)
            list(APPEND hidden_types "${file}|${number}|${room}|${type}")
          endif()
        endif()
        set(complaint "")
        if(room MATCHES "${PASSUNG_TICK_ROOMS}" AND file MATCHES "[.]cpp$" AND line MATCHES "^(struct|class|enum|using|const|constexpr) ")
          defined_name(name "${line}" "${type_pattern}" "${constant_pattern}")
          judge_name(${file} "${name}")
        endif()
        if(NOT complaint)
          continue()
        endif()
      endif()
      math(EXPR include_count "${include_count} + 1")
      if(complaint)
        list(APPEND faults "${file}:${number}: ${complaint}")
      endif()
    endforeach()
  endforeach()
endforeach()

# One word, one meaning: what a header names, no header or source of another room names again.
list(REMOVE_DUPLICATES types)
foreach(type IN LISTS types)
  list(REMOVE_DUPLICATES rooms_of_${type})
  list(LENGTH rooms_of_${type} count)
  if(count GREATER 1)
    list(JOIN rooms_of_${type} " and " where)
    list(APPEND faults "${type}: a type of that name is defined by headers of ${where}")
  endif()
endforeach()
foreach(entry IN LISTS hidden_types)
  string(REPLACE "|" ";" entry "${entry}")
  list(GET entry 0 file)
  list(GET entry 1 number)
  list(GET entry 2 room)
  list(GET entry 3 type)
  if(type IN_LIST types AND NOT room IN_LIST rooms_of_${type})
    list(APPEND faults "${file}:${number}: ${type} is a type of ${rooms_of_${type}} already")
  endif()
endforeach()

# A folder that a reader can survey: at most so many .cpp and .qml files.
set(most_sources 40)
file(GLOB_RECURSE sources RELATIVE ${ROOT} ${ROOT}/core/*.cpp ${ROOT}/devices/*.cpp ${ROOT}/study/*.cpp
  ${ROOT}/analysis/*.cpp ${ROOT}/ui/*.cpp ${ROOT}/ui/*.qml)
set(folders)
foreach(source IN LISTS sources)
  get_filename_component(folder ${source} DIRECTORY)
  list(APPEND folders ${folder})
  list(APPEND sources_of_${folder} ${source})
endforeach()
list(REMOVE_DUPLICATES folders)
foreach(folder IN LISTS folders)
  list(LENGTH sources_of_${folder} count)
  if(count GREATER most_sources)
    list(APPEND faults "${folder}:${count}: sources, at most ${most_sources}: part the folder by ideas")
  endif()
endforeach()

foreach(door IN LISTS doors house_doors inner_doors)
  if(NOT EXISTS ${ROOT}/${door})
    string(REGEX MATCH "^[a-z]+" folder ${door})
    list(APPEND faults "${folder}/README.md:0: the door ${door} does not exist")
  endif()
endforeach()

if(faults)
  list(LENGTH faults count)
  list(JOIN faults "\n" text)
  message(NOTICE "${text}")
  message(FATAL_ERROR "${count} violations in ${file_count} files")
endif()
message(STATUS "${include_count} includes in ${file_count} files, each in its room and through a door")
