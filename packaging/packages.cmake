# `cmake --install`, `make install PREFIX=...` and the Debian packages `stc` and `stvm` (R-12). Two
# components of the same names: a machine that only runs programs needs no compiler.
include(GNUInstallDirs)
string(REPLACE "-" "~" CPACK_PACKAGE_VERSION ${STC_VERSION})  # 0.2.0~dev comes before 0.2.0
set(CPACK_PACKAGE_CONTACT "The developers of stc <stc@users.noreply.github.com>")
set(docs ${CMAKE_INSTALL_DATAROOTDIR}/doc)

# Who goes through a fleet has the compiler, and controllers have neither.
install(TARGETS stc stvm-fleet RUNTIME COMPONENT stc)
install(TARGETS stvm RUNTIME COMPONENT stvm)
# A controller that no broker leads to needs no libmosquitto.
install(TARGETS stvm-agent RUNTIME COMPONENT stvm-agent)
install(FILES packaging/debian/copyright DESTINATION ${docs}/stvm-agent COMPONENT stvm-agent)
install(FILES packaging/debian/copyright DESTINATION ${docs}/stc COMPONENT stc)
install(FILES packaging/debian/copyright DESTINATION ${docs}/stvm COMPONENT stvm)
foreach(package stc stvm stvm-agent)
  set(changelog ${CMAKE_BINARY_DIR}/generated/packages/${package}/changelog)
  file(CONFIGURE OUTPUT ${changelog} CONTENT "${package} (${CPACK_PACKAGE_VERSION}) unstable; urgency=medium

  * What is new: CHANGELOG.md of the sources.

 -- ${CPACK_PACKAGE_CONTACT}  Thu, 01 Jan 2026 00:00:00 +0000
" @ONLY)
  execute_process(COMMAND gzip -9nkf ${changelog})
  install(FILES ${changelog}.gz DESTINATION ${docs}/${package} COMPONENT ${package})
endforeach()
install(FILES README.md DESTINATION ${docs}/stc COMPONENT stc)
install(DIRECTORY docs/ DESTINATION ${docs}/stc COMPONENT stc PATTERN adr EXCLUDE)
install(DIRECTORY examples DESTINATION ${docs}/stc COMPONENT stc USE_SOURCE_PERMISSIONS)
# Where Ansible looks for modules by itself, below /usr.
install(FILES ansible/stvm_change.py DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/ansible/plugins/modules
        COMPONENT stc)
install(FILES docs/FLEET.md docs/KEYS.md DESTINATION ${docs}/stvm-agent COMPONENT stvm-agent)
install(FILES docs/RUNNING.md docs/SECURITY.md docs/KEYS.md docs/IO.md DESTINATION ${docs}/stvm COMPONENT stvm)

foreach(tool stc stvm)
  file(GLOB pages ${CMAKE_SOURCE_DIR}/share/man/man1/${tool}*.1)
  foreach(page ${pages})
    get_filename_component(name ${page} NAME)
    set(packed ${CMAKE_BINARY_DIR}/generated/packages/${tool}/${name}.gz)
    execute_process(COMMAND gzip -9nc ${page} OUTPUT_FILE ${packed})
    install(FILES ${packed} DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT ${tool})
  endforeach()
  install(FILES share/bash-completion/completions/${tool}
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/bash-completion/completions COMPONENT ${tool})
  install(FILES share/zsh/site-functions/_${tool}
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/zsh/vendor-completions COMPONENT ${tool})
  install(FILES share/fish/vendor_completions.d/${tool}.fish
          DESTINATION ${CMAKE_INSTALL_DATAROOTDIR}/fish/vendor_completions.d COMPONENT ${tool})
endforeach()

# The units name the program where it is installed, which is known then only.
foreach(unit stvm stvm-agent)
  install(CODE "
    file(READ \"${CMAKE_SOURCE_DIR}/packaging/systemd/${unit}@.service\" unit)
    string(REPLACE /usr/bin/stvm \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_BINDIR}/stvm\" unit \"\${unit}\")
    set(place \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/lib/systemd/system/${unit}@.service\")
    message(STATUS \"Installing: \${place}\")
    file(WRITE \"\${place}\" \"\${unit}\")
  " COMPONENT ${unit})
endforeach()
install(FILES packaging/systemd/stvm.conf DESTINATION lib/sysusers.d COMPONENT stvm)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME stc)
set(CPACK_PACKAGE_VENDOR stc)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL stc stvm stvm-agent)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_ENABLE_COMPONENT_DEPENDS ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SECTION devel)
set(CPACK_DEBIAN_STC_PACKAGE_NAME stc)
set(CPACK_DEBIAN_STVM_PACKAGE_NAME stvm)
set(scripts ${CMAKE_SOURCE_DIR}/packaging/debian)
set(CPACK_DEBIAN_STVM_PACKAGE_CONTROL_EXTRA ${scripts}/postinst ${scripts}/prerm ${scripts}/postrm)
set(CPACK_DEBIAN_STVM_PACKAGE_DEPENDS systemd)
set(CPACK_DEBIAN_STVM-AGENT_PACKAGE_NAME stvm-agent)
set(CPACK_DEBIAN_STVM-AGENT_PACKAGE_DEPENDS "stvm (= ${CPACK_PACKAGE_VERSION})")
set(CPACK_DEBIAN_STVM-AGENT_PACKAGE_RECOMMENDS curl)
set(CPACK_DEBIAN_STVM-AGENT_PACKAGE_CONTROL_EXTRA ${scripts}/agent/postinst ${scripts}/agent/prerm
    ${scripts}/agent/postrm)
set(CPACK_DEBIAN_STC_DESCRIPTION "compiler of IEC 61131-3 programs
Structured Text, ladder, function block diagrams, charts and instruction
lists become an image for stvm, a soft PLC whose running program can be
changed without stopping.")
set(CPACK_DEBIAN_STVM_DESCRIPTION "soft PLC whose running program can be changed
Runs images of stc scan by scan. A changed program is brought to the
running one between two scans: variables keep their values, and the change
can be undone.")
set(CPACK_DEBIAN_STVM-AGENT_DESCRIPTION "connects a controller of stvm to a broker
`stvm agent` keeps one TLS connection to a broker of MQTT, says there what
its controller is and has, and carries out orders that a trusted key has
signed: edits go on trial, become final, or go again.")
include(CPack)
