// Found before core's: counted/quad_words.h is its counted form. SPDX-License-Identifier: Apache-2.0
#pragma once
