/* SPDX-License-Identifier: MIT */
/* Preprocessed, never compiled: what Python is told of the interface. */
#include <raygrid/raygrid.h>
