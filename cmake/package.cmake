# The package: what `cmake --install` puts where, what find_package(mote) finds, and the .deb files of CPack.
# docs/design.md, "The package", says why it is as it is.

# The components, from the ground up: one library each. Another library of mote that others may link gets its place
# here, its folder of headers below if it has one of its own, and what it stands on in NEEDS_name.
set(mote_package_components core_runtime core media lights picture_lights compensation gathering screenspace integrators
    session)
if(TARGET mote_c)
  list(APPEND mote_package_components c)  # libmote_c.so, with all that it needs inside, and mote/mote.h
endif()
set(NEEDS_core core_runtime)
set(NEEDS_media core_runtime)
set(NEEDS_lights media)
set(NEEDS_picture_lights lights core)
set(NEEDS_compensation lights)
set(NEEDS_gathering lights)
set(NEEDS_screenspace lights)
set(NEEDS_integrators picture_lights compensation gathering screenspace)
set(NEEDS_session integrators)
set(mote_package_folders core media lights compensation gathering screenspace integrators session)

# ---- Headers as others include them, in build/.../include/mote
set(mote_include ${PROJECT_BINARY_DIR}/include/mote)
configure_file(${PROJECT_SOURCE_DIR}/cmake/version.h.in ${mote_include}/version.h @ONLY)
list(JOIN mote_package_folders "|" package_folders)
set(write_headers ${CMAKE_COMMAND} -DSOURCE=${PROJECT_SOURCE_DIR} -DOUT=${mote_include} -DFOLDERS=${package_folders}
    -DVERSION=${PROJECT_VERSION} -P ${PROJECT_SOURCE_DIR}/cmake/package_headers.cmake)
add_custom_target(mote_package_headers COMMAND ${write_headers} BYPRODUCTS ${mote_include}/interface.h VERBATIM)
if(NOT PROJECT_IS_TOP_LEVEL)
  add_dependencies(mote_core_runtime mote_package_headers)  # so they are there before a guest's files are compiled
endif()

# ---- The reference of the public headers, by Doxygen: build target `reference`, in build/.../reference/html
find_program(MOTE_DOXYGEN doxygen)
find_package(Python3 QUIET COMPONENTS Interpreter)
if(MOTE_DOXYGEN AND Python3_EXECUTABLE AND PROJECT_IS_TOP_LEVEL)
  configure_file(${PROJECT_SOURCE_DIR}/docs/reference/Doxyfile.in ${PROJECT_BINARY_DIR}/reference/Doxyfile @ONLY)
  add_custom_target(reference
    COMMAND ${CMAKE_COMMAND} -E rm -rf ${PROJECT_BINARY_DIR}/reference/headers
    COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/docs/reference/house_style.py ${PROJECT_SOURCE_DIR}
            ${PROJECT_BINARY_DIR}/reference/headers
    COMMAND ${MOTE_DOXYGEN} ${PROJECT_BINARY_DIR}/reference/Doxyfile
    COMMENT "Reference of the public headers" VERBATIM)
endif()

if(NOT MOTE_INSTALL)
  return()
endif()
include(CMakePackageConfigHelpers)

# ---- The command, and the helper program that the library and the command start
if(MOTE_BUILD_APPS)
  install(TARGETS mote RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT mote)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/share/ DESTINATION ${CMAKE_INSTALL_DATAROOTDIR} COMPONENT mote)
endif()
set(mote_helper_folder ${CMAKE_INSTALL_LIBEXECDIR}/mote)
install(TARGETS mote_grid_reader RUNTIME DESTINATION ${mote_helper_folder} COMPONENT mote)
install(FILES LICENSE README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT mote)
install(DIRECTORY examples DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT dev)

# ---- Libraries and headers
install(CODE "execute_process(COMMAND ${CMAKE_COMMAND} \"-DSOURCE=${PROJECT_SOURCE_DIR}\" \"-DOUT=${mote_include}\"
  \"-DFOLDERS=${package_folders}\" -DVERSION=${PROJECT_VERSION} -P \"${PROJECT_SOURCE_DIR}/cmake/package_headers.cmake\"
  COMMAND_ERROR_IS_FATAL ANY)" COMPONENT dev)
install(DIRECTORY ${mote_include} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)

# For those without CMake: mote-NAME.pc of each component, and mote.pc of all but the C interface. What static libraries
# are linked with is private, so `pkg-config --static` names it; a component asks for no more than it uses.
set(LINKS_core_runtime "-lembree${EMBREE_VERSION_MAJOR} -ltbb -lfmt -pthread")
set(LINKS_core "-lpugixml -lpng -ljpeg -lassimp -lz")
set(PACKAGES_core OpenEXR)
set(LINKS_media "-ldl")
function(mote_pkg_config component)
  set(name mote-${component})
  set(libraries "-L\${libdir} -lmote_${component}")
  list(TRANSFORM NEEDS_${component} PREPEND mote- OUTPUT_VARIABLE requires)
  list(JOIN requires " " requires)
  if(component STREQUAL "all")
    set(name mote)
    set(libraries "")
    set(requires mote-session)
  endif()
  set(private "Requires.private: ${PACKAGES_${component}}\nLibs.private: ${LINKS_${component}}")
  if(MOTE_SHARED)
    set(private "")
  endif()
  file(RELATIVE_PATH prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc @ONLY CONTENT
"prefix=\${pcfiledir}/@prefix@
libdir=\${prefix}/@CMAKE_INSTALL_LIBDIR@
includedir=\${prefix}/@CMAKE_INSTALL_INCLUDEDIR@

Name: @name@
Description: @PROJECT_DESCRIPTION@
Version: @PROJECT_VERSION@
Requires: @requires@
Libs: @libraries@
@private@
Cflags: -I\${includedir} -DGLM_FORCE_CTOR_INIT
")
  install(FILES ${PROJECT_BINARY_DIR}/pkgconfig/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT dev)
endfunction()

set(mote_cmake_folder ${CMAKE_INSTALL_LIBDIR}/cmake/mote)
set(libraries_component dev)
if(MOTE_SHARED)
  set(libraries_component mote)
endif()
set(mote_package_needs "")
if(TARGET mote_c)
  if(MOTE_SHARED)
    set(NEEDS_c session)  # whose libraries are then not within it
  endif()
  install(FILES plugins/c/mote.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/mote COMPONENT dev)
endif()
foreach(component ${mote_package_components})
  set(targets mote_${component})
  if(component STREQUAL "core_runtime")
    set_target_properties(mote_api PROPERTIES EXPORT_NAME api)
    list(APPEND targets mote_api)
  endif()
  set(libraries_of_this ${libraries_component})
  if(component STREQUAL "c")
    set(libraries_of_this mote)
  endif()
  install(TARGETS ${targets} EXPORT mote-${component}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${libraries_of_this} NAMELINK_COMPONENT dev
          INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT mote-${component} NAMESPACE mote:: FILE mote-${component}.cmake DESTINATION ${mote_cmake_folder}
          COMPONENT dev)
  string(APPEND mote_package_needs "set(mote_${component}_needs ${NEEDS_${component}})\n")
  mote_pkg_config(${component})
endforeach()
mote_pkg_config(all)
configure_package_config_file(cmake/mote-config.cmake.in ${PROJECT_BINARY_DIR}/mote-config.cmake
  INSTALL_DESTINATION ${mote_cmake_folder} PATH_VARS mote_helper_folder)
# While the major version is 0 the minor one counts as major.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/mote-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/mote-config.cmake ${PROJECT_BINARY_DIR}/mote-config-version.cmake
        DESTINATION ${mote_cmake_folder} COMPONENT dev)

# ---- `cpack -G DEB` in the build folder: mote_..._amd64.deb with the command, mote-dev_..._amd64.deb with the libraries.
# What mote needs of the system dpkg-shlibdeps finds in the binaries; what mote-dev's headers and static libraries ask
# of those who link them is written here.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME mote)
set(CPACK_PACKAGE_VENDOR mote)
set(CPACK_PACKAGE_CONTACT "The mote authors <mote@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Many-light rendering and participating media")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_ALL mote dev)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_MOTE_PACKAGE_NAME mote)
set(CPACK_DEBIAN_MOTE_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_DEV_PACKAGE_NAME mote-dev)
set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "mote (= ${PROJECT_VERSION}), libembree-dev, libglm-dev, libtbb-dev, libfmt-dev, \
libpugixml-dev, libopenexr-dev, libimath-dev, python3-imath, libpng-dev, libjpeg-dev, libassimp-dev, \
zlib1g-dev")
set(CPACK_COMPONENT_MOTE_DESCRIPTION "The mote command: renders scenes with many-light methods, path tracing and
participating media, and compares pictures.")
set(CPACK_COMPONENT_DEV_DESCRIPTION "Libraries, headers and the CMake package of mote, for renderers and programs that
call its algorithms.")
include(CPack)
