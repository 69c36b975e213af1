# Installs the libraries for other projects. find_package(passung) gives the core: passung::core_base, core_geometry …
# core_tick, core_query, core_loop and core_replay. find_package(passung COMPONENTS engine) gives besides what performs
# studies without a user interface, passung::study_run, with the devices and rooms that it stands on. Each target
# brings what it needs. Of the headers only the doors of the rooms' cards are installed, under their path in the tree:
# #include "core/tick/step.h".

include(CMakePackageConfigHelpers)
include(cmake/doors.cmake)

set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/passung)

# passung_install(core FOLDERS core TARGETS passung_flags ...): a component with the doors of these folders.
function(passung_install component)
  cmake_parse_arguments(PACKAGE "" "" "FOLDERS;TARGETS" ${ARGN})
  foreach(folder IN LISTS PACKAGE_FOLDERS)
    string(REGEX MATCH "^[a-z]+" card ${folder})
    read_doors(${PROJECT_SOURCE_DIR} ${card} doors house_doors inner_doors)
    list(FILTER doors INCLUDE REGEX "^${folder}/")
    foreach(door IN LISTS doors)
      get_filename_component(path ${door} DIRECTORY)
      install(FILES ${PROJECT_SOURCE_DIR}/${door} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/passung/${path}
        COMPONENT ${component})
    endforeach()
  endforeach()
  install(TARGETS ${PACKAGE_TARGETS} EXPORT passung_${component}
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component})
  install(EXPORT passung_${component} FILE passung-${component}.cmake NAMESPACE passung:: DESTINATION ${package_dir}
    COMPONENT ${component})
endfunction()

set_target_properties(passung_flags PROPERTIES EXPORT_NAME flags)
set(core_rooms base geometry import shape field shell scene contact motion closed_form surface tick query loop replay)
list(TRANSFORM core_rooms PREPEND passung_core_)
passung_install(core FOLDERS core TARGETS passung_flags ${core_rooms})
if(PASSUNG_PROGRAM)
  set(study_rooms design questionnaire plan protocol measures person session store_schema store_samples store_rows
    store_read store_write store_people store_transfer run)
  list(TRANSFORM study_rooms PREPEND passung_study_)
  passung_install(engine FOLDERS devices study analysis/truth
    TARGETS passung_devices_simulated passung_devices_scripted passung_devices_mouse passung_devices_unit
      passung_devices_spacenavd passung_devices_vrpn passung_devices_haply passung_devices_host passung_devices_backends passung_analysis_truth
    passung_analysis_accuracy passung_analysis_overlap passung_analysis_tick_accuracy ${study_rooms})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/passungConfig.cmake.in
  ${PROJECT_BINARY_DIR}/passungConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/passungConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/passungConfig.cmake ${PROJECT_BINARY_DIR}/passungConfigVersion.cmake
  DESTINATION ${package_dir} COMPONENT core)
install(FILES ${PROJECT_SOURCE_DIR}/analysis/readers/passung.R ${PROJECT_SOURCE_DIR}/analysis/readers/passung.py
  DESTINATION ${CMAKE_INSTALL_DATADIR}/passung/readers COMPONENT engine)
