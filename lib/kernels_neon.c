/* SPDX-License-Identifier: MIT */
#define RGI_ISA RGI_ISA_NEON
#define RGI_NAME neon
#include "kernels.h"
