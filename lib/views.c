/* SPDX-License-Identifier: MIT */
#include "views.h"

#include "error.h"

static size_t width(rg_type type) {
    static const size_t widths[] = {8, 4, 1, 2, 4, 8};
    return widths[type];
}

rg_result rgi_refuse_view(const void *data, rg_type type, const char *name) {
    if (!data) return rgi_fail(RG_INVALID_ARGUMENT, "%s is NULL", name);
    return rgi_fail(RG_INVALID_ARGUMENT, "%s.type is %d, which this view can't have", name, (int)type);
}

rg_result rgi_check_view3(const void *x, const void *y, const void *z, rg_type type, unsigned types, int required,
                          const char *name) {
    rg_result result = rgi_check_view(x, type, types, required, name);
    if (result || !x) return result;
    if (!y) return rgi_fail(RG_INVALID_ARGUMENT, "%s.y is NULL, %s.x is not", name, name);
    if (!z) return rgi_fail(RG_INVALID_ARGUMENT, "%s.z is NULL, %s.x is not", name, name);
    return RG_OK;
}

rg_input3 rg_input3_packed(const void *xyz, ptrdiff_t stride, rg_type type) {
    rg_input3 view = {xyz, NULL, NULL, stride, type};
    if (!xyz || type < RG_F64 || type > RG_U64) return view;
    view.y = (const char *)xyz + width(type);
    view.z = (const char *)xyz + 2 * width(type);
    return view;
}

rg_output3 rg_output3_packed(void *xyz, ptrdiff_t stride, rg_type type) {
    rg_output3 view = {xyz, NULL, NULL, stride, type};
    if (!xyz || type < RG_F64 || type > RG_U64) return view;
    view.y = (char *)xyz + width(type);
    view.z = (char *)xyz + 2 * width(type);
    return view;
}
