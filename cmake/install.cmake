include(CMakePackageConfigHelpers)
install(DIRECTORY include/verdure DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT verdureTargets NAMESPACE verdure:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/verdure)
configure_package_config_file(
  cmake/verdureConfig.cmake.in ${CMAKE_BINARY_DIR}/verdureConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/verdure)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/verdureConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/verdureConfig.cmake ${CMAKE_BINARY_DIR}/verdureConfigVersion.cmake
        DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/verdure)
