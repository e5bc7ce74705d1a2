// The host's numbers and branches again, for what follows the sources of the counted kernel.
// Memory: none. Threads: any. SPDX-License-Identifier: Apache-2.0
#undef gridiron
#undef float
#undef double
#undef int32_t
#undef int64_t
#undef uint32_t
#undef uint64_t
#undef bit_cast
#undef if
#undef while
#undef switch
#undef for
