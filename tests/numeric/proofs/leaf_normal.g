# core/gridiron/engine/tree/leaf_test.h: kSideErrorFactor, of what sides, `size` and `ahead` take from the normal e1 x
# e2. For fixed roundings all is linear in the six products e1_j e2_k, in corner - origin and in the direction. One
# product is 1, the others are 0; signs are alike, so one of each component. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/leaf_test.h
%constant kSideErrorFactor inline constexpr float kSideErrorFactor = {};
%proves kSideErrorFactor least 0.215
%cases IN_X IN_Y IN_Z
%case 1 0 0
%case 0 1 0
%case 0 0 1

%line e1[axis] = corners[3 + axis] - v;
%line e2[axis] = corners[6 + axis] - v;
%round e1_x = B_x - A_x
%round e1_y = B_y - A_y
%round e1_z = B_z - A_z
%round e2_x = C_x - A_x
%round e2_y = C_y - A_y
%round e2_z = C_z - A_z
%line const Float p = e1[j] * e2[k], q = e1[k] * e2[j];
%line (p - q).store(lanes.normal[axis] + base);
%line sizes = sizes + (L::abs(p) + L::abs(q));
%line const Float edge_error = edges * factor, normal_error = sizes * factor;
%round p_x = e1_y * e2_z
%round p_y = e1_z * e2_x
%round p_z = e1_x * e2_y
%round q_x = e1_z * e2_y
%round q_y = e1_x * e2_z
%round q_z = e1_y * e2_x
%round n_x = p_x - q_x
%round n_y = p_y - q_y
%round n_z = p_z - q_z
%round sizes = 0 + (size(p_x) + size(q_x)) + (size(p_y) + size(q_y)) + (size(p_z) + size(q_z))
%round normal_error = sizes * kSideErrorFactor

# Sides, for a ray whose corner - origin is 0.
%line const Float denominator = inner(q.dir, n);
%line const Float third = size - first - second;
%line const Float turn = normal_error * q.dir_max;
%line const Float error = far * q.dir_max * edge_error + turn;
%round denominator = d_z * n_z + (d_y * n_y + d_x * n_x)
%round third = denominator - 0 - 0
%round turn = normal_error * dir_max
%round error = 0 * dir_max * 0 + turn

# The distance from the plane.
%line const Float x = v[0] - q.origin[0], y = v[1] - q.origin[1], z = v[2] - q.origin[2];
%line return LeafAnswer<L>::judge(candidates, (least > error).bits(), L::turn_by(denominator, inner(place, n)),
%line far * normal_error + Float(kLeastAhead), size, turn, q.t);
%round x = A_x - o_x
%round y = A_y - o_y
%round z = A_z - o_z
%round ahead = z * n_z + (y * n_y + x * n_x)
%round far = 1 + 0 + (0 + 0)
%round ahead_error = far * normal_error + 0

# What wide lanes rule out first: the largest component is at least a third of the sum, before it is rounded.
%line wide_normal_error = normal_error * Float(3.0f);
%line const auto away = (sum(most, wide_normal_error, ahead) < Float(-2.0f * kLeastAhead)) |
# Groups do the same, with three times the bound from where the leaf is set up.
%line (normal_error * Float(3.0f)).store(group_leaf->normal_error + base);
%source core/gridiron/engine/tree/ray_groups.h
%line const Float ahead = L::turn_by(denominator, inner(place, normal)), error = more_word(kWideNormal);
%line before = -sum(most, error, ahead + Float(2.0f * kLeastAhead));
%round most = a_third + 0
%round wide_error = most * (normal_error * 3)

{ a_third in [0x0.55555554p0, 1] /\
  B_x - A_x in [IN_Z, IN_Z] /\ B_y - A_y in [IN_X, IN_X] /\ B_z - A_z in [IN_Y, IN_Y] /\
  C_x - A_x in [IN_Y, IN_Y] /\ C_y - A_y in [IN_Z, IN_Z] /\ C_z - A_z in [IN_X, IN_X] /\
  |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ dir_max in [1, 1] /\
  |A_x - o_x| <= 1 /\ |A_y - o_y| <= 1 /\ |A_z - o_z| <= 1 /\
  %roundings
  -> error - |third - exact_third| >= 0 /\ turn - |denominator - exact_denominator| >= 0 /\
     ahead_error - |ahead - exact_ahead| >= 0 /\ wide_error - |ahead - exact_ahead| >= 0 }
