// Nothing of its own: the target that owns the precompiled headers needs a source.
// SPDX-License-Identifier: Apache-2.0
