# core/gridiron/ray/edges_and_distance.cpp, edge_sign(): the factor 2^-47 of its bound in doubles. The argument is
# that of edge_float.g. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges_and_distance.cpp
%constant kDoubleEdgeError const double error = {} * size_sum * size_edge * size_dir;
%proves kDoubleEdgeError least 0.501
%unit 0x1p-52
%cases AT_X AT_Y AT_Z
%case 0 0 1
%case 1 0 0
%case 0 1 0

%line const double from_a = double{a[i]} - double{origin[i]};
%round a_x = A_x - o_x
%round a_y = A_y - o_y
%round a_z = A_z - o_z
# b - o is 0.
%line sum[i] = from_a + from_b;
%round s_x = a_x + 0
%round s_y = a_y + 0
%round s_z = a_z + 0
%line edge[i] = double{b[i]} - double{a[i]};
%round f_x = F_x + 0
%round f_y = F_y + 0
%round f_z = F_z + 0
%line const double value = (sum[1] * edge[2] - sum[2] * edge[1]) * dir[0] + (sum[2] * edge[0] - sum[0] * edge[2]) * dir[1] +
%line (sum[0] * edge[1] - sum[1] * edge[0]) * dir[2];
%round value = (s_y * f_z - s_z * f_y) * d_x + (s_z * f_x - s_x * f_z) * d_y + (s_x * f_y - s_y * f_x) * d_z

# The largest component of the edge is 1, before it is rounded.
%line size_sum += magnitude(from_a) + magnitude(from_b);
%line size_edge = magnitude(edge[i]) > size_edge ? magnitude(edge[i]) : size_edge;
%round size_sum = (size(a_x) + 0) + (size(a_y) + 0) + (size(a_z) + 0)
%round size_edge = 1 + 0
%round error = kDoubleEdgeError * size_sum * size_edge * size_dir

{ A_x - o_x in [AT_X, AT_X] /\ A_y - o_y in [AT_Y, AT_Y] /\ A_z - o_z in [AT_Z, AT_Z] /\
  |F_x| <= 1 /\ |F_y| <= 1 /\ |F_z| <= 1 /\ |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ size_dir in [1, 1] /\
  %roundings
  -> error - |value - exact_value| >= 0 }
