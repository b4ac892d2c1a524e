# Installation of the OpenAPI description, man page, shell completions and systemd unit, and the Debian package.

# The unit names the program, whose prefix is known at installation.
install(CODE "
  set(CMAKE_INSTALL_FULL_BINDIR \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}\")
  configure_file(\"${PROJECT_SOURCE_DIR}/packaging/orrery.service.in\"
    \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/orrery.service\" @ONLY)")
install(FILES packaging/orrery.bash RENAME orrery DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES packaging/orrery.zsh RENAME _orrery DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

# The program prints the OpenAPI description, so it must run on this machine.
if(NOT CMAKE_CROSSCOMPILING)
  set(description ${PROJECT_BINARY_DIR}/openapi.json)
  add_custom_command(TARGET orrery POST_BUILD BYPRODUCTS ${description}
    COMMAND $<TARGET_FILE:orrery> openapi > ${description} VERBATIM)
  install(FILES ${description} DESTINATION ${CMAKE_INSTALL_DATADIR}/orrery)
endif()

# The man page contains the help, so the program must run on this machine.
find_program(HELP2MAN help2man)
if(HELP2MAN AND NOT CMAKE_CROSSCOMPILING)
  set(page ${PROJECT_BINARY_DIR}/orrery.1)
  add_custom_command(OUTPUT ${page}
    COMMAND ${HELP2MAN} --no-info --name "render 3D scenes to images"
      --version-string "${PROJECT_VERSION}" --output ${page} $<TARGET_FILE:orrery>
    DEPENDS orrery VERBATIM)
  add_custom_target(man DEPENDS ${page})
  install(FILES ${page} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)
else()
  message(STATUS "help2man is not installed: the man page is not made")
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME orrery)
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Render service for 3D scenes")
set(CPACK_PACKAGE_CONTACT "orrery <orrery@localhost>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
include(CPack)
