#include <dlfcn.h>

#include "engine/error.h"
#include "engine/files/picture_library_internal.h"

namespace edgesplat {
namespace {

constexpr const char* kModule = "edgesplat_pictures.so";

const PictureLibrary& load() {
    // The path is in the programs' run path. The module is never unloaded: some of its libraries crash on unloading.
    void* module = dlopen(kModule, RTLD_LAZY | RTLD_LOCAL);
    if (module == nullptr)
        fail("pictures: {} cannot be loaded: {}; it belongs in lib/edgesplat of the installation", kModule, dlerror());
    using Entry = const PictureLibrary*();
    auto* entry = reinterpret_cast<Entry*>(dlsym(module, kPictureLibraryEntry));
    if (entry == nullptr) fail("pictures: {} is of another version: {}", kModule, dlerror());
    return *entry();
}

}  // namespace

const PictureLibrary& picture_library() {
    static const PictureLibrary& library = load();
    return library;
}

}  // namespace edgesplat
