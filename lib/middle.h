/* SPDX-License-Identifier: MIT */
#ifndef RAYGRID_LIB_MIDDLE_H
#define RAYGRID_LIB_MIDDLE_H

/** The middle of all that is stored in a frame of floats, as rays need it that come from far away. */
typedef struct rgi_middle {
    double centre[3]; /* relative to the frame's origin, in units of the world or the shape */
    double radius;    /* in the same units */
    double extent;    /* the largest coordinates along the axes, added up, in units of the frame */
    float spacing;    /* near 1 / cube root of the number of objects: how far apart they are, in parts of the whole */
} rgi_middle;

#endif
