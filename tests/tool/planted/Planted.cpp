// SPDX-License-Identifier: MIT
#include <cstdio>
#include <cstdlib>

// A library that shows that it was loaded: it writes the file OSGGPUANIMATION_MARKER.

namespace
{

const bool isMarked = []
{
    const char* const name = std::getenv("OSGGPUANIMATION_MARKER");
    std::FILE* const marker = name ? std::fopen(name, "w") : nullptr;
    return marker && std::fclose(marker) == 0;
}();

} // namespace
