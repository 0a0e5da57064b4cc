/* SPDX-License-Identifier: MIT */
#include "figures.h"

#include "measure.h"

#include <math.h>
#include <stdlib.h>

static int by_size(const void *a, const void *b) {
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static struct spread spread_of(double *values, uint32_t count) {
    if (!count) return (struct spread){NAN, NAN, NAN};
    qsort(values, count, sizeof *values, by_size);
    return (struct spread){values[count / 2], values[(uint32_t)(0.99 * (count - 1))], values[count - 1]};
}

/* The distance of doubles there. */
static double ulp(double x) {
    int exponent;
    frexp(x, &exponent);
    return ldexp(1, (exponent < -1021 ? -1021 : exponent) - 53);
}

static double t_error(const reference_hit *want, const rg_hit *got) {
    reference_real off = want->t - (reference_real)got->t;
    return fabs((double)off) / ulp((double)want->t);
}

static double normal_error(const reference_hit *want, const rg_hit *got, bool signless) {
    double same = 0, opposite = 0;
    for (int k = 0; k < 3; k++) {
        double is = (double)got->normal[k];
        double off = (double)(want->normal[k] - (reference_real)is);
        double off_turned = (double)(want->normal[k] + (reference_real)is);
        same += off * off;
        opposite += off_turned * off_turned;
    }
    double off = sqrt(signless ? fmin(same, opposite) : same) * 0x1p24;
    return isnan(off) ? 0x1p25 : off; /* no normal at all is as wrong as can be */
}

struct figures figures_of(struct judge *judge, const rg_ray *rays, const rg_hit *hits, uint32_t count, uint32_t step,
                          bool whole, bool measure) {
    struct figures f = {0};
    double *t = bench_allocate(count / step + 1, sizeof *t), *normal = bench_allocate(count / step + 1, sizeof *t);
    uint32_t measured = 0;
    for (uint32_t i = 0; i < count; i += step, f.judged++) {
        const reference_scene *near = judge_near(judge, &rays[i]);
        reference_error error;
        reference_hit want;
        reference_verdict verdict = whole ? reference_compare(near, &rays[i], RG_CULL_NONE, &hits[i], &error)
                                          : reference_compare_place(near, &rays[i], &hits[i], &error);
        bool hit = hits[i].object != RG_NO_OBJECT;
        if (verdict == REFERENCE_WRONG) {
            if (hit) f.wrong++;
            if (!hit) f.missed++;
        }
        if (verdict == REFERENCE_WITHIN_BOUND) f.within++;
        if (verdict == REFERENCE_EQUAL && hit) f.of_bound = fmax(f.of_bound, (double)(error.t / error.t_bound));
        if (!reference_trace(near, &rays[i], RG_CULL_NONE, &want)) continue;
        f.hits++;
        if (!measure || want.object != hits[i].object) continue;
        t[measured] = t_error(&want, &hits[i]);
        normal[measured++] = normal_error(&want, &hits[i], !whole);
    }
    f.t = spread_of(t, measured);
    f.normal = spread_of(normal, measured);
    free(t);
    free(normal);
    return f;
}
