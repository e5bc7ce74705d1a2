# core/gridiron/ray/distance.h: kFloatError, of the estimate's numerator (corner - origin) . normal. Each of the six
# products e1_j e2_k is rounded as a whole, and each of their products with a component of corner - origin: for fixed
# roundings numerator and bound are linear in these and their magnitudes. One of them is 1, the others are 0; signs
# are alike, so one of each component. kUncertain is kFloatError times a constant, rounded once when multiplied.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/distance.h
%constant kFloatError inline constexpr float kFloatError = {};
%line inline constexpr float kUncertain = kFloatError * 2.25f / kEstimateError;
%proves kFloatError least 0.942
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
%line const float from_origin = triangle.v[0][i] - origin[i];
%line numerator += from_origin * estimate.normal[i];
%line numerator_size += magnitude(from_origin) * size[i];
%round a_x = A_x - o_x
%round a_y = A_y - o_y
%round a_z = A_z - o_z
%round numerator = a_x * n_x + a_y * n_y + a_z * n_z
%round numerator_size = size(a_x) * size_x + size(a_y) * size_y + size(a_z) * size_z
%line magnitude(numerator) > kUncertain * numerator_size;
%round error = kFloatError * numerator_size

{ A_x - o_x in [IN_X, IN_X] /\ A_y - o_y in [IN_Y, IN_Y] /\ A_z - o_z in [IN_Z, IN_Z] /\
  B_x - A_x in [IN_Z, IN_Z] /\ B_y - A_y in [IN_X, IN_X] /\ B_z - A_z in [IN_Y, IN_Y] /\
  C_x - A_x in [IN_Y, IN_Y] /\ C_y - A_y in [IN_Z, IN_Z] /\ C_z - A_z in [IN_X, IN_X] /\
  %roundings
  -> error - |numerator - exact_numerator| >= 0 }
