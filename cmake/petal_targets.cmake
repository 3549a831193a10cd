# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# The warnings and flags of petal's own targets. PRIVATE: they never reach whoever links petal.
function(petal_flags target)
    target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wconversion -Wsign-conversion
                           -Wshadow -Woverloaded-virtual -Wnon-virtual-dtor -Wcast-qual)
    if(PETAL_WERROR)
        target_compile_options(${target} PRIVATE -Werror)
    endif()
    if(PETAL_SANITIZE)
        # Left out are UBSan's checks of each access to memory, most of which ASan makes too: they double the
        # time to compile.
        target_compile_options(${target} PRIVATE -O1 -g1 -fsanitize=${PETAL_SANITIZE} -fno-omit-frame-pointer
                               -fno-sanitize-recover=all -fno-sanitize=null,object-size,vptr,alignment)
        target_link_options(${target} PRIVATE -fsanitize=${PETAL_SANITIZE})
    endif()
endfunction()

# For code that runs once (tests, the command line): time to compile counts more than time to run.
function(petal_compile_quickly target)
    target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
endfunction()

# petal_add_plugin(<kind> SOURCES ... [LINK ...]): the stages of one folder as <build>/lib/petal/petal_<kind>.so.
# Its code lies in the static library petal_<kind>_stages, which the tests link too; plugin.cpp registers it.
function(petal_add_plugin kind)
    cmake_parse_arguments(ARG "" "" "SOURCES;LINK" ${ARGN})
    add_library(petal_${kind}_stages STATIC ${ARG_SOURCES})
    petal_flags(petal_${kind}_stages)
    target_include_directories(petal_${kind}_stages PUBLIC ${CMAKE_SOURCE_DIR}/plugins)
    target_link_libraries(petal_${kind}_stages PUBLIC petal::calibration petal::framework ${ARG_LINK})
    add_library(petal_${kind} MODULE plugin.cpp)
    petal_flags(petal_${kind})
    target_link_libraries(petal_${kind} PRIVATE petal_${kind}_stages)
    set_target_properties(petal_${kind} PROPERTIES PREFIX ""
                          LIBRARY_OUTPUT_DIRECTORY ${PETAL_PLUGIN_OUTPUT_DIRECTORY}
                          INSTALL_RPATH "\$ORIGIN/..")
    if(NOT PETAL_SANITIZE)
        target_link_options(petal_${kind} PRIVATE -Wl,-z,defs)
    endif()
    install(TARGETS petal_${kind} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/petal)
endfunction()
