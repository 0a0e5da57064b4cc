/* SPDX-License-Identifier: MIT */
#include "evaluation.h"

#include <math.h>

json_t *evaluation_array(struct evaluation *evaluation, const char *name) {
    return json_object_get(evaluation->report, name);
}

json_t *evaluation_number(double x) {
    return isfinite(x) ? json_real(x) : json_null();
}

static json_t *verdict(const struct exact_error *error) {
    return json_pack("{s:i, s:i}", "checked", error->checked, "wrong", error->wrong);
}

json_t *evaluation_judge_own(struct evaluation *evaluation, struct exact_sample *sample, const struct own *own,
                             const struct bench_answers *answers) {
    if (evaluation->spoil) exact_spoil(sample, answers);
    struct exact_error error = verdict_of_own(sample, own, answers);
    evaluation->wrong += error.wrong;
    return verdict(&error);
}

json_t *evaluation_judge_peer(struct exact_sample *sample, const struct peer *peer,
                              const struct bench_answers *answers) {
    struct exact_error error = verdict_of_peer(sample, peer, answers);
    return verdict(&error);
}

json_t *evaluation_check_own(struct evaluation *evaluation, const struct own *own, const struct bench_rays *rays,
                             const struct bench_answers *answers, double share) {
    struct exact *exact = exact_create(own->bodies, NULL);
    struct exact_sample *sample = exact_sample_create(exact, rays, share * evaluation->effort.checks);
    json_t *verdict = evaluation_judge_own(evaluation, sample, own, answers);
    exact_sample_destroy(sample);
    exact_destroy(exact);
    return verdict;
}
