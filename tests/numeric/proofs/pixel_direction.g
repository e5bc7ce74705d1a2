# core/gridiron/ray/packet.h: kLinearError. A direction of a packet differs from the linear form first_dir + column
# step_x + row step_y, which floats evaluate once, by at most linear_error. For fixed roundings the difference is
# linear in C, the frame's corner, U = x_last step_x and V = y_last step_y, of which D = |C| + |U| + |V|: one of them
# is 1, the others are 0. Columns are in units of x_last: x_0 >= -1/2 and at least 7 columns follow where the form is
# used: c is at most 14/13. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/ray/packet.h
%constant kLinearError inline constexpr float kLinearError = {};
%proves kLinearError least 0.573
%cases IN_C IN_U IN_V
%case 0 1 0
%case 1 0 0
%case 0 0 1

# Pixels are multiples of 1/32 below 2^18: x_0 + c is exact.
%source core/gridiron/ray/hits.h
%line return (Real(frame.corner[axis]) + x * Real(frame.step_x[axis])) + y * Real(frame.step_y[axis]);
%define x = x_0 + c
%define y = y_0 + r
%round direction = (C + x * U) + y * V
%round first = (C + x_0 * U) + y_0 * V
%source core/gridiron/engine/grid/frustum.h
%line return (Float(packet.first_dir[axis]) + (column * Float(packet.step_x[axis]) + row * Float(packet.step_y[axis]))) *
%round linear = first + (c * U + r * V)
# The form in exact arithmetic, which pixel_box.g and subpackets use.
%define form = first + (c * U + r * V)
%source core/gridiron/ray/camera.h
%line const float bound = magnitude(frame.corner[axis]) + (x0 + kLast) * magnitude(frame.step_x[axis]) +
%line (y0 + kLast) * magnitude(frame.step_y[axis]);
%line packet.linear_error = kLinearError * dir_bound;
%round bound = size(C) + 1 * size(U) + 1 * size(V)
%round linear_error = kLinearError * bound

{ C in [IN_C, IN_C] /\ U in [IN_U, IN_U] /\ V in [IN_V, IN_V] /\
  |x_0| <= 1 /\ |y_0| <= 1 /\ |x_0 + c| <= 1 /\ |y_0 + r| <= 1 /\ c in [0, 0x1.14p0] /\ r in [0, 0x1.14p0] /\
  %roundings
  -> linear_error - |direction - linear| >= 0 /\ |direction - form| <= 0x6.01p-23 }

direction - linear -> (direction - exact_direction) - (linear - exact_linear);
direction - form -> (direction - exact_direction) - (first - exact_first);
