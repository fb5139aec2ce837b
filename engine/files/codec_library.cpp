#include "engine/files/codec_library_internal.h"

#include <dlfcn.h>

#include "engine/error.h"

namespace edgesplat {
namespace {

constexpr const char* kCodecModule = "edgesplat_codecs.so";

const CodecLibrary& load_codecs() {
    // The path is in the programs' run path. The module is never unloaded.
    void* module = dlopen(kCodecModule, RTLD_LAZY | RTLD_LOCAL);
    if (module == nullptr)
        fail("codecs: {} cannot be loaded: {}; it belongs in lib/edgesplat of the installation", kCodecModule,
             dlerror());
    using Entry = const CodecLibrary*();
    auto* entry = reinterpret_cast<Entry*>(dlsym(module, kCodecLibraryEntry));
    if (entry == nullptr) fail("codecs: {} is of another version: {}", kCodecModule, dlerror());
    return *entry();
}

}  // namespace

const CodecLibrary& codec_library() {
    static const CodecLibrary& library = load_codecs();
    return library;
}

}  // namespace edgesplat
