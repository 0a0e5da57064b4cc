/* SPDX-License-Identifier: MIT */
#define RGI_ISA RGI_ISA_PORTABLE
#define RGI_NAME portable
#include "kernels.h"
