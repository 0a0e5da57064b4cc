/* SPDX-License-Identifier: MIT */
#include "arguments.h"

#include <cerrno>
#include <cstdio>
#include <cstdlib>

namespace demo {

/* strtoull takes signs and blanks, which a count has none of. */
uint64_t read_number(const char *name, const std::string &text, uint64_t least, uint64_t most) {
    char *end = nullptr;
    errno = 0;
    const bool digits = !text.empty() && text[0] >= '0' && text[0] <= '9';
    const unsigned long long value = digits ? std::strtoull(text.c_str(), &end, 10) : 0;
    if (!digits || *end != '\0' || errno != 0 || value < least || value > most)
        throw UsageError("--" + std::string(name) + " wants a number from " + std::to_string(least) + " to " +
                         std::to_string(most) + ", not '" + text + "'");
    return value;
}

uint32_t read_count(const char *name, const std::string &text, uint32_t least, uint32_t most) {
    return static_cast<uint32_t>(read_number(name, text, least, most));
}

double read_real(const char *name, const std::string &text, double least, double most) {
    char *end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end == text.c_str() || *end != '\0' || !(value >= least && value <= most)) {
        char range[80];
        std::snprintf(range, sizeof range, "from %g to %g", least, most);
        throw UsageError("--" + std::string(name) + " wants a number " + range + ", not '" + text + "'");
    }
    return value;
}

void read_size(const char *name, const std::string &text, uint32_t &width, uint32_t &height) {
    const size_t cross = text.find('x');
    if (cross == std::string::npos)
        throw UsageError("--" + std::string(name) + " wants WIDTHxHEIGHT, not '" + text + "'");
    width = read_count(name, text.substr(0, cross), 1, 4096);
    height = read_count(name, text.substr(cross + 1), 1, 4096);
}

rg_grid_kind read_grid_kind(const char *name, const std::string &text) {
    if (text == "uniform") return RG_GRID_UNIFORM;
    if (text == "hierarchical") return RG_GRID_HIERARCHICAL;
    if (text == "loose") return RG_GRID_LOOSE;
    if (text == "default") return RG_GRID_DEFAULT;
    throw UsageError("--" + std::string(name) + " wants uniform, hierarchical, loose or default, not '" + text + "'");
}

} // namespace demo
