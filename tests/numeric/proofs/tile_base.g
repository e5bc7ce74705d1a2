# core/gridiron/engine/tree/tile_projection.h: error_per_base, what a corner's coordinate takes of the leaf's base: the
# base itself is rounded, and it goes through three sums. The argument is that of tile_corner.g.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_projection.h
%decimal kPerBase tile.error_per_base = static_cast<float>({} * kFloatUnit);
%proves kPerBase least 0.976
%define unit = 0x1p-23
%round per_base = kPerBase * unit
%source core/gridiron/engine/tree/tile_triangles.h
%line base[row] = static_cast<float>(r[0] * way[0] + r[1] * way[1] + r[2] * way[2]);
%line const float bases = (column > line ? column : line) + 2.0f * static_cast<float>(width) * magnitude(base[2]);
%line error = size * tile.error_per_size + bases * tile.error_per_base + tile.base_error;
%round base = B + 0
%round bases = size(base) + 0
%round error = 0 + bases * per_base + 0
%line q[0], Float(r[0]),
%line L::bounded_sum(q[1], Float(r[1]), L::bounded_sum(q[2], Float(r[2]), Float(leaf.base[row]))));
%round along = 0 + (0 + (0 + base))

{ B in [1, 1] /\
  %roundings
  -> error - |along - exact_along| >= 0 }
