# core/gridiron/engine/tree/box_test.h: kExitFactor. A ray that meets a box has an exact entry of no axis behind an
# exact exit of any: then `first` is not above `last` times the factor. Entries below 0 count as 0, t is an exit
# without rounding. Only ratios count: the reciprocal's exact value is 1 on both axes, the nearest exit 1, the entry
# between 0 and 1. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/box_test.h
%constant kExitFactor inline constexpr float kExitFactor = {};
%proves kExitFactor above 1 least 0.438
%source core/gridiron/engine/tree/list_rays.h
%line ray.inverse[axis] = 1.0f / away;
%round inverse_x = 1 / d_x
%round inverse_y = 1 / d_y
%source core/gridiron/engine/tree/box_test.h
%line in[axis] = (kAreMeasured ? near[axis] : near[axis] - ray.origin[axis]) * ray.inverse[axis];
%line out[axis] = (kAreMeasured ? far[axis] : far[axis] - ray.origin[axis]) * ray.inverse[axis];
%line return (first > last * Float(kExitFactor)).bits();
%round first = (near - o_x) * inverse_x
%round last = (far - o_y) * inverse_y
%round limit = last * kExitFactor

{ d_x in [1, 1] /\ d_y in [1, 1] /\ near - o_x in [0, 1] /\ far - o_y in [1, 1] /\
  %roundings
  -> limit - first >= 0 }
