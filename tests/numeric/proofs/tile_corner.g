# core/gridiron/engine/tree/tile_projection.h: error_per_size, what a corner's coordinate takes of its way from the leaf's
# base. For fixed roundings the difference is linear in the products of a row's components and the way's: one is 1, the
# others are 0. What the base takes is in tile_base.g. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_projection.h
%decimal kPerSize tile.error_per_size = static_cast<float>({} * kFloatUnit) * size;
%constant kRoundedUp inline constexpr float kRoundedUp = {};
%proves kPerSize least 0.984
%cases IN_X IN_Y IN_Z
%case 1 0 0
%case 0 1 0
%case 0 0 1

%line tile.rows[row][axis] = static_cast<float>(tile.exact_rows[row][axis]);
%round r_x = R_x + 0
%round r_y = R_y + 0
%round r_z = R_z + 0
%line sizes[row] += magnitude(tile.rows[row][axis]);
%line const float size = ((sizes[0] > sizes[1] ? sizes[0] : sizes[1]) + span * sizes[2]) * kRoundedUp;
%round sizes = ((0 + size(r_x)) + size(r_y)) + size(r_z)
# Of w's row there is one rounding more.
%round size = (0 + 1 * sizes) * kRoundedUp
%define unit = 0x1p-23
%define per_unit = kPerSize * unit
%round per_size = (per_unit * 1) * size
%source core/gridiron/engine/tree/tile_triangles.h
%line error = size * tile.error_per_size + bases * tile.error_per_base + tile.base_error;
%round error = 1 * per_size + 0 + 0
%line for (int axis = 0; axis < 3; ++axis) q[axis] = vertices[corner][axis] - Float(leaf.place[axis]);
%round q_x = V_x - place_x
%round q_y = V_y - place_y
%round q_z = V_z - place_z
%line q[0], Float(r[0]),
%line L::bounded_sum(q[1], Float(r[1]), L::bounded_sum(q[2], Float(r[2]), Float(leaf.base[row]))));
%round along = q_x * r_x + (q_y * r_y + (q_z * r_z + 0))

{ R_x in [IN_X, IN_X] /\ R_y in [IN_Y, IN_Y] /\ R_z in [IN_Z, IN_Z] /\
  |V_x - place_x| <= 1 /\ |V_y - place_y| <= 1 /\ |V_z - place_z| <= 1 /\
  %roundings
  -> error - |along - exact_along| >= 0 }
