// Found before core's: counted/quad_words.h has what is counted of it. SPDX-License-Identifier: Apache-2.0
#pragma once
