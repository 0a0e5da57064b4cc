/* SPDX-License-Identifier: MIT */
/* repair.h: makes the checksums of altered bytes right again, so that tests get at the checks that are behind them.
 * For tests that see the inside of the library. */
#ifndef RAYGRID_TESTS_REPAIR_H
#define RAYGRID_TESTS_REPAIR_H

#include "stream.h"

/** Goes on as long as the sizes of records make sense. Returns the number of records. */
static inline size_t repair(unsigned char *bytes, size_t size) {
    uint64_t sum = 0, word, words = size / RGI_WORD, at = 0, records = 0;
    while (at < 2 && at < words) {
        memcpy(&word, bytes + at++ * RGI_WORD, sizeof word);
        sum = rgi_mix(sum, word);
    }
    while (words - at >= RGI_RECORD_AROUND) {
        memcpy(&word, bytes + at * RGI_WORD, sizeof word);
        uint64_t end = word >> 8;
        if (end > words - at - RGI_RECORD_AROUND) break;
        for (end += at + 1; at < end; at++) {
            memcpy(&word, bytes + at * RGI_WORD, sizeof word);
            sum = rgi_mix(sum, word);
        }
        memcpy(bytes + at++ * RGI_WORD, &sum, sizeof sum);
        records++;
    }
    return records;
}

#endif
