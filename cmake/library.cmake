# Installation of the core library as the CMake package `orrery` with the target orrery::core.

target_include_directories(liborrery.${base_level} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}/orrery>)
target_compile_features(liborrery.${base_level} INTERFACE cxx_std_20)
set_target_properties(liborrery.${base_level} PROPERTIES EXPORT_NAME core)
install(TARGETS liborrery.${base_level} EXPORT orrery LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY core ${generated}/core DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/orrery
  FILES_MATCHING PATTERN "*.h" PATTERN decoder EXCLUDE)

include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/orrery)
install(EXPORT orrery NAMESPACE orrery:: FILE orreryTargets.cmake DESTINATION ${package_folder})
configure_package_config_file(cmake/orreryConfig.cmake.in ${PROJECT_BINARY_DIR}/orreryConfig.cmake
  INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/orreryConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/orreryConfig.cmake ${PROJECT_BINARY_DIR}/orreryConfigVersion.cmake
  DESTINATION ${package_folder})
