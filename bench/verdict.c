/* SPDX-License-Identifier: MIT */
#include "verdict.h"

static uint32_t body_of_own(const void *side, uint64_t id) {
    return own_body(side, id);
}

static uint32_t body_of_peer(const void *side, uint64_t id) {
    return peer_body(side, id);
}

struct exact_error verdict_of_own(struct exact_sample *sample, const struct own *own,
                                  const struct bench_answers *answers) {
    return exact_judge(sample, answers, body_of_own, own, EXACT_PROMISED);
}

struct exact_error verdict_of_peer(struct exact_sample *sample, const struct peer *peer,
                                   const struct bench_answers *answers) {
    return exact_judge(sample, answers, body_of_peer, peer, EXACT_FLOAT);
}
