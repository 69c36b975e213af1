# Installs the core as a library for other projects: find_package(passung) gives passung::core_base, core_geometry …
# core_tick, core_query, core_loop and core_replay, each with what it needs. Headers keep their room in the path: #include "core/tick/step.h".

include(CMakePackageConfigHelpers)

set(core_rooms base geometry import shape field shell scene contact motion tick query loop replay)
set(core_targets passung_flags)
foreach(room ${core_rooms})
  list(APPEND core_targets passung_core_${room})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/core/${room}
    DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/passung/core COMPONENT core
    FILES_MATCHING PATTERN *.h)
endforeach()

set_target_properties(passung_flags PROPERTIES EXPORT_NAME flags)
install(TARGETS ${core_targets} EXPORT passungTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT core)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/passung)
install(EXPORT passungTargets NAMESPACE passung:: DESTINATION ${package_dir} COMPONENT core)
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/passungConfig.cmake.in
  ${PROJECT_BINARY_DIR}/passungConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/passungConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/passungConfig.cmake ${PROJECT_BINARY_DIR}/passungConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT core)
