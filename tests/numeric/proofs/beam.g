# core/gridiron/engine/tree/ray_beams.h: kBeamMargin. No point of a ray is outside a beam's plane: with p the exact
# end of a ray and w a place along the axis within the beam, p.u - slope p.w + slope w is at least the plane's value
# as rounded. Starts round less, points between lie between, other planes are mirror images; an offset is the least of
# all ends', and smaller ones round to smaller ones. For fixed roundings all is linear in places along u and, times
# the slope, along w: one kind is 0. Powers of two bring M to at most 1, and the slope to 1. t d is at most 2.001, as
# both ends are within M. SPDX-License-Identifier: Apache-2.0
%source core/gridiron/engine/tree/ray_beams.h
%constant kBeamMargin inline constexpr float kBeamMargin = {};
%proves kBeamMargin least 0.283
%cases ALONG_U ALONG_W STEP_U STEP_W END_U END_W
%case 0 1 0 0x2.01p0 0 0x1.01p0
%case 1 0 0x2.01p0 0 0x1.01p0 0

%line const Float end = start + Float(t) * dir;
%round step_u = t * d_u
%round step_w = t * d_w
%round end_u = o_u + step_u
%round end_w = o_w + step_w
%line low_offset = Quad::min(low_offset, Quad::min(starts[i] - low_slope * start_w, ends[i] - low_slope * end_w));
%line const float margin = (most > far ? most : far) * kBeamMargin;
%line low_offset = low_offset - (Float(1.0f) + Quad::abs(low_slope)) * Float(margin);
%round low_offset = end_u - slope * end_w
%round margin = 1 * kBeamMargin
%round offset = low_offset - (one + size(slope)) * margin
# One of up and down is the slope, the other is 0 and does not round.
%line return L::bounded_sum(up[plane], first, L::bounded_sum(down[plane], last, offset[plane]));
%round least = slope * w + offset

# Along the axis beams begin before their ends, by the margin too.
%line beam.planes[0][3] = Quad::lane(is_forward ? low_start : low_end, axis) - margin;
%round low_w = end_w - margin

{ |t * d_u| <= STEP_U /\ |t * d_w| <= STEP_W /\ |o_u + step_u| <= END_U /\ |o_w + step_w| <= END_W /\
  |w| <= END_W /\ one in [ALONG_U, ALONG_U] /\ slope in [ALONG_W, ALONG_W] /\
  %roundings
  -> (exact_low_offset + slope * w) - least >= 0 /\ exact_end_w - low_w >= 0 }

(exact_low_offset + slope * w) - least -> (one + |slope|) * exact_margin - (least - exact_least);
exact_end_w - low_w -> exact_margin - (low_w - exact_low_w);
