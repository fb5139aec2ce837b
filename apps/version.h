// Text of --version.
#pragma once

#include <string>
#include <string_view>

/// The commit that was built, with "-dirty" if files were changed; empty if the sources are not in a repository.
std::string_view built_commit();

/// "NAME VERSION (commit)" and a line with the names and versions of the libraries.
std::string version_text(std::string_view program);
