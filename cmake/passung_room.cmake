# One static library per room. passung_room(core/base SOURCES a.cpp LINK Eigen3::Eigen PRIVATE_LINK assimp::assimp)
# makes the target passung_core_base with the alias passung::core_base.

include(GNUInstallDirs)

# Headers that were parsed before are no longer the system's to g++ 12, which then warns falsely about their insides.
if(PASSUNG_PRECOMPILE)
  set(PASSUNG_FALSE_WARNINGS $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-Wno-array-bounds;-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-maybe-uninitialized>>)
endif()

# ccache keeps what shares parsed headers only if the compiler names the header in its first pass, or stamps no time in it.
if(PASSUNG_PRECOMPILE AND CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache")
  set(PASSUNG_KEPT_HEADERS
    $<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>>
    "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:Clang>:SHELL:-Xclang -fno-pch-timestamp>>")
endif()

# What every room is compiled with. Deterministic: no contraction, no fast-math, no -march
# that would change results between machines. 16-byte alignment: the layout of the distribution's FCL.
add_library(passung_flags INTERFACE)
# g++ clears away what it parsed again and again while it compiles a room in one piece; not below half a gigabyte.
# -Wrestrict of g++ 12 warns falsely about a string literal assigned to a std::string (its bug 105651).
target_compile_options(passung_flags INTERFACE
  $<BUILD_INTERFACE:-Wall;-Wextra;-Wpedantic;-Wconversion;-Wshadow>
  "$<BUILD_INTERFACE:$<$<CXX_COMPILER_ID:GNU>:--param=ggc-min-heapsize=524288;-Wno-restrict>>"
  ${PASSUNG_FALSE_WARNINGS}
  ${PASSUNG_KEPT_HEADERS}
  $<BUILD_INTERFACE:$<$<BOOL:${PASSUNG_WERROR}>:-Werror>>
  -ffp-contract=off)
target_compile_definitions(passung_flags INTERFACE EIGEN_MAX_ALIGN_BYTES=16)
target_include_directories(passung_flags INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/passung>)
target_compile_features(passung_flags INTERFACE cxx_std_20)

# With PASSUNG_PRECOMPILE what most files include is parsed once, for rooms and for tests; the build by clang, without
# it, shows that what the tests of determinism need still includes what it uses. Code with Qt is compiled otherwise
# (-fPIC) and shares nothing with the rest: the windows and the larger one of their tests parse their own.
set(PASSUNG_COMMON_HEADERS <Eigen/Geometry> <algorithm> <array> <cmath> <filesystem> <functional> <map> <memory>
  <optional> <set> <span> <string> <string_view> <variant> <vector>)
set(PASSUNG_WINDOW_HEADERS ${PASSUNG_COMMON_HEADERS} <QtCore/QCoreApplication> <QtQml/QQmlEngine> <QtQuick/QQuickItem>
  <QtQuick/QQuickWindow>)

# passung_precompile_headers(passung_room_headers LINK passung_flags HEADERS <vector>): a target that parses them.
function(passung_precompile_headers target)
  cmake_parse_arguments(PCH "" "" "LINK;HEADERS" ${ARGN})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/${target}.cpp CONTENT "")
  add_library(${target} STATIC ${PROJECT_BINARY_DIR}/${target}.cpp)
  target_link_libraries(${target} PRIVATE ${PCH_LINK})
  target_precompile_headers(${target} PRIVATE ${PCH_HEADERS})
endfunction()

# passung_reuse_headers(TARGET passung_room_headers "what TARGET links")
function(passung_reuse_headers target headers links)
  if(PASSUNG_PRECOMPILE AND NOT links MATCHES "Qt6::|passung::ui_window")
    target_precompile_headers(${target} REUSE_FROM ${headers})
  endif()
endfunction()

# Compiles the target's sources as one piece, which parses and instantiates once what they share: a fifth of the time.
# The build by clang compiles every file by itself, which shows that each one includes what it uses.
function(passung_one_piece target)
  if(PASSUNG_ONE_PIECE)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
  endif()
endfunction()

# Rooms in which nothing is hot: they wait for files and people, or are as fast so; -O1 compiles them in half the time.
set(PASSUNG_COLD_OPTIONS $<$<NOT:$<CONFIG:Debug>>:-O1>)
set(PASSUNG_COLD_ROOMS "^(core/scene|devices/(mouse|scripted|spacenavd|vrpn|haply|dhd|hd|backends)|analysis/(accuracy|export|power|report|stats|tick_accuracy)|study/(design|plan|protocol|run|session|store/(schema|rows|read|write|people|transfer|postgres))|ui/.*)$")

include(${CMAKE_CURRENT_LIST_DIR}/tick_rooms.cmake)

# passung_cold(TARGET "what TARGET links"): neither it nor its headers are optimised at length.
function(passung_cold target links)
  target_compile_options(${target} PRIVATE ${PASSUNG_COLD_OPTIONS})
  passung_reuse_headers(${target} passung_cold_headers "${links}")
endfunction()

function(passung_room room)
  cmake_parse_arguments(ROOM "" "HEADERS" "SOURCES;LINK;PRIVATE_LINK" ${ARGN})
  if(NOT ROOM_HEADERS)
    set(ROOM_HEADERS passung_room_headers)
  endif()
  string(REPLACE "/" "_" name ${room})
  add_library(passung_${name} STATIC ${ROOM_SOURCES})
  add_library(passung::${name} ALIAS passung_${name})
  set_target_properties(passung_${name} PROPERTIES EXPORT_NAME ${name})
  target_link_libraries(passung_${name} PUBLIC passung_flags ${ROOM_LINK} PRIVATE ${ROOM_PRIVATE_LINK})
  if(room MATCHES "${PASSUNG_COLD_ROOMS}")
    passung_cold(passung_${name} "${ROOM_LINK};${ROOM_PRIVATE_LINK}")
  else()
    passung_reuse_headers(passung_${name} "${ROOM_HEADERS}" "${ROOM_LINK};${ROOM_PRIVATE_LINK}")
  endif()
  if(PASSUNG_TICK_ONE_PIECE OR NOT room MATCHES "${PASSUNG_TICK_ROOMS}")
    passung_one_piece(passung_${name})
  endif()
  if(PASSUNG_TICK_ONE_PIECE AND room MATCHES "${PASSUNG_TICK_ROOMS}")
    # A source within a piece counts as a header, where g++ warns of what only one source may use.
    target_compile_options(passung_${name} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-Wno-subobject-linkage>)
  endif()
endfunction()

# A room with items of Qt; its arguments are passung_room()'s.
function(passung_qt_room room)
  passung_room(${room} ${ARGN})
  string(REPLACE "/" "_" name ${room})
  set_target_properties(passung_${name} PROPERTIES AUTOMOC ON)
endfunction()

# Puts the room's QML files into its library, under their paths in the tree.
function(passung_qml_files room)
  string(REPLACE "/" "_" name ${room})
  file(GLOB qml CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${room}/*.qml)
  qt_add_resources(passung_${name} ${name} PREFIX / BASE ${PROJECT_SOURCE_DIR} FILES ${qml})
endfunction()
