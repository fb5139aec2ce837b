#!/usr/bin/env bash
# Prints each line that tests for a device or driver outside engine/gpu/device_profile; other code must use the device
# profile. The help of the option that forces a profile may name profiles, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

readonly ASKS='is_software|llvmpipe|lavapipe|swiftshader|"Cpu"|eCpu\b|driverID'
found=$(grep -rnEi --include='*.h' --include='*.cpp' "$ASKS" engine apps python/src |
    grep -vE '^engine/gpu/device_profile\.(h|cpp):|^apps/device_options\.cpp:.*"Use this device profile') || true
if [ -n "$found" ]; then
    printf '%s\n' "$found"
    exit 1
fi
