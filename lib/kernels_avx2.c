/* SPDX-License-Identifier: MIT */
#define RGI_ISA RGI_ISA_AVX2
#define RGI_NAME avx2
#include "kernels.h"
