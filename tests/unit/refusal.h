// A helper that returns the message of a thrown Error.
#pragma once

#include <string>

#include "engine/error.h"

namespace edgesplat {

/// The message of the Error that `work` throws; empty if it throws none.
template <typename Work>
std::string refusal(const Work& work) {
    try {
        work();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

}  // namespace edgesplat
