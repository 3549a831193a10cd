#!/usr/bin/env bash
# SPDX-FileCopyrightText: 2026 the petal authors
# SPDX-License-Identifier: BSD-3-Clause

# Builds with sanitizers and runs all test programs: scripts/checks/sanitizers.sh address,undefined|thread [CMAKE OPTION]...
# The build goes to build/<sanitizers>/.
set -euo pipefail
cd "$(dirname "$0")/../.."

sanitizers=$1
shift
folder=build/${sanitizers//,/-}
BUILD_FOLDER=$folder CMAKE_OPTIONS="-DPETAL_SANITIZE=$sanitizers -DCMAKE_BUILD_TYPE=Debug -DPETAL_BENCHMARKS=OFF $*" scripts/build.sh
# Debian's libraries are built without: a report must come from petal's own code.
export TSAN_OPTIONS="ignore_noninstrumented_modules=1 halt_on_error=1 second_deadlock_stack=1"
export ASAN_OPTIONS="detect_stack_use_after_return=1" UBSAN_OPTIONS="print_stacktrace=1"
scripts/checks/run_tests.sh "$folder"
