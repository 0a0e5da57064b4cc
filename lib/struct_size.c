/* SPDX-License-Identifier: MIT */
#include "struct_size.h"

#include "error.h"

#include <string.h>

/* No public struct will ever be larger: a size field beyond is one that was never set. */
enum { LARGEST = 4096 };

static rg_result check(size_t size, size_t least, const char *name) {
    if (size >= least && size <= LARGEST) return RG_OK;
    return rgi_fail(RG_INVALID_ARGUMENT, "%s.size is %zu, not sizeof(%s), which is at least %zu", name, size, name,
                    least);
}

static size_t size_field(const void *given) {
    size_t size;
    memcpy(&size, given, sizeof size);
    return size;
}

rg_result rgi_struct_read(void *known, size_t known_size, size_t least, const void *given, const char *name) {
    memset(known, 0, known_size);
    if (!given) return RG_OK;
    size_t size = size_field(given);
    rg_result result = check(size, least, name);
    if (result) return result;
    for (size_t i = known_size; i < size; i++) {
        if (((const unsigned char *)given)[i] != 0)
            return rgi_fail(RG_INVALID_ARGUMENT,
                            "%s of %zu bytes uses a field at byte %zu that this library does not have", name, size,
                            i);
    }
    memcpy(known, given, size < known_size ? size : known_size);
    return RG_OK;
}

rg_result rgi_struct_view(const void *given, void *room, size_t known_size, size_t least, const char *name,
                          const void **view) {
    *view = given && size_field(given) == known_size ? given : room;
    return *view == given ? RG_OK : rgi_struct_read(room, known_size, least, given, name);
}

rg_result rgi_struct_write(const void *known, size_t known_size, size_t least, void *given, const char *name) {
    if (!given) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", name);
    size_t size = size_field(given);
    rg_result result = check(size, least, name);
    if (result) return result;
    size_t common = size < known_size ? size : known_size;
    memcpy((char *)given + sizeof size, (const char *)known + sizeof size, common - sizeof size);
    if (size > known_size) memset((char *)given + known_size, 0, size - known_size);
    return RG_OK;
}

rg_result rgi_struct_default(const void *known, size_t known_size, size_t least, void *given, size_t size,
                             const char *name) {
    if (!given) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", name);
    rg_result result = check(size, least, name);
    if (result) return result;
    memcpy(given, &size, sizeof size);
    return rgi_struct_write(known, known_size, least, given, name);
}
