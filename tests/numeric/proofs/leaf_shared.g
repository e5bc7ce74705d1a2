# core/gridiron/engine/tree/leaf_test.h: kSideErrorFactor, of what sides of triangles take from edges for rays of one
# origin, by the normals that set_up_origin() makes. The argument is that of leaf_side.g.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/leaf_test.h
%constant kSideErrorFactor inline constexpr float kSideErrorFactor = {};
%proves kSideErrorFactor least 0.215
%cases AT_X AT_Y AT_Z IN_X IN_Y IN_Z
%case 0 1 0 0 0 1
%case 1 0 0 0 1 0
%case 0 0 1 1 0 0

%line e2[axis] = corners[6 + axis] - v;
%round e_x = C_x - A_x
%round e_y = C_y - A_y
%round e_z = C_z - A_z
%line place[axis] = Float::load(lanes.v[axis] + base) - Float(origin[axis]);
%round x = A_x - o_x
%round y = A_y - o_y
%round z = A_z - o_z
%line (first[j] * place[k] - first[k] * place[j]).store(lanes.v[axis] + base);
%round first_x = e_y * z - e_z * y
%round first_y = e_z * x - e_x * z
%round first_z = e_x * y - e_y * x
%line const Float side = L::turn_by(denominator, inner(q.dir, first));
%line const Float least = L::min(L::min(side, other), size - side - other);
%round side = d_z * first_z + (d_y * first_y + d_x * first_x)
%round third = 0 - side - 0

%line edges = edges + (L::abs(e1[axis]) + L::abs(e2[axis]));
%line const Float edge_error = edges * factor, normal_error = sizes * factor;
%line far = far + L::abs(place[axis]);
%line (far * Float::load(lanes.edge_error + base) + normal_error).store(lanes.edge_error + base);
%line const Float most_error = error * q.dir_max;
# Groups do the same.
%source core/gridiron/engine/tree/ray_groups.h
%line const Float a = L::turn_by(denominator, inner(q.dir, first)), b = L::turn_by(denominator, inner(q.dir, second));
%line beside = -(least + word(kEdgeError) * q.dir_max);
%round edges = 0 + (0 + size(e_x)) + (0 + size(e_y)) + (0 + size(e_z))
%round edge_error = edges * kSideErrorFactor
%round far = 0 + size(x) + size(y) + size(z)
%round error = (far * edge_error + 0) * dir_max

{ A_x - o_x in [AT_X, AT_X] /\ A_y - o_y in [AT_Y, AT_Y] /\ A_z - o_z in [AT_Z, AT_Z] /\
  C_x - A_x in [IN_X, IN_X] /\ C_y - A_y in [IN_Y, IN_Y] /\ C_z - A_z in [IN_Z, IN_Z] /\
  |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ dir_max in [1, 1] /\
  %roundings
  -> error - |side - exact_side| >= 0 /\ error - |third - exact_third| >= 0 }
