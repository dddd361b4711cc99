// SPDX-License-Identifier: MIT
// Part of each plugin on Windows: OSG unloads its plugins at its end, when scenes that have their code may exist.
#include <windows.h>

namespace
{

bool keepLoaded()
{
    HMODULE module = nullptr;
    const DWORD flags = GET_MODULE_HANDLE_EX_FLAG_FROM_ADDRESS | GET_MODULE_HANDLE_EX_FLAG_PIN;
    return GetModuleHandleExW(flags, reinterpret_cast<LPCWSTR>(&keepLoaded), &module) != 0;
}

const bool isKept = keepLoaded();

} // namespace
