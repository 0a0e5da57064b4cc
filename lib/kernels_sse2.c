/* SPDX-License-Identifier: MIT */
#define RGI_ISA RGI_ISA_SSE2
#define RGI_NAME sse2
#include "kernels.h"
