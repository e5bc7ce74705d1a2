// Light of the reference against closed forms. SPDX-License-Identifier: Apache-2.0
