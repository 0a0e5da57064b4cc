/* SPDX-License-Identifier: MIT */
#include "read.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static bool is_word_of(const char *key, const char *words) {
    size_t length = strlen(key);
    for (const char *at = words; (at = strstr(at, key)); at += length) {
        bool begins = at == words || at[-1] == ' ', ends = at[length] == ' ' || !at[length];
        if (begins && ends) return true;
    }
    return false;
}

void read_known_keys(context *c, const json_t *object, const char *words) {
    const char *key;
    json_t *value;
    if (!json_is_object(object)) {
        malformed(c, "expected an object with %s", words);
        return;
    }
    json_object_foreach((json_t *)object, key, value) {
        if (!*key || !is_word_of(key, words)) malformed(c, "unknown field \"%s\"", key);
    }
}

static bool bits_of(const char *text, uint64_t *bits) {
    static const char digits[] = "0123456789abcdef";
    *bits = 0;
    for (; *text; text++) {
        const char *digit = strchr(digits, *text);
        if (!digit) return false;
        *bits = *bits << 4 | (uint64_t)(digit - digits);
    }
    return true;
}

static bool number_of_text(const char *text, double *out) {
    uint64_t bits;
    if (strcmp(text, "inf") == 0) return *out = INFINITY, true;
    if (strcmp(text, "-inf") == 0) return *out = -INFINITY, true;
    if (strcmp(text, "nan") == 0) return *out = NAN, true;
    size_t length = strlen(text);
    if (text[0] != 'x' || (length != 17 && length != 9) || !bits_of(text + 1, &bits)) return false;
    if (length == 17) {
        memcpy(out, &bits, sizeof *out);
    } else {
        uint32_t few = (uint32_t)bits;
        float value;
        memcpy(&value, &few, sizeof value);
        *out = (double)value;
    }
    return true;
}

double read_number(context *c, const json_t *value) {
    double out = 0;
    if (json_is_number(value)) return json_number_value(value);
    const char *text = json_string_value(value);
    if (!text || !number_of_text(text, &out)) malformed(c, "\"%s\" is no number", text ? text : "?");
    return out;
}

static void read_all(context *c, const json_t *array, size_t count, double *out, const char *what) {
    bool fits = json_is_array(array) && json_array_size(array) == count;
    if (!fits) malformed(c, "%s is no array of %zu numbers", what, count);
    for (size_t i = 0; i < count; i++) out[i] = fits ? read_number(c, json_array_get(array, i)) : 0;
}

void read_numbers(context *c, const json_t *object, const char *key, size_t count, double *out) {
    read_all(c, json_object_get(object, key), count, out, key);
}

void read_vector(context *c, const json_t *value, double out[3]) {
    read_all(c, value, 3, out, "a vector");
}

uint64_t read_integer(context *c, const json_t *object, const char *key, uint64_t most, uint64_t missing) {
    const json_t *value = json_object_get(object, key);
    if (!value) return missing;
    if (json_is_integer(value) && json_integer_value(value) >= 0 && (uint64_t)json_integer_value(value) <= most)
        return (uint64_t)json_integer_value(value);
    malformed(c, "%s is no whole number in its range", key);
    return 0;
}

const char *read_text(context *c, const json_t *object, const char *key) {
    const char *text = json_string_value(json_object_get(object, key));
    if (!text) malformed(c, "%s is missing or no text", key);
    return text ? text : "";
}

const json_t *read_array(context *c, const json_t *object, const char *key) {
    const json_t *array = json_object_get(object, key);
    if (json_is_array(array)) return array;
    malformed(c, "%s is missing or no array", key);
    return NULL;
}

static rg_object object_of_bits(context *c, const json_t *value) {
    uint64_t bits = 0;
    read_known_keys(c, value, "id");
    const char *text = read_text(c, value, "id");
    if (strcmp(text, "none") == 0) return RG_NO_OBJECT;
    if (strlen(text) != 17 || text[0] != 'x' || !bits_of(text + 1, &bits)) malformed(c, "\"%s\" is no id", text);
    return bits;
}

rg_object read_object(context *c, const json_t *value) {
    char name[128];
    if (json_is_object(value)) return object_of_bits(c, value);
    const char *text = json_string_value(value), *bracket = text ? strchr(text, '[') : NULL;
    if (!text || strlen(text) >= sizeof name) {
        malformed(c, "a reference to an object is no name");
        return RG_NO_OBJECT;
    }
    strcpy(name, text);
    if (bracket) name[bracket - text] = 0;
    size_t index = bracket ? (size_t)strtoul(bracket + 1, NULL, 10) : 0;
    const named *item = names_find(&c->objects, name);
    if (item && item->many == (bracket != NULL) && index < item->count) return item->values[index];
    malformed(c, "no object is named \"%s\"", text);
    return RG_NO_OBJECT;
}

rg_shape *read_shape(context *c, const char *name) {
    const named *item = names_find(&c->shapes, name);
    if (item && item->shape) return item->shape;
    malformed(c, "no shape is named \"%s\"", name);
    return NULL;
}

rg_grid read_grid(context *c, const json_t *object, const char *key) {
    const char *name = read_text(c, object, key);
    if (strcmp(name, "scene") == 0) return RG_GRID_OF_SCENE;
    const named *item = names_find(&c->grids, name);
    if (item) return (rg_grid)item->values[0];
    malformed(c, "no grid is named \"%s\"", name);
    return RG_GRID_OF_SCENE;
}

rg_pose read_pose(context *c, const json_t *object) {
    rg_pose pose = rg_pose_at(0, 0, 0);
    read_numbers(c, object, "position", 3, pose.position);
    if (json_object_get(object, "linear")) {
        double linear[9];
        read_numbers(c, object, "linear", 9, linear);
        for (int i = 0; i < 9; i++) pose.linear[i] = (float)linear[i];
    }
    return pose;
}

static rg_grid_kind kind_of(context *c, const json_t *value) {
    const char *text = json_string_value(value);
    if (!value) return c->setup->kind;
    if (json_is_integer(value)) return (rg_grid_kind)json_integer_value(value);
    if (text && strcmp(text, "default") == 0) return RG_GRID_DEFAULT;
    if (text && strcmp(text, "uniform") == 0) return RG_GRID_UNIFORM;
    if (text && strcmp(text, "hierarchical") == 0) return RG_GRID_HIERARCHICAL;
    if (text && strcmp(text, "loose") == 0) return RG_GRID_LOOSE;
    malformed(c, "\"%s\" is no kind of grid", text ? text : "?");
    return RG_GRID_DEFAULT;
}

rg_grid_config read_grid_config(context *c, const json_t *object) {
    rg_grid_config config;
    rg_grid_config_default(&config, sizeof config);
    read_known_keys(c, object, "kind resolution lo hi rebuild_factor");
    config.kind = kind_of(c, json_object_get(object, "kind"));
    config.resolution = (uint32_t)read_integer(c, object, "resolution", UINT32_MAX, 0);
    if (json_object_get(object, "lo")) read_numbers(c, object, "lo", 3, config.lo);
    if (json_object_get(object, "hi")) read_numbers(c, object, "hi", 3, config.hi);
    const json_t *factor = json_object_get(object, "rebuild_factor");
    const char *word = json_string_value(factor);
    if (word && strcmp(word, "never") == 0) {
        config.rebuild_factor = RG_REBUILD_NEVER;
    } else if (factor) {
        config.rebuild_factor = read_number(c, factor);
    }
    return config;
}
