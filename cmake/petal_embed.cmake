# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# petal_embed(<variable> <name> <constant>=<file>...): text files as constants of a library. Writes <name>.hpp, which
# declares `extern const std::string_view <constant>` in namespace petal, and <name>.cpp into the build folder when CMake
# is configured, and again when a file changes; <variable> holds the source. At configuration, not by a rule of the build:
# clang-tidy reads a configured tree that nobody built.
function(petal_embed variable name)
    set(header "// Written by petal_embed().\n#pragma once\n\n#include <string_view>\n\nnamespace petal {\n\n")
    set(source "// Written by petal_embed().\n#include \"${name}.hpp\"\n\nnamespace petal {\n\n")
    foreach(pair ${ARGN})
        string(FIND "${pair}" "=" at)
        string(SUBSTRING "${pair}" 0 ${at} constant)
        math(EXPR at "${at} + 1")
        string(SUBSTRING "${pair}" ${at} -1 file)
        set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${file}")
        file(READ "${file}" text)
        string(FIND "${text}" ")petal~\"" inside)
        if(NOT inside EQUAL -1)
            message(FATAL_ERROR "${file} holds )petal~\", which ends the text of a constant")
        endif()
        string(APPEND header "extern const std::string_view ${constant};\n")
        string(APPEND source "const std::string_view ${constant} = R\"petal~(${text})petal~\";\n\n")
    endforeach()
    string(APPEND header "\n}  // namespace petal\n")
    string(APPEND source "}  // namespace petal\n")
    foreach(part header source)
        set(end ".cpp")
        if(part STREQUAL "header")
            set(end ".hpp")
        endif()
        set(path "${CMAKE_CURRENT_BINARY_DIR}/${name}${end}")
        set(before "")
        if(EXISTS "${path}")
            file(READ "${path}" before)
        endif()
        if(NOT before STREQUAL "${${part}}")  # an unchanged file is not compiled again
            file(WRITE "${path}" "${${part}}")
        endif()
    endforeach()
    set(${variable} "${CMAKE_CURRENT_BINARY_DIR}/${name}.cpp" PARENT_SCOPE)
endfunction()
