/* SPDX-License-Identifier: MIT */
/* Stands in for the system's header where the interface is read: cffi knows its types. */
