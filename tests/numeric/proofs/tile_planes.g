# core/gridiron/engine/tree/tile_projection.h: the 6 e of planes of boxes. No box with a point inside a plane is found to
# be outside; w is not above that of any of its points. For fixed roundings all is linear in the products of a plane's
# components and a side, and in the offset: one of them is 1 or -1, the others are 0. Sides are at most `most`, but for
# what boxes are grown. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/tile_projection.h
%constant kPlaneError const double error = {} * kFloatUnit * (sum * most + magnitude(offset)) + double{tile.base_error};
%proves kPlaneError least 0.834
%cases IN_X IN_Y IN_Z OFFSET
%case 1 0 0 0
%case 0 1 0 0
%case 0 0 1 0
%case 0 0 0 1
%case 0 0 0 -1

%line for (int axis = 0; axis < 3; ++axis) tile.planes[plane][axis] = static_cast<float>(values[axis]);
%line tile.planes[plane][3] = static_cast<float>(plane == 4 ? offset - error : offset + error);
%define error = kPlaneError * 0x1p-23 * (p_x + p_y + p_z + |offset|)
%round k_x = p_x + 0
%round k_y = p_y + 0
%round k_z = p_z + 0
%define above = offset + error
%define below = offset - error
%round k_above = above + 0
%round k_below = below + 0
%source core/gridiron/engine/tree/tile_tracer.h
%line return L::bounded_sum(side(0), Float(k[0]),
%line L::bounded_sum(side(1), Float(k[1]), L::bounded_sum(side(2), Float(k[2]), Float(k[3]))));
%round inside = x * k_x + (y * k_y + (z * k_z + k_above))
%round w = x * k_x + (y * k_y + (z * k_z + k_below))
%define exact = x * p_x + (y * p_y + (z * p_z + offset))

{ p_x in [IN_X, IN_X] /\ p_y in [IN_Y, IN_Y] /\ p_z in [IN_Z, IN_Z] /\ offset in [OFFSET, OFFSET] /\
  |x| <= 0x1.00002p0 /\ |y| <= 0x1.00002p0 /\ |z| <= 0x1.00002p0 /\
  %roundings
  -> inside - exact >= 0 /\ exact - w >= 0 }

inside - exact -> (inside - exact_inside) + error;
exact - w -> error - (w - exact_w);
