/* SPDX-License-Identifier: MIT */
#include "context.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Beyond so many a case's further failures are only counted. */
enum { PRINTED_FAILURES = 8 };

static void print_failure(const context *c, const char *format, va_list arguments) {
    printf("FAILED %s, grid %s, %u worker%s, step %zu", c->name, c->setup->name, (unsigned)c->workers,
           c->workers == 1 ? "" : "s", c->step);
    if (c->path) printf(", path %s", c->path);
    if (c->ray >= 0) printf(", ray %ld", c->ray);
    printf(": ");
    vprintf(format, arguments);
    printf("\n");
}

void fail(context *c, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (c->failures++ < PRINTED_FAILURES) print_failure(c, format, arguments);
    va_end(arguments);
}

void malformed(context *c, const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    if (!c->broken) print_failure(c, format, arguments);
    va_end(arguments);
    c->failures++;
    c->broken = true;
}

static void named_empty(named *item) {
    rg_shape_release(&item->shape);
    free(item->values);
    item->values = NULL;
    item->count = 0;
    item->many = false;
}

void names_free(names *n) {
    for (size_t i = 0; i < n->count; i++) {
        named_empty(&n->items[i]);
        free(n->items[i].name);
    }
    free(n->items);
    memset(n, 0, sizeof *n);
}

named *names_find(const names *n, const char *name) {
    for (size_t i = 0; i < n->count; i++) {
        if (strcmp(n->items[i].name, name) == 0) return &n->items[i];
    }
    return NULL;
}

static void *must(void *memory) {
    if (!memory) {
        fprintf(stderr, "out of memory\n");
        exit(2);
    }
    return memory;
}

named *names_add(names *n, const char *name, size_t count) {
    named *item = names_find(n, name);
    if (!item) {
        if (n->count == n->room) {
            n->room = n->room ? 2 * n->room : 16;
            n->items = must(realloc(n->items, n->room * sizeof *n->items));
        }
        item = &n->items[n->count++];
        memset(item, 0, sizeof *item);
        item->name = must(malloc(strlen(name) + 1));
        strcpy(item->name, name);
    }
    named_empty(item);
    item->values = must(calloc(count ? count : 1, sizeof *item->values));
    item->count = count;
    return item;
}

const char *object_name(const context *c, rg_object id) {
    static char text[160];
    if (id == RG_NO_OBJECT) return "nothing";
    for (size_t i = 0; i < c->objects.count; i++) {
        const named *item = &c->objects.items[i];
        for (size_t j = 0; j < item->count; j++) {
            if (item->values[j] != id) continue;
            snprintf(text, sizeof text, item->many ? "%s[%zu]" : "%s", item->name, j);
            return text;
        }
    }
    snprintf(text, sizeof text, "an unknown id %016" PRIx64, id);
    return text;
}
