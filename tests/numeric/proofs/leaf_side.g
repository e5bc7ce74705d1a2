# core/gridiron/engine/tree/leaf_test.h: kSideErrorFactor, of what sides of triangles take from edges: r . e2 with r
# the cross product of corner - origin and direction, and the third side, which is a difference of it. The bound's
# other part, leaf_normal.g, is for what they take from the normal, which is 0 here. For fixed roundings all is linear
# in corner - origin and in the edges: one component of each is 1, and of the two products in r's component, which go
# the same way, one is enough. back_e1 takes part in one sum less. Powers of two bring |d|max to at most 1.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/leaf_test.h
%constant kSideErrorFactor inline constexpr float kSideErrorFactor = {};
%proves kSideErrorFactor least 0.215
%cases AT_X AT_Y AT_Z IN_X IN_Y IN_Z
%case 0 1 0 1 0 0
%case 0 0 1 0 1 0
%case 1 0 0 0 0 1

%line e2[axis] = corners[6 + axis] - v;
%round e_x = C_x - A_x
%round e_y = C_y - A_y
%round e_z = C_z - A_z
%line const Float x = v[0] - q.origin[0], y = v[1] - q.origin[1], z = v[2] - q.origin[2];
%round x = A_x - o_x
%round y = A_y - o_y
%round z = A_z - o_z
%line const Float r[3] = {difference(y, q.dir[2], z, q.dir[1]), difference(z, q.dir[0], x, q.dir[2]),
%line difference(x, q.dir[1], y, q.dir[0])};
%round r_x = y * d_z - z * d_y
%round r_y = z * d_x - x * d_z
%round r_z = x * d_y - y * d_x
%line return sum(a[2], b[2], sum(a[1], b[1], a[0] * b[0]));
%line const Float first = L::turn_by(denominator, inner(r, e2));
%line const Float third = size - first - second;
%round first = r_z * e_z + (r_y * e_y + r_x * e_x)
%round third = 0 - first - 0

%line Float e1[3], e2[3], sizes(kLeastListSize), edges(kLeastListSize);
%line edges = edges + (L::abs(e1[axis]) + L::abs(e2[axis]));
%line const Float edge_error = edges * factor, normal_error = sizes * factor;
%line const Float far = L::abs(x) + L::abs(y) + (L::abs(z) + Float(kLeastListSize));
%line const Float error = far * q.dir_max * edge_error + turn;
%line const std::uint32_t candidates = there & ~(least + error < Float(0.0f)).bits();
%round edges = 0 + (0 + size(e_x)) + (0 + size(e_y)) + (0 + size(e_z))
%round edge_error = edges * kSideErrorFactor
%round far = size(x) + size(y) + (size(z) + 0)
%round error = far * dir_max * edge_error + 0

# What wide lanes rule out first: the largest component is at least a third of the sum, before it is rounded.
%line wide_edge_error = edge_error * Float(3.0f);
%line const Float side = sum(sum(most, wide_edge_error, least_error), q.dir_max, least);
# Groups do the same, with three times the bound from where the leaf is set up.
%line (edge_error * Float(3.0f)).store(group_leaf->edge_error + base);
%line (normal_error + edge_error * Float(kLeastListSize)).store(group_leaf->least_error + base);
%source core/gridiron/engine/tree/ray_groups.h
%line const Float a = L::turn_by(denominator, inner(r, edge)), b = L::turn_by(denominator, inner(r, back));
%line const Float least = L::min(L::min(a, b), size - a - b);
%line beside = -sum(sum(most, more_word(kWideEdge), more_word(kLeast)), q.dir_max, least);
%round most = a_third + 0
%round wide_error = (most * (edge_error * 3) + 0) * dir_max

{ a_third in [0x0.55555554p0, 1] /\
  A_x - o_x in [AT_X, AT_X] /\ A_y - o_y in [AT_Y, AT_Y] /\ A_z - o_z in [AT_Z, AT_Z] /\
  C_x - A_x in [IN_X, IN_X] /\ C_y - A_y in [IN_Y, IN_Y] /\ C_z - A_z in [IN_Z, IN_Z] /\
  |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ dir_max in [1, 1] /\
  %roundings
  -> error - |first - exact_first| >= 0 /\ error - |third - exact_third| >= 0 /\
     wide_error - |third - exact_third| >= 0 }
