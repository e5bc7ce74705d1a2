# core/gridiron/engine/tree/list_rays.h: kWidening. By terms, a ray enters the widened box no later than it truly
# enters the triangles' own bounds, `side`, of which the stored box n is grown by at least 1.5 e |n|. Exits are the
# mirror image. For fixed roundings all is linear in n, the origin's o and the farthest origin O >= |o|: one of n, o =
# O and O is 1 in magnitude. Only ratios count: d is 1; fused sums round once. Small d and the share of the scene's
# size: the header. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/list_rays.h
%constant kWidening inline constexpr float kWidening = {}, kGreatestRatio = 0x1p40f;
%proves kWidening least 0.751
%cases AT_N AT_O FAR
%case 1 0 0
%case -1 0 0
%case 0 1 1
%case 0 -1 1
%case 0 0 1

%line ray.inverse[axis] = 1.0f / away;
%line Quad::select(is_t, place, inverse).store(terms.scale);
%line (-(place * inverse)).store(terms.shift);
%line twice_farthest[axis] = 2.0f * farthest[axis];
%round scale = 1 / d
%round shift = -(o * scale)
%define most = 2 * O
%source core/gridiron/engine/tree/box_test.h
%line const Float outwards((octant >> axis & 1u) != 0 ? kWidening : -kWidening), most(twice_farthest[axis]);
%line near[axis] = near[axis] + (L::abs(near[axis]) + most) * outwards;
%line in[axis] = L::bounded_sum(near[axis], ray.scale[axis], ray.shift[axis]);
%define outwards = -kWidening
%round near = n + (size(n) + most) * outwards
%round in_ = fused(near, scale, shift)
%define side = n + 0x1.8p-23 * |n|

{ n in [AT_N, AT_N] /\ o in [AT_O, AT_O] /\ O in [FAR, FAR] /\ d in [1, 1] /\
  %roundings
  -> (side - o) - in_ >= 0 }

(side - o) - in_ -> (side - n) + (n - o - in_);
