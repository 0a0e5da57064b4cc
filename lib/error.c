/* SPDX-License-Identifier: MIT */
#include "error.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum { MESSAGE_SIZE = 320 };

static __thread char message[MESSAGE_SIZE];
static __thread bool is_quiet;

void rgi_fail_quietly(bool quiet) {
    is_quiet = quiet;
}

rg_result rgi_fail(rg_result result, const char *format, ...) {
    va_list arguments;
    if (is_quiet) return result;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return result;
}

void rgi_fail_prefix(const char *format, ...) {
    char prefix[96];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(prefix, sizeof prefix, format, arguments);
    va_end(arguments);
    size_t shift = strlen(prefix), length = strlen(message);
    if (shift + length >= sizeof message) length = sizeof message - shift - 1;
    memmove(message + shift, message, length);
    memcpy(message, prefix, shift);
    message[shift + length] = '\0';
}

const char *rg_error_message(void) {
    return message;
}

const char *rg_result_name(rg_result result) {
    switch (result) {
    case RG_OK:
        return "RG_OK";
    case RG_INVALID_ARGUMENT:
        return "RG_INVALID_ARGUMENT";
    case RG_INVALID_VALUE:
        return "RG_INVALID_VALUE";
    case RG_INVALID_ID:
        return "RG_INVALID_ID";
    case RG_LIMIT_EXCEEDED:
        return "RG_LIMIT_EXCEEDED";
    case RG_OUT_OF_MEMORY:
        return "RG_OUT_OF_MEMORY";
    case RG_OUT_OF_THREADS:
        return "RG_OUT_OF_THREADS";
    case RG_BUSY:
        return "RG_BUSY";
    case RG_CALLBACK_FAILED:
        return "RG_CALLBACK_FAILED";
    case RG_INVALID_DATA:
        return "RG_INVALID_DATA";
    default:
        return "unknown";
    }
}

uint32_t rg_version(void) {
    return RG_VERSION_MAJOR * 1000000u + RG_VERSION_MINOR * 1000u + RG_VERSION_PATCH;
}
