// What --version says.
#pragma once

#include <string>
#include <string_view>

/// The commit that was built, with "-dirty" where files were changed; empty where the sources are in no repository.
std::string_view built_commit();

/// "NAME VERSION (commit)" and a line with the libraries that it was built with and their versions.
std::string version_text(std::string_view program);
