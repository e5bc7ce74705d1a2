# core/gridiron/ray/distance.h: kFloatError, of the estimate's denominator normal . d. The argument is that of
# estimate_numerator.g. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/distance.h
%constant kFloatError inline constexpr float kFloatError = {};
%line inline constexpr float kUncertain = kFloatError * 2.25f / kEstimateError;
%proves kFloatError least 0.824
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
%line const Float denominator = setups.normal[0] * d_x + setups.normal[1] * d_y + setups.normal[2] * d_z;
%round denominator = n_x * d_x + n_y * d_y + n_z * d_z
%source core/gridiron/ray/edges_and_distance.cpp
%line const float normal_size = size[0] + size[1] + size[2];
%line const float denominator_size = dir_max * normal_size;
%line estimate.least_denominator = kUncertain * denominator_size;
%round normal_size = size_x + size_y + size_z
%round error = kFloatError * (dir_max * normal_size)

{ B_x - A_x in [IN_Z, IN_Z] /\ B_y - A_y in [IN_X, IN_X] /\ B_z - A_z in [IN_Y, IN_Y] /\
  C_x - A_x in [IN_Y, IN_Y] /\ C_y - A_y in [IN_Z, IN_Z] /\ C_z - A_z in [IN_X, IN_X] /\
  |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ dir_max in [1, 1] /\
  %roundings
  -> error - |denominator - exact_denominator| >= 0 }
