#!/usr/bin/env bash
# Prints each place that asks which device or driver there is, but for the one that may (engine/gpu/device_profile): all
# else asks the device's profile what to do. Profiles are named in the help of the option that forces one, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly ASKS='is_software|llvmpipe|lavapipe|swiftshader|"Cpu"|eCpu\b|driverID'
found=$(grep -rnEi --include='*.h' --include='*.cpp' "$ASKS" engine apps python/src |
    grep -vE '^engine/gpu/device_profile\.(h|cpp):|^apps/device_options\.cpp:.*"How frames are made') || true
if [ -n "$found" ]; then
    printf '%s\n' "$found"
    exit 1
fi
