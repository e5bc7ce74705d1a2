# core/gridiron/engine/tree/tile_projection.h: kPlaneError. No box with a point inside a plane is found to be outside; w
# is not above that of any of its points. For fixed roundings all is linear in the components of a row, in those of w's
# row times what a plane takes of them, and in the offset: one is 1 or -1, the others are 0. What doubles lose is in
# base_error.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_projection.h
%constant kPlaneError inline constexpr float kPlaneError = {};
%proves kPlaneError least 0.701
%cases ROW_X ROW_Y ROW_Z W_X W_Y W_Z OFFSET
%case 1 0 0 0 0 0 0
%case 0 1 0 0 0 0 0
%case 0 0 1 0 0 0 0
%case 0 0 0 1 0 0 0
%case 0 0 0 0 1 0 0
%case 0 0 0 0 0 1 0
%case 0 0 0 0 0 0 1
%case 0 0 0 0 0 0 -1

%decimal kMost eye.most = static_cast<float>(far * {});
%round most = kMost * 1
%line tile.rows[row][axis] = static_cast<float>(tile.exact_rows[row][axis]);
%round row_x = R_x * 1
%round row_y = R_y * 1
%round row_z = R_z * 1
# Times last, or times the margin: a power of two, and less than what is charged.
%line first[axis] = tile.rows[row][axis] + kMargin * tile.rows[2][axis];
%line second[axis] = last_w * tile.rows[2][axis] - tile.rows[row][axis];
%round w_x = (W_x * 1) * 1
%round w_y = (W_y * 1) * 1
%round w_z = (W_z * 1) * 1
%round sum_x = row_x + w_x
%round sum_y = row_y + w_y
%round sum_z = row_z + w_z
%line const float lost = (sizes[row] + last_w * sizes[2]) * eye.most;
%round of_w = ((0 + size(W_x * 1)) + size(W_y * 1)) + size(W_z * 1)
%round sizes = ((0 + size(row_x)) + size(row_y)) + size(row_z)
%round lost = (sizes + 1 * of_w) * most
%line const float near_offset = static_cast<float>(offsets[row] + kPlaneMargin * offsets[2]);
%line const float far_offset = static_cast<float>(last * offsets[2] - offsets[row]);
%round near_offset = offset * 1
%line first[3] = near_offset + (kPlaneError * (lost + magnitude(near_offset)) + tile.base_error);
%line second[3] = far_offset + (kPlaneError * (lost + magnitude(far_offset)) + tile.base_error);
%round error = kPlaneError * (lost + size(near_offset)) + 0
%round above = near_offset + error
# Of w.
%line for (int axis = 0; axis < 3; ++axis) tile.planes[4][axis] = tile.rows[2][axis];
%line tile.planes[4][3] = offset - (kPlaneError * (sizes[2] * eye.most + magnitude(offset)) + tile.base_error);
%round error_of_w = kPlaneError * (sizes * most + size(near_offset)) + 0
%round below = near_offset - error_of_w
%source core/gridiron/engine/tree/tile_tracer.h
%line return Float::load(((k[axis] > 0.0f) == is_least ? node.low : node.high)[axis] + base);
%line return L::bounded_sum(side(0), Float(k[0]),
%line L::bounded_sum(side(1), Float(k[1]), L::bounded_sum(side(2), Float(k[2]), Float(k[3]))));
# x, y, z are the side of the box that is taken: there the rounded form is not less than at the point X, Y, Z. The
# largest component of places is 1; boxes are grown.
%define k_x = sum_x
%define k_y = sum_y
%define k_z = sum_z
%define k_above = above
%define m_x = row_x
%define m_y = row_y
%define m_z = row_z
%define k_below = below
%round inside = x * k_x + (y * k_y + (z * k_z + k_above))
%round w = x * m_x + (y * m_y + (z * m_z + k_below))
# How far the evaluation is off for the side, and the rounded form for the point.
%define inside_off = inside - exact_inside
%define w_off = w - exact_w
%define form_off = X * (k_x - R_x - W_x) + (Y * (k_y - R_y - W_y) + (Z * (k_z - R_z - W_z) + (k_above - offset)))
%define form_of_w_off = X * (m_x - R_x) + (Y * (m_y - R_y) + (Z * (m_z - R_z) + (k_below - offset)))

{ R_x in [ROW_X, ROW_X] /\ R_y in [ROW_Y, ROW_Y] /\ R_z in [ROW_Z, ROW_Z] /\
  W_x in [W_X, W_X] /\ W_y in [W_Y, W_Y] /\ W_z in [W_Z, W_Z] /\ offset in [OFFSET, OFFSET] /\
  |x| <= 0x1.00002p0 /\ |y| <= 0x1.00002p0 /\ |z| <= 0x1.00002p0 /\
  |X| <= 0x1.00002p0 /\ |Y| <= 0x1.00002p0 /\ |Z| <= 0x1.00002p0 /\
  %roundings
  -> inside_off + form_off >= 0 /\ w_off + form_of_w_off <= 0 }

k_above - offset -> (above - (near_offset + error)) + (near_offset - offset) + error;
k_below - offset -> (below - (near_offset - error_of_w)) + (near_offset - offset) - error_of_w;
