# core/gridiron/ray/edges.h, set_up_edges(): the factor 2 on kEdgeErrorFactor in the bound of `volume`, which is n . c
# = 2 det[a, b, c] with c the third vertex less the origin. The argument is that of edge_float.g. The value is linear
# in c too: one of its components is 1, the others are 0. Of the two products in n's component, which go the same way,
# one is enough. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/edges.h
%constant kEdgeErrorFactor inline constexpr float kEdgeErrorFactor = {};
%constant kVolumeFactor scale * (size_c * Float({} * kEdgeErrorFactor)) + size_c * Float(kUnderflow) + Float(kUnderflow);
%proves kVolumeFactor least 0.266
%cases AT_X AT_Y AT_Z OF_X OF_Y OF_Z
%case 1 0 0 0 1 0
%case 0 1 0 1 0 0
%case 1 0 0 0 0 1

# b - o is 0. c is an a of another lane.
%line const Float a_x = x - Float(packet.origin[0]);
%line const Float a_y = y - Float(packet.origin[1]);
%line const Float a_z = z - Float(packet.origin[2]);
%round a_x = A_x - o_x
%round a_y = A_y - o_y
%round a_z = A_z - o_z
%round c_x = C_x - o_x
%round c_y = C_y - o_y
%round c_z = C_z - o_z
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
%line const Float volume = n_x * opposite(a_x) + n_y * opposite(a_y) + n_z * opposite(a_z);
%round volume = n_x * c_x + n_y * c_y + n_z * c_z

%line const Float size_a = L::abs(a_x) + L::abs(a_y) + L::abs(a_z);
%line const Float size_f = L::max(L::max(L::abs(f_x), L::abs(f_y)), L::abs(f_z));
%line const Float scale = (size_a + next(size_a)) * size_f;
%line const Float size_c = opposite(size_a);
%round size_a = size(a_x) + size(a_y) + size(a_z)
%round size_c = size(c_x) + size(c_y) + size(c_z)
%round size_f = 1 + 0
%round scale = (size_a + 0) * size_f
# 2 kEdgeErrorFactor is a constant of the compiler.
%define factor = kVolumeFactor * kEdgeErrorFactor
%round error = scale * (size_c * factor) + 0 + 0

{ A_x - o_x in [AT_X, AT_X] /\ A_y - o_y in [AT_Y, AT_Y] /\ A_z - o_z in [AT_Z, AT_Z] /\
  C_x - o_x in [OF_X, OF_X] /\ C_y - o_y in [OF_Y, OF_Y] /\ C_z - o_z in [OF_Z, OF_Z] /\
  |F_x| <= 1 /\ |F_y| <= 1 /\ |F_z| <= 1 /\
  %roundings
  -> error - |volume - exact_volume| >= 0 }
