/* SPDX-License-Identifier: MIT */
/* verdict.h: how wrong the answers of a side are, each held to what that side promises. */
#ifndef RAYGRID_BENCH_VERDICT_H
#define RAYGRID_BENCH_VERDICT_H

#include "exact.h"
#include "own.h"
#include "peer.h"

struct exact_error verdict_of_own(struct exact_sample *sample, const struct own *own,
                                  const struct bench_answers *answers);
struct exact_error verdict_of_peer(struct exact_sample *sample, const struct peer *peer,
                                   const struct bench_answers *answers);

#endif
