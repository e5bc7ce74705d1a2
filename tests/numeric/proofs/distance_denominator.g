# core/gridiron/ray/distance.h: kDistanceError, of the denominator in doubles. The argument is that of
# estimate_numerator.g. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/distance.h
%constant kDistanceError inline constexpr double kDistanceError = {};
%unit 0x1p-52
%proves kDistanceError least 0.438
%cases IN_X IN_Y IN_Z
%case 1 0 0
%case 0 1 0
%case 0 0 1

%source core/gridiron/ray/edges_and_distance.cpp
%line e1[i] = Real{triangle.v[1][i]} - Real{triangle.v[0][i]};
%line e2[i] = Real{triangle.v[2][i]} - Real{triangle.v[0][i]};
%round e1_x = B_x - A_x
%round e1_y = B_y - A_y
%round e1_z = B_z - A_z
%round e2_x = C_x - A_x
%round e2_y = C_y - A_y
%round e2_z = C_z - A_z
%line const Real first = e1[j] * e2[k];
%line const Real second = e1[k] * e2[j];
%round first_x = e1_y * e2_z
%round first_y = e1_z * e2_x
%round first_z = e1_x * e2_y
%round second_x = e1_z * e2_y
%round second_y = e1_x * e2_z
%round second_z = e1_y * e2_x
%line normal[i] = first - second;
%line products[i] = magnitude(first) + magnitude(second);
%round n_x = first_x - second_x
%round n_y = first_y - second_y
%round n_z = first_z - second_z
%round size_x = size(first_x) + size(second_x)
%round size_y = size(first_y) + size(second_y)
%round size_z = size(first_z) + size(second_z)
%source core/gridiron/ray/distance.h
%line d_x * Double(setup.normal[0]) + d_y * Double(setup.normal[1]) + d_z * Double(setup.normal[2]);
%round denominator = d_x * n_x + d_y * n_y + d_z * n_z
%source core/gridiron/ray/edges_and_distance.cpp
%line plane.normal_error = kDistanceError * (products[0] + products[1] + products[2]);
%line setup.relative_error_per_t = double{dir_max} * plane.normal_error / magnitude(plane.volume);
%round normal_error = kDistanceError * (size_x + size_y + size_z)
%round error = dir_max * normal_error
# Groups do the same in lanes, where the sum begins with 0, which does not round.
%source core/gridiron/engine/tree/ray_groups.h
%line const double normal_error = kDistanceError * (plane.products[0] + plane.products[1] + plane.products[2]);
%line denominator = denominator + Double::load_floats(group.dir[axis] + first) * normal;

{ B_x - A_x in [IN_Z, IN_Z] /\ B_y - A_y in [IN_X, IN_X] /\ B_z - A_z in [IN_Y, IN_Y] /\
  C_x - A_x in [IN_Y, IN_Y] /\ C_y - A_y in [IN_Z, IN_Z] /\ C_z - A_z in [IN_X, IN_X] /\
  |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ dir_max in [1, 1] /\
  %roundings
  -> error - |denominator - exact_denominator| >= 0 }
