/* SPDX-License-Identifier: MIT */
/* arguments.h: the values of options on a command line, checked. All throw UsageError, which names the option. */
#ifndef DEMO_ARGUMENTS_H
#define DEMO_ARGUMENTS_H

#include <cstdint>
#include <raygrid/grid.h>
#include <stdexcept>
#include <string>

namespace demo {

/** What is wrong with the command line. */
struct UsageError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

uint64_t read_number(const char *name, const std::string &text, uint64_t least, uint64_t most);
uint32_t read_count(const char *name, const std::string &text, uint32_t least, uint32_t most);

/** A number that may have a fraction. */
double read_real(const char *name, const std::string &text, double least, double most);

/** WIDTHxHEIGHT, each from 1 to 4096. */
void read_size(const char *name, const std::string &text, uint32_t &width, uint32_t &height);

/** uniform, hierarchical, loose or default. */
rg_grid_kind read_grid_kind(const char *name, const std::string &text);

} // namespace demo

#endif
