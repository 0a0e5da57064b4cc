/* SPDX-License-Identifier: MIT */
#define RGI_ISA RGI_ISA_AVX512
#define RGI_NAME avx512
#include "kernels.h"
