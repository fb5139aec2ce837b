# Sourced by what runs tests: which Vulkan driver they run on.

# lavapipe's manifest, nothing where it is not installed. Its name has the architecture in it, or not, by Mesa's version;
# with several architectures this machine's own comes first.
lavapipe_manifest() {
    local file folder=/usr/share/vulkan/icd.d
    for file in "$folder/lvp_icd.$(uname -m).json" "$folder/lvp_icd.json" "$folder"/lvp_icd.*.json; do
        if [ -f "$file" ]; then echo "$file"; return; fi
    done
}

# Makes the loader see lavapipe alone, unless EDGESPLAT_TEST_DEVICE says otherwise. Fails where it cannot: on another
# driver tests would measure that one, and say nothing.
choose_test_driver() {
    local manifest
    if [ -n "${EDGESPLAT_TEST_DEVICE:-}" ]; then return 0; fi
    manifest=$(lavapipe_manifest)
    if [ -z "$manifest" ]; then
        echo "no lavapipe in /usr/share/vulkan/icd.d (Debian: mesa-vulkan-drivers); EDGESPLAT_TEST_DEVICE=gpu tests on" \
            "the machine's own driver" >&2
        return 1
    fi
    export VK_DRIVER_FILES=$manifest VK_ICD_FILENAMES=$manifest
}
