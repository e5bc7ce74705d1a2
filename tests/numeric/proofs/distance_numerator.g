# core/gridiron/ray/distance.h: kDistanceError, of the numerator in doubles, and of volume_sign(). The argument is
# that of estimate_numerator.g. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/distance.h
%constant kDistanceError inline constexpr double kDistanceError = {};
%unit 0x1p-52
%proves kDistanceError least 0.501
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
# A sum that begins with 0 does not round there.
%line const double a = double{triangle.v[0][i]} - double{origin[i]};
%line plane.volume += a * plane.normal[i];
%line plane.volume_error += magnitude(a) * products[i];
%round a_x = A_x - o_x
%round a_y = A_y - o_y
%round a_z = A_z - o_z
%round numerator = a_x * n_x + a_y * n_y + a_z * n_z
%round numerator_size = size(a_x) * size_x + size(a_y) * size_y + size(a_z) * size_z
%line plane.volume_error *= kDistanceError;
%round error = kDistanceError * numerator_size
# Groups do the same in lanes.
%source core/gridiron/engine/tree/ray_groups.h
%line const Double a = Double(double{triangle.v[0][axis]}) - Double::load_floats(group.origin[axis] + first);
%line volume = volume + a * normal;
%line volume_size = volume_size + L::abs(a) * Double(plane.products[axis]);

{ A_x - o_x in [IN_X, IN_X] /\ A_y - o_y in [IN_Y, IN_Y] /\ A_z - o_z in [IN_Z, IN_Z] /\
  B_x - A_x in [IN_Z, IN_Z] /\ B_y - A_y in [IN_X, IN_X] /\ B_z - A_z in [IN_Y, IN_Y] /\
  C_x - A_x in [IN_Y, IN_Y] /\ C_y - A_y in [IN_Z, IN_Z] /\ C_z - A_z in [IN_X, IN_X] /\
  %roundings
  -> error - |numerator - exact_numerator| >= 0 }
