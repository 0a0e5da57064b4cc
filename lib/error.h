/* SPDX-License-Identifier: MIT */
/* The message of the last failure, one a thread. */
#ifndef RAYGRID_LIB_ERROR_H
#define RAYGRID_LIB_ERROR_H

#include <raygrid/base.h>

#include <stdbool.h>

#if defined(__GNUC__)
#define RGI_PRINTF(f, a) __attribute__((format(printf, f, a)))
#else
#define RGI_PRINTF(f, a)
#endif

/** Keeps the message for rg_error_message and returns `result`, so that a check reads `return rgi_fail(...)`. */
rg_result rgi_fail(rg_result result, const char *format, ...) RGI_PRINTF(2, 3);

/** While this thread is quiet, failures leave the message alone: for what a call tries but does not need. */
void rgi_fail_quietly(bool quiet);

/** Puts text in front of the message that is kept, for instance which of many objects it is about. */
void rgi_fail_prefix(const char *format, ...) RGI_PRINTF(1, 2);

#endif
