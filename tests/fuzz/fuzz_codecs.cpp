// The module of codecs as a part of the fuzzers, so that its code is instrumented.
#include "engine/files/codec_library_internal.h"

extern "C" const edgesplat::CodecLibrary* edgesplat_codec_library();

const edgesplat::CodecLibrary& edgesplat::codec_library() {
    return *edgesplat_codec_library();
}
