# core/gridiron/ray/edges.h: kEdgeErrorFactor. The float value of n . d differs from the exact one by no more than
# `error`. For fixed roundings the value is linear in a and b, and `error` in their magnitudes: the claim holds for
# all of them if it holds where one component is 1 and all others are 0. a and b go the same way, so a's three
# components are the cases. Powers of two bring |F|max and |d|max to at most 1; kUnderflow only adds to `error`.
# SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges.h
%constant kEdgeErrorFactor inline constexpr float kEdgeErrorFactor = {};
%proves kEdgeErrorFactor least 0.942
%cases AT_X AT_Y AT_Z
%case 0 0 1
%case 1 0 0
%case 0 1 0

%line const Float a_x = x - Float(packet.origin[0]);
%line const Float a_y = y - Float(packet.origin[1]);
%line const Float a_z = z - Float(packet.origin[2]);
%round a_x = A_x - o_x
%round a_y = A_y - o_y
%round a_z = A_z - o_z
# b - o is 0.
%line const Float s_x = a_x + next(a_x), s_y = a_y + next(a_y), s_z = a_z + next(a_z);
%round s_x = a_x + 0
%round s_y = a_y + 0
%round s_z = a_z + 0
%line const Float f_x = next(x) - x, f_y = next(y) - y, f_z = next(z) - z;
%round f_x = F_x + 0
%round f_y = F_y + 0
%round f_z = F_z + 0
%line const Float n_x = s_y * f_z - s_z * f_y;
%line const Float n_y = s_z * f_x - s_x * f_z;
%line const Float n_z = s_x * f_y - s_y * f_x;
%round n_x = s_y * f_z - s_z * f_y
%round n_y = s_z * f_x - s_x * f_z
%round n_z = s_x * f_y - s_y * f_x
%line return edges.n[edge][0] * d_x + edges.n[edge][1] * d_y + edges.n[edge][2] * d_z;
%round value = n_x * d_x + n_y * d_y + n_z * d_z

# The largest component of the edge is 1, before it is rounded.
%line const Float size_a = L::abs(a_x) + L::abs(a_y) + L::abs(a_z);
%line const Float size_f = L::max(L::max(L::abs(f_x), L::abs(f_y)), L::abs(f_z));
%line const Float scale = (size_a + next(size_a)) * size_f;
%line const Float error = scale * Float(kEdgeErrorFactor * packet.dir_max) + Float(kUnderflow * packet.range_factor);
%round size_a = size(a_x) + size(a_y) + size(a_z)
%round size_f = 1 + 0
%round scale = (size_a + 0) * size_f
%round error = scale * (kEdgeErrorFactor * dir_max) + 0

{ A_x - o_x in [AT_X, AT_X] /\ A_y - o_y in [AT_Y, AT_Y] /\ A_z - o_z in [AT_Z, AT_Z] /\
  |F_x| <= 1 /\ |F_y| <= 1 /\ |F_z| <= 1 /\ |d_x| <= 1 /\ |d_y| <= 1 /\ |d_z| <= 1 /\ dir_max in [1, 1] /\
  %roundings
  -> error - |value - exact_value| >= 0 }
